from pathlib import Path

from linepose.output.reference import reference_page

ROOT = Path(__file__).parents[3]


def test_committed_page_is_what_the_code_says():
    assert (ROOT / "docs" / "configuration.md").read_text() == reference_page()


def test_every_key_is_described():
    for line in reference_page().splitlines():
        if line.startswith("| `"):
            assert len(line.split(" | ")[2].strip(" |")) > 3, line
