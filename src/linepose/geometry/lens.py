"""What a lens does to the line: where a direction falls along it, and how far the line lies off a straight one.

A direction has the normalised coordinates x along the line and y across it, in the plane z = 1. Along the line it falls
at the distorted

    s = t(x) + x (k1 x^2 + k2 x^4 + k3 x^6) + 3 p2 x^2,     u = u0 + f s  (f in pixels)

with t(x) = x, or what a table of view angles says. It is on the line where

    y = b(x) + tilt x + smile x^2

with b(x) = 0, or the table's. p2 is the part along the line of Brown's tangential distortion; the part across it, p1,
is a smile. A table is interpolated by cubics that are monotone where the table is, with a continuous derivative, and
goes on straight beyond its ends.
"""

from collections.abc import Mapping
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import Floats

COEFFICIENTS: Final = ("k1", "k2", "k3", "p2", "tilt", "smile")
ALONG: Final = COEFFICIENTS[:4]  # those that move a direction along the line; the others bend the line
LARGEST_COEFFICIENT: Final = 1e6
_MOST_STEPS: Final = 50
_SETTLED: Final = 1e-14  # of s


class Lens(NamedTuple):
    """The coefficients, and a table as knots: x (T,), s and y there with their slopes by x; T is 0 without a table."""

    k1: float
    k2: float
    k3: float
    p2: float
    tilt: float
    smile: float
    knot_x: Floats
    knot_s: Floats
    slope_s: Floats
    knot_y: Floats
    slope_y: Floats

    def at(self, coefficients: Mapping[str, float]) -> "Lens":
        """The lens with other values of some coefficients."""
        return Lens(**self._asdict() | dict(coefficients))

    @property
    def is_ideal(self) -> bool:
        """Whether s is x."""
        return len(self.knot_x) == 0 and not (self.k1 or self.k2 or self.k3 or self.p2)

    @property
    def is_straight(self) -> bool:
        """Whether the line is."""
        return not (self.tilt or self.smile or np.any(self.knot_y))


def distort(x: ArrayLike, lens: Lens) -> Floats:
    """S of x; (...) to (...)."""
    x = np.asarray(x, dtype=float)
    x2 = x**2
    base = interpolated(x, lens.knot_x, lens.knot_s, lens.slope_s)[0] if len(lens.knot_x) else x
    return base + x * (x2 * (lens.k1 + x2 * (lens.k2 + x2 * lens.k3)) + 3 * lens.p2 * x)


def distortion_slope(x: ArrayLike, lens: Lens) -> Floats:
    """ds/dx at x; (...) to (...)."""
    x = np.asarray(x, dtype=float)
    x2 = x**2
    base = interpolated(x, lens.knot_x, lens.knot_s, lens.slope_s)[1] if len(lens.knot_x) else 1.0
    return base + x2 * (3 * lens.k1 + x2 * (5 * lens.k2 + x2 * 7 * lens.k3)) + 6 * lens.p2 * x


def undistort(s: ArrayLike, lens: Lens) -> Floats:
    """X of s, the inverse of `distort` to rounding; (...) to (...).

    NaN beyond where s rises with x: no direction falls there, or two do.
    """
    s = np.asarray(s, dtype=float)
    if lens.is_ideal:
        return s.copy()
    x = np.interp(s, lens.knot_s, lens.knot_x) if len(lens.knot_x) else s
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        for _ in range(_MOST_STEPS):
            slope = distortion_slope(x, lens)
            step = np.where(slope > 0, (distort(x, lens) - s) / slope, np.nan)
            x = x - step
            if not np.any(np.abs(step) > _SETTLED * (1 + np.abs(x))):
                break
        rises = (distortion_slope(x, lens) > 0) & (np.abs(step) < 1e-9 * (1 + np.abs(x)))
    return np.where(rises, x, np.nan)


def across(x: ArrayLike, lens: Lens) -> Floats:
    """Y of the line at x; (...) to (...)."""
    x = np.asarray(x, dtype=float)
    base = interpolated(x, lens.knot_x, lens.knot_y, lens.slope_y)[0] if len(lens.knot_x) else 0.0
    return base + x * (lens.tilt + x * lens.smile)


def across_slope(x: ArrayLike, lens: Lens) -> Floats:
    """dy/dx of the line at x; (...) to (...)."""
    x = np.asarray(x, dtype=float)
    base = interpolated(x, lens.knot_x, lens.knot_y, lens.slope_y)[1] if len(lens.knot_x) else 0.0
    return base + lens.tilt + 2 * lens.smile * x


def by_coefficients(x: ArrayLike, names: tuple[str, ...]) -> tuple[Floats, Floats]:
    """Derivatives of s at x by some coefficients, and of y of the line; (...) to (..., C) twice."""
    x = np.asarray(x, dtype=float)
    powers = {"k1": x**3, "k2": x**5, "k3": x**7, "p2": 3 * x**2, "tilt": x, "smile": x**2}
    nothing = np.zeros_like(x)
    empty = np.empty((*x.shape, 0))
    columns = [powers[name] for name in names]
    along = [one if name in ALONG else nothing for name, one in zip(names, columns, strict=True)]
    bent = [nothing if name in ALONG else one for name, one in zip(names, columns, strict=True)]
    return (np.stack(along, axis=-1), np.stack(bent, axis=-1)) if names else (empty, empty)


def monotone_slopes(x: Floats, y: Floats) -> Floats:
    """Slopes (T,) at knots (T,) of cubics that rise and fall only where the knots do, by Fritsch and Butland."""
    width, rise = np.diff(x), np.diff(y) / np.diff(x)
    slopes = np.empty(len(x))
    before, after = 2 * width[1:] + width[:-1], width[1:] + 2 * width[:-1]
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = (before + after) / (before / rise[:-1] + after / rise[1:])
    slopes[1:-1] = np.where(rise[:-1] * rise[1:] > 0, mean, 0.0)
    slopes[0], slopes[-1] = _end_slope(width[:2], rise[:2]), _end_slope(width[:-3:-1], rise[:-3:-1])
    return slopes


def _end_slope(width: Floats, rise: Floats) -> float:
    """The slope at the end of three knots, from the parabola through them, held to their direction."""
    if len(rise) < 2:
        return float(rise[0])
    slope = ((2 * width[0] + width[1]) * rise[0] - width[0] * rise[1]) / (width[0] + width[1])
    if slope * rise[0] <= 0:
        return 0.0
    return float(3 * rise[0] if rise[0] * rise[1] <= 0 and abs(slope) > abs(3 * rise[0]) else slope)


def interpolated(x: Floats, knots: Floats, values: Floats, slopes: Floats) -> tuple[Floats, Floats]:
    """Value and slope of the table at x; (...) to (...) twice."""
    i = np.clip(np.searchsorted(knots, x) - 1, 0, len(knots) - 2)
    width = knots[i + 1] - knots[i]
    t = np.clip((x - knots[i]) / width, 0.0, 1.0)
    rise = values[i + 1] - values[i]
    first, second = width * slopes[i], width * slopes[i + 1]
    square, cube = 3 * rise - 2 * first - second, first + second - 2 * rise
    slope = (first + t * (2 * square + t * 3 * cube)) / width
    beyond = x - (knots[i] + t * width)
    return values[i] + t * (first + t * (square + t * cube)) + beyond * slope, slope
