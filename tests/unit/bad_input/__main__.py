"""Counts of what comes of many bad inputs, reader by reader: `PYTHONPATH=tests python -m unit.bad_input --count 20`."""

import argparse
import importlib.util
import logging
import sys
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from hypothesis import HealthCheck, Phase, given, seed, settings

from unit.bad_input.children import outcomes
from unit.bad_input.mutations import Mutation, mutated, mutations
from unit.bad_input.outcome import FAULTS, OUTCOMES, READ
from unit.bad_input.reader import Reader
from unit.bad_input.readers import readers


def drawn(is_text: bool, count: int, number: int) -> list[tuple[Mutation, ...]]:
    """So many things that are done to a file; the same for the same number."""
    found: list[tuple[Mutation, ...]] = []

    @seed(number)
    @settings(max_examples=count, database=None, phases=[Phase.generate], suppress_health_check=list(HealthCheck))
    @given(mutations(is_text))
    def draw(done: tuple[Mutation, ...]) -> None:
        found.append(done)

    draw()
    return found


def counted(reader: Reader, count: int, number: int, findings: Path | None) -> Counter[str]:
    """How often each outcome came; contents that led to a fault are kept in the folder `findings`."""
    contents = [mutated(reader.whole(), done) for done in drawn(reader.is_text, count, number)]
    counts: Counter[str] = Counter()
    for at, found in enumerate(outcomes(reader, contents)):
        counts[found.kind] += 1
        if found.kind in FAULTS:
            told = found.told.strip().splitlines()
            print(f"  {reader.name}: {found.kind} ({found.seconds:.1f} s): {told[-1] if told else ''}", flush=True)
            if findings:
                place = findings / f"{reader.name.replace(' ', '-')}-{at}"
                place.with_suffix(".bin").write_bytes(contents[at])
                place.with_suffix(".txt").write_text(found.told)
    return counts


def main() -> int:
    """Print the table; 1 where a whole file is not read or any bad input has led to a fault."""
    logging.disable()
    parser = argparse.ArgumentParser(prog="python -m unit.bad_input", description=__doc__)
    parser.add_argument("readers", nargs="*", metavar="READER", help="names of readers (default: all)")
    parser.add_argument("--count", type=int, default=20, help="bad inputs a reader (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=0, help="from which they are drawn (default: %(default)s)")
    parser.add_argument("--findings", type=Path, help="folder for what leads to a fault")
    given_ = parser.parse_args()
    if given_.findings:
        given_.findings.mkdir(parents=True, exist_ok=True)
    unknown = set(given_.readers) - set(readers())
    if unknown:
        parser.error(f"no reader {', '.join(sorted(unknown))}; the readers are {', '.join(readers())}")
    return _table(given_.readers or list(readers()), given_.count, given_.seed, given_.findings)


def _table(names: Sequence[str], count: int, number: int, findings: Path | None) -> int:
    total: Counter[str] = Counter()
    print(f"| reader | {' | '.join(OUTCOMES)} |\n| --- |{' ---: |' * len(OUTCOMES)}")
    is_broken = False
    for name in names:
        reader = readers()[name]
        if reader.package and importlib.util.find_spec(reader.package) is None:
            print(f"| {name} | needs the package {reader.package} |")
            continue
        whole = next(iter(outcomes(reader, [reader.whole()])))
        is_broken |= whole.kind != READ
        counts = counted(reader, count, number, findings)
        total += counts
        print(f"| {name} | {' | '.join(str(counts[kind]) for kind in OUTCOMES)} |", flush=True)
    print(f"| all {total.total()} | {' | '.join(str(total[kind]) for kind in OUTCOMES)} |")
    return int(is_broken or any(total[kind] for kind in FAULTS))


if __name__ == "__main__":
    sys.exit(main())
