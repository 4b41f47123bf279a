"""One reader under changing bytes: `PYTHONPATH=tests python -m unit.bad_input.fuzz nmea --seconds 600`.

With the package atheris, the changes are those that reach new lines of ours; without, bytes are changed at random. Both
begin with the files that the tests' writers make. What leads to a fault is kept, each place in the code once.
"""

import argparse
import hashlib
import importlib.util
import logging
import os
import random
import re
import sys
import time
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

MOST_BYTES = 100_000
_MOST_KEPT = 40  # contents that were read, to be changed further


class Run:
    """Outcomes of one reader, counted, and faults written to a folder."""

    def __init__(self, name: str, findings: Path) -> None:
        from unit.bad_input.readers import readers

        self.reader = readers()[name]
        self.findings = findings
        self.counts: Counter[str] = Counter()
        self.begun = time.monotonic()

    def check(self, data: bytes) -> None:
        """Read these bytes; a new kind of fault is kept and told."""
        from unit.bad_input.outcome import FAULTS, outcome

        found = outcome(self.reader, data)
        self.counts[found.kind] += 1
        if found.kind in FAULTS:
            self._keep(data, found.kind, found.told)

    def _keep(self, data: bytes, kind: str, told: str) -> None:
        places = re.findall(r'File ".*/(?:src|tests)/(.*)", line (\d+)', told)
        where = f"{kind} {places[-1] if places else told[-80:]}"
        path = self.findings / f"{self.reader.name}-{hashlib.sha256(where.encode()).hexdigest()[:8]}".replace(" ", "-")
        if not path.with_suffix(".bin").is_file():
            path.with_suffix(".bin").write_bytes(data)
            path.with_suffix(".txt").write_text(f"{kind}\n{told}\n")
            print(f"{self.reader.name}: {kind} at {where}: kept as {path}.bin", flush=True)

    def tell(self, how: str) -> None:
        """Print the counts."""
        from unit.bad_input.outcome import OUTCOMES

        counts = ", ".join(f"{self.counts[kind]} {kind}" for kind in OUTCOMES)
        seconds = time.monotonic() - self.begun
        print(f"{self.reader.name}: {self.counts.total()} inputs in {seconds:.0f} s by {how}: {counts}", flush=True)


def seeds(run: Run) -> Iterator[bytes]:
    """The whole file and some that are cut."""
    whole = run.reader.whole()
    yield from (whole, whole[: len(whole) // 2], whole.replace(b"\n", b"\r\n"), b"")


def changed(data: bytes, others: list[bytes], draw: random.Random) -> bytes:
    """A content with a few of its bytes changed, moved, cut, or taken from another."""
    content = bytearray(data)
    for _ in range(draw.choice((1, 1, 2, 4, 8))):
        at, size = draw.randrange(len(content) + 1), draw.choice((1, 1, 2, 4, 8, 16, 64))
        piece = draw.choice(others)[at : at + size]
        kind = draw.randrange(5)
        new = (draw.randbytes(size), b"", bytes(content[at : at + size]) * 2, piece, bytes([draw.randrange(256)]))[kind]
        content[at : at + (0 if kind == 3 else size if kind < 3 else 1)] = new
    return bytes(content[:MOST_BYTES])


def by_chance(run: Run, seconds: float, number: int) -> None:
    """Bytes changed at random, stacked on one another; a content that is still read is changed further."""
    draw, pool = random.Random(number), list(seeds(run))
    first = list(pool)
    while time.monotonic() - run.begun < seconds:
        content = changed(draw.choice(pool), first, draw)
        before = run.counts["read"]
        run.check(content)
        if run.counts["read"] > before:
            pool = [*pool, content][-_MOST_KEPT:] + first


def by_coverage(run: Run, seconds: float, number: int) -> None:
    """Atheris from this seed; ends the process."""
    import atheris

    with TemporaryDirectory() as corpus:
        for at, content in enumerate(seeds(run)):
            (Path(corpus) / f"seed-{at}").write_bytes(content)
        options = (f"-max_total_time={seconds:.0f}", f"-max_len={MOST_BYTES}", "-rss_limit_mb=4000", "-timeout=120")
        ended = run.begun + seconds

        def check(data: bytes) -> None:
            run.check(data)
            if time.monotonic() > ended:
                run.tell("atheris")
                os._exit(0)

        atheris.Setup([sys.argv[0], *options, "-verbosity=0", f"-seed={number}", corpus], check)
        atheris.Fuzz()


def main() -> None:
    """Run one reader."""
    logging.disable()
    parser = argparse.ArgumentParser(prog="python -m unit.bad_input.fuzz", description=__doc__)
    parser.add_argument("reader", help="name of the reader, as python -m unit.bad_input prints it")
    parser.add_argument("--seconds", type=float, default=600, help="how long (default: %(default)g)")
    parser.add_argument("--seed", type=int, default=0, help="of the changes (default: %(default)s)")
    parser.add_argument("--by-chance", action="store_true", help="leave atheris aside")
    parser.add_argument("--findings", type=Path, default=Path("findings"), help="folder (default: %(default)s)")
    given = parser.parse_args()
    given.findings.mkdir(parents=True, exist_ok=True)
    if given.by_chance or importlib.util.find_spec("atheris") is None:
        run = Run(given.reader, given.findings)
        by_chance(run, given.seconds, given.seed)
        run.tell("chance")
        return
    import atheris

    with atheris.instrument_imports(include=["linepose"]):
        run = Run(given.reader, given.findings)
        run.check(run.reader.whole())  # what a reader imports late is instrumented too
    by_coverage(run, given.seconds, given.seed + 1)  # 0 is a seed of chance


if __name__ == "__main__":
    main()
