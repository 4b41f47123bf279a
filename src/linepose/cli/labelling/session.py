"""What has been labelled so far, and what comes next: the state behind the window, without any drawing."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import pandas as pd

from linepose.survey.pattern import N_POINTS
from linepose.tables import write_csv

Place = tuple[float, float]  # u_px, line: whole numbers at the centres of pixels and lines

_DIGITS = 3  # of a label: a thousandth of a pixel


@dataclass(frozen=True)
class Step:
    """A change that can be undone: the point of an observation that was placed or skipped, and its place before."""

    observation: int
    point: int
    before: Place | None


@dataclass
class Session:
    """Labels of the observations `numbers` by (observation, point), the observation in view and the next point.

    `point` is N_POINTS once the last one of the scan has been placed or skipped.
    """

    numbers: Sequence[int]
    labels: dict[tuple[int, int], Place] = field(default_factory=dict)
    observation: int = 0
    point: int = 0
    steps: list[Step] = field(default_factory=list)

    def here(self) -> dict[int, Place]:
        """Labels of the observation in view, by point."""
        return {point: place for (number, point), place in self.labels.items() if number == self.observation}

    def place(self, u_px: float, line: float) -> None:
        """Label the next point; nothing happens where the scan is done."""
        if self.point < N_POINTS:
            self._step()
            self.labels[self.observation, self.point] = (round(u_px, _DIGITS), round(line, _DIGITS))
            self.point += 1

    def skip(self) -> None:
        """Leave the next point without a label, because it is covered or outside; a label it had is removed."""
        if self.point < N_POINTS:
            self._step()
            self.labels.pop((self.observation, self.point), None)
            self.point += 1

    def undo(self) -> None:
        """Take the last step back, and go to where it was; labels of an earlier session are undone one by one."""
        if self.steps:
            step = self.steps.pop()
            self.observation, self.point = step.observation, step.point
            if step.before is None:
                self.labels.pop((step.observation, step.point), None)
            else:
                self.labels[step.observation, step.point] = step.before
        elif self.here():
            self.point = max(self.here())
            del self.labels[self.observation, self.point]

    def show(self, number: int) -> None:
        """Go to an observation; its next point is the one after the last that has a label."""
        self.observation = number
        self.point = max(self.here(), default=-1) + 1

    def turn(self, step: int) -> None:
        """Go `step` scans on, or stay at the first or last."""
        index = self.numbers.index(self.observation) + step
        self.show(self.numbers[min(max(index, 0), len(self.numbers) - 1)])

    def _step(self) -> None:
        key = self.observation, self.point
        self.steps.append(Step(*key, self.labels.get(key)))


def resumed(numbers: Sequence[int], labels: Mapping[tuple[int, int], Place]) -> Session:
    """A session that goes on with the first scan whose last point has no label."""
    session = Session(list(numbers), dict(labels))
    session.show(next((number for number in numbers if (number, N_POINTS - 1) not in labels), numbers[-1]))
    return session


def table_of(labels: Mapping[tuple[int, int], Place]) -> pd.DataFrame:
    """Labels as observation, point, u_px, line, ordered by the first two."""
    rows = [(*key, *labels[key]) for key in sorted(labels)]
    return pd.DataFrame(rows, columns=["observation", "point", "u_px", "line"])


def save(session: Session, path: Path) -> None:
    """Write our CSV file, whole or not at all."""
    write_csv(table_of(session.labels), path)
