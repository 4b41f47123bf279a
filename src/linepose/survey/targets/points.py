"""Target `points`: no pattern at all; places that a person recognises, by name."""

from typing import ClassVar, Literal

import numpy as np
from pydantic import Field

from linepose.arrays import Floats
from linepose.survey.targets.base import TargetSection


class PointsSection(TargetSection):
    """Stones, corners, marks on the ground: whatever a person labels under the same name in each scan."""

    title: ClassVar[str] = "no pattern: places that a person labels by name"

    kind: Literal["points"] = Field("points", description="`points`: no pattern, points are labelled by name.")
    names: tuple[int | str, ...] = Field((), description="Names of the points that are expected; any other will do.")

    def points(self) -> Floats:
        """No place is known; (0, 3)."""
        return np.zeros((0, 3))

    def ids(self) -> tuple[int | str, ...]:
        """The names that are expected."""
        return self.names
