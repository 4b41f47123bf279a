"""What has been labelled so far, and what comes next: the state behind the window, without any drawing."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import pandas as pd

from linepose.survey.point_names import Name, point_name
from linepose.tables import write_csv

Place = tuple[float, float]  # u_px, line: whole numbers at the centres of pixels and lines

_DIGITS = 3  # of a label: a thousandth of a pixel


@dataclass(frozen=True)
class Step:
    """A change that can be undone: the point of an observation that was placed or skipped, and its place before.

    `point` is its place among the session's names.
    """

    observation: int
    point: int
    before: Place | None


@dataclass
class Session:
    """Labels of the observations `numbers` by (observation, name), the observation in view and the next point.

    `names` are those of all points in their order, `point` the place of the next one among them, their count once the
    last one of the scan has been placed or skipped. Where `takes_new`, the point after the last is a new one.
    """

    numbers: Sequence[int]
    names: list[Name]
    labels: dict[tuple[int, Name], Place] = field(default_factory=dict)
    takes_new: bool = False
    observation: int = 0
    point: int = 0
    steps: list[Step] = field(default_factory=list)

    @property
    def name(self) -> Name | None:
        """Name of the next point, of a new one the first number that is free; None where the scan is done."""
        if self.point < len(self.names):
            return self.names[self.point]
        free = next(number for number in range(len(self.names) + 1) if number not in self.names)
        return free if self.takes_new else None

    def here(self) -> dict[Name, Place]:
        """Labels of the observation in view, by name."""
        return {name: place for (number, name), place in self.labels.items() if number == self.observation}

    def choose(self, text: str) -> bool:
        """Make the point of this name the next one, a new one where that is allowed; whether it is."""
        name = point_name(text)
        if name is not None and name not in self.names and self.takes_new:
            self.names.append(name)
        known = name in self.names
        if known:
            self.point = self.names.index(name)  # type: ignore[arg-type]
        return known

    def choose_new(self) -> None:
        """Make a new point the next one, where that is allowed."""
        self.point = len(self.names) if self.takes_new else self.point

    def place(self, u_px: float, line: float) -> None:
        """Label the next point; nothing happens where the scan is done."""
        name = self.name
        if name is not None:
            if self.point == len(self.names):
                self.names.append(name)
            self._step()
            self.labels[self.observation, name] = (round(u_px, _DIGITS), round(line, _DIGITS))
            self.point += 1

    def skip(self) -> None:
        """Leave the next point without a label, because it is covered or outside; a label it had is removed."""
        if self.point < len(self.names):
            self._step()
            self.labels.pop((self.observation, self.names[self.point]), None)
            self.point += 1

    def undo(self) -> None:
        """Take the last step back, and go to where it was; labels of an earlier session are undone one by one."""
        if self.steps:
            step = self.steps.pop()
            self.observation, self.point = step.observation, step.point
            key = step.observation, self.names[step.point]
            if step.before is None:
                self.labels.pop(key, None)
            else:
                self.labels[key] = step.before
        elif self.here():
            self.point = self._last()
            del self.labels[self.observation, self.names[self.point]]

    def show(self, number: int) -> None:
        """Go to an observation; its next point is the one after the last that has a label."""
        self.observation = number
        self.point = self._last() + 1

    def turn(self, step: int) -> None:
        """Go `step` scans on, or stay at the first or last."""
        index = self.numbers.index(self.observation) + step
        self.show(self.numbers[min(max(index, 0), len(self.numbers) - 1)])

    def _last(self) -> int:
        """Place among the names of the last that has a label in the observation in view; -1 where none has."""
        here = self.here()
        return max((place for place, name in enumerate(self.names) if name in here), default=-1)

    def _step(self) -> None:
        before = self.labels.get((self.observation, self.names[self.point]))
        self.steps.append(Step(self.observation, self.point, before))


def resumed(
    numbers: Sequence[int], labels: Mapping[tuple[int, Name], Place], names: Sequence[Name], takes_new: bool = False
) -> Session:
    """A session that goes on with the first scan whose last point has no label, or that has none at all.

    `names` are those of a target's points; others that have labels come after them.
    """
    known = list(dict.fromkeys([*names, *(name for _, name in labels)]))
    session = Session(list(numbers), known, dict(labels), takes_new)
    labelled = {number for number, name in labels if takes_new or name == names[-1]}
    session.show(next((number for number in numbers if number not in labelled), numbers[-1]))
    return session


def table_of(labels: Mapping[tuple[int, Name], Place]) -> pd.DataFrame:
    """Labels as observation, point, u_px, line, ordered by the first two, numbers before text."""
    keys = sorted(labels, key=lambda key: (key[0], isinstance(key[1], str), key[1]))
    rows = [(*key, *labels[key]) for key in keys]
    return pd.DataFrame(rows, columns=["observation", "point", "u_px", "line"])


def save(session: Session, path: Path) -> None:
    """Write our CSV file, whole or not at all."""
    write_csv(table_of(session.labels), path)
