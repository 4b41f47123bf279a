"""Layouts of flights: where their strips lie."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from linepose.arrays import Floats


@dataclass(frozen=True)
class Strip:
    """One straight strip: its middle north and east (m), heading (rad), height above the ground (m) and duration."""

    north_m: float
    east_m: float
    heading_rad: float
    height_m: float
    duration_s: float = 15.0

    def ends(self, speed_m_s: float) -> Floats:
        """Both ends (2, 2), north and east (m)."""
        half = self.duration_s * speed_m_s / 2 * np.array([np.cos(self.heading_rad), np.sin(self.heading_rad)])
        return np.array([self.north_m, self.east_m]) + np.array([[-1.0], [1.0]]) * half


def parallel(
    n_strips: int, heights_m: tuple[float, ...], spacing_m: float = 6.0, duration_s: float = 15.0
) -> tuple[Strip, ...]:
    """Strips side by side, there and back in turn; heights change after each pair."""
    return tuple(
        Strip(
            0.0,
            (k - (n_strips - 1) / 2) * spacing_m,
            np.pi * (k % 2),
            heights_m[k // 2 % len(heights_m)],
            duration_s,
        )
        for k in range(n_strips)
    )


def across(n_strips: int, heights_m: tuple[float, ...], spacing_m: float = 20.0) -> tuple[Strip, ...]:
    """Strips from west to east and back, side by side."""
    return tuple(
        Strip((k - (n_strips - 1) / 2) * spacing_m, 0.0, np.pi / 2 + np.pi * (k % 2), heights_m[k % len(heights_m)])
        for k in range(n_strips)
    )


ONE_HEIGHT: Final = parallel(8, (40.0,))
CROSSED: Final = (*parallel(6, (40.0, 60.0)), *across(2, (40.0, 60.0)))
LAYOUTS: Final = {
    "one-height": ONE_HEIGHT,
    "two-heights": parallel(8, (40.0, 60.0)),
    "crossed": CROSSED,
    "there-and-back": parallel(8, (40.0,), spacing_m=0.0),
    "one-strip": parallel(1, (40.0,)),
    "two-strips": parallel(2, (40.0,)),
}
