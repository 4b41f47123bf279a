"""Results that the present configuration, inputs or code would no longer give, and what differs.

Rests on what each result says of itself (`provenance`) and on nothing else, so also in a copied project.
"""

import csv
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, Final

from linepose.config.project import Project
from linepose.pipeline.code_digest import present_digest
from linepose.pipeline.provenance import Provenance, content_digest, read_provenance
from linepose.pipeline.sections import GROUPS, OTHERS, PLATFORM, present_section

_MISSING: Final = object()
_NO_RESULTS: Final = {"work", "simulated", "exports"}  # work in progress, what a simulation records, what is taken away
_EXPERIMENT: Final = "experiment "  # the script that runs experiments
_UNNAMED: Final = {PLATFORM, OTHERS, *GROUPS}


@dataclass(frozen=True)
class Outdated:
    """A result, by its path in the project, and the first thing that differs from what made it, in words."""

    path: str
    difference: str


@dataclass(frozen=True)
class Present:
    """What results of a platform are held against: its project in the folder `root`, and the workflow's scripts.

    Without the folder `scripts`, code is not compared. `experiments` has the sections of the platform's experiments;
    None passes over results of experiments. `left_out` names results that the platform's file does not ask for.
    """

    project: Project
    root: Path
    name: str
    scripts: Path | None = None
    experiments: Mapping[str, Any] | None = None
    left_out: frozenset[str] = frozenset()


def outdated_results(present: Present) -> list[Outdated]:
    """The outdated results of a platform, those of other settings first. Inputs that are gone are passed over."""
    compare = _Comparison(present)
    found: list[tuple[int, Outdated]] = []
    for path in sorted((present.root / "results" / present.name).rglob("*.parquet")):
        place = path.relative_to(present.root)
        if place.parts[2] in _NO_RESULTS or path.stem in present.left_out:
            continue
        if difference := next(compare.differences(path), None):
            found.append((difference[0], Outdated(place.as_posix(), difference[1])))
    return [outdated for _, outdated in sorted(found, key=lambda pair: pair[0])]


def told(outdated: Sequence[Outdated]) -> str:
    """What is outdated, and why the first of it, in a line."""
    first, *more = outdated
    these = f"{first.path} and {len(more)} more are" if more else f"{first.path} is"
    return f"{these} outdated: {first.difference}"


class _Comparison:
    """Results against what is present; each file is read once."""

    def __init__(self, present: Present) -> None:
        self.present = present
        self.digest = lru_cache(maxsize=None)(content_digest)

    def differences(self, path: Path) -> Iterator[tuple[int, str]]:
        """What differs for one result, most telling first, each with its rank."""
        made = read_provenance(path)
        if made is None:
            yield 3, "it does not say what made it"
        elif self.present.experiments is not None or not made.code.startswith(_EXPERIMENT):
            yield from ((0, difference) for difference in self._of_settings(made))
            yield from ((1, difference) for difference in self._of_inputs(made))
            yield from ((2, difference) for difference in self._of_code(made))

    def _of_settings(self, made: Provenance) -> Iterator[str]:
        experiments = self.present.experiments or {}
        for name, recorded in made.settings.items():
            try:
                present = present_section(self.present.project, self.present.name, name, recorded, experiments)
            except KeyError:
                continue
            yield from _differences("" if name in _UNNAMED else name, recorded, present)

    def _of_inputs(self, made: Provenance) -> Iterator[str]:
        for name, digest in made.inputs.items():
            file = self.present.root / name
            if "/" not in name or not file.exists():
                continue
            if self.digest(file) != digest:
                yield f"{name} is not the one it was made from"
            if file.parent.name == "datasets" and file.suffix == ".csv":
                yield from self._of_data(file)

    def _of_data(self, sums: Path) -> Iterator[str]:
        """Files of a data set that are newer than the list of their sums, and other than it says."""
        folder = self.present.project.folders.get(sums.stem)
        with sums.open(encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        for row in rows:
            data = folder / row["file"] if folder else None
            if data is None or not data.is_file() or data.stat().st_mtime <= sums.stat().st_mtime:
                continue
            if not row["sha256"].startswith(self.digest(data)):
                root = self.present.root
                place = data.relative_to(root) if data.is_relative_to(root) else data
                yield f"{place} is not the one it was made from"

    def _of_code(self, made: Provenance) -> Iterator[str]:
        if self.present.scripts is None or not made.code:
            return
        present = present_digest(made.code, self.present.scripts)
        if present not in (None, made.code):
            yield f"the code of scripts/{made.code.split()[0]}.py has changed (made by linepose {made.version})"


def _differences(place: str, old: Any, new: Any) -> Iterator[str]:
    """Where two values differ, down to the key: "camera.focal_length_m was 0.0082, is 0.009"."""
    if isinstance(old, Mapping) and isinstance(new, Mapping):
        for key in dict.fromkeys([*old, *new]):
            yield from _differences(f"{place}.{key}".lstrip("."), old.get(key, _MISSING), new.get(key, _MISSING))
    elif old != new:
        yield f"{place} was {_short(old)}, is {_short(new)}"


def _short(value: Any) -> str:
    if value is _MISSING:
        return "not there"
    text = str(value)
    return text if len(text) <= 40 else f"{text[:37]}..."
