import pytest

from linepose.config.platform import Platform
from linepose.pipeline.observation_files import observation_in_words
from linepose.settings import validated
from unit import made_up

FILES = ["scans/b.hdr", "scans/a.hdr", "scans/a.bil", "scans/old/c.hdr", "nav_covs.csv", "views/3.csv", "views/1.csv"]


@pytest.fixture
def sums(tmp_path):
    path = tmp_path / "mine.csv"
    path.write_text("".join(f"{file},0\n" for file in ["file", *FILES, "views/2.csv"]).replace("file,0", "file,sha256"))
    return path


def platform(**source):
    return validated(Platform, made_up.PLATFORM | {"source": {"dataset": "mine", **source}}, "mine.yaml")


@pytest.mark.parametrize(
    ("source", "number", "words"),
    [
        ({"kind": "labelled_views", "views": "views/*.csv"}, 2, "observation 2 (views/2.csv)"),
        ({"kind": "labelled_views", "views": "views/*.csv", "step": 2}, 2, "observation 2 (views/3.csv)"),
        ({"kind": "labelled_views", "views": "views/*.csv", "first": 2}, 2, "observation 2 (views/3.csv)"),
        ({"kind": "labelled_views", "views": "views/*.csv"}, 4, "observation 4"),
        ({"kind": "scans"}, 2, "observation 2 (scans/b.hdr)"),
        ({"kind": "scans", "left_out": [1]}, 2, "observation 2 (scans/b.hdr)"),  # numbers stay
    ],
)
def test_observation_is_called_by_its_file(sums, source, number, words):
    assert observation_in_words(platform(**source), sums, number) == words


def test_observation_of_unlisted_files_is_called_by_its_number(tmp_path):
    assert observation_in_words(platform(kind="scans"), tmp_path / "none.csv", 7) == "observation 7"
