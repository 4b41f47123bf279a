"""Put what `make bench` printed between the two marks in README.md: `make bench | python benchmarks/into_readme.py`."""

import sys
from pathlib import Path

README = Path(__file__).resolve().parents[1] / "README.md"
BEGIN, END = "<!-- make bench -->\n", "<!-- end of make bench -->\n"


def main() -> None:
    """Replace the block; what was printed passes through."""
    printed = []
    for row in sys.stdin:
        print(row, end="", flush=True)
        printed.append(row.rstrip())
    before, rest = README.read_text(encoding="utf-8").split(BEGIN)
    after = rest.split(END)[1]
    block = "\n".join(["```text", *printed, "```"]).replace("\n\n```", "\n```")
    README.write_text(f"{before}{BEGIN}{block}\n{END}{after}", encoding="utf-8")


if __name__ == "__main__":
    main()
