"""Put what `make bench` printed into docs/benchmarks.md, and some rows of it into README.md, between their two marks.

`make bench | python benchmarks/into_readme.py`
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
BEGIN, END = "<!-- make bench -->\n", "<!-- end of make bench -->\n"
KEPT = (
    r".* cores, .*Python",
    r" +observations +seconds",
    r"Powell +16",
    r"MCMC +16",
    r"The whole workflow",
)


def main() -> None:
    """Replace the blocks; what was printed passes through."""
    printed = []
    for row in sys.stdin:
        print(row, end="", flush=True)
        printed.append(row.rstrip())
    replace_block(ROOT / "docs" / "benchmarks.md", printed)
    replace_block(ROOT / "README.md", rows_for_readme(printed))


def rows_for_readme(printed: list[str]) -> list[str]:
    """The first row that fits each of KEPT."""
    return [next(row for row in printed if re.match(pattern, row)) for pattern in KEPT]


def replace_block(page: Path, rows: list[str]) -> None:
    """Put rows as text between the two marks of a page."""
    before, rest = page.read_text(encoding="utf-8").split(BEGIN)
    after = rest.split(END)[1]
    block = "\n".join(["```text", *rows, "```"]).replace("\n\n```", "\n```")
    page.write_text(f"{before}{BEGIN}{block}\n{END}{after}", encoding="utf-8")


if __name__ == "__main__":
    main()
