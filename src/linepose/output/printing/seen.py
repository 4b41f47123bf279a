"""How large the details of a print must be for a camera that looks at them from a range."""

import math

from linepose.survey.targets.base import TargetSection


def size_rows(target: TargetSection, range_m: float, pixel_rad: float) -> list[tuple[str, float, float]]:
    """Each detail: its name, its size, and what it must have for pixels that see `pixel_rad` at `range_m` (m)."""
    footprint_m = range_m * pixel_rad
    return [(detail.name, detail.size_m, detail.n_pixels * footprint_m) for detail in target.details()]


def is_seen(size_m: float, needed_m: float) -> bool:
    """Whether a detail of this size is large enough, but for rounding."""
    return size_m >= needed_m * (1 - 1e-9)


def factor_for(target: TargetSection, range_m: float, pixel_rad: float) -> float:
    """By how much a target must grow to be seen; below 1 where it need not."""
    return max(needed / size for _, size, needed in size_rows(target, range_m, pixel_rad))


def range_for(target: TargetSection, range_m: float, pixel_rad: float) -> float:
    """The farthest range (m) at which a target that is too small at this one is seen, rounded down to three digits."""
    farthest_m = range_m / factor_for(target, range_m, pixel_rad)
    step = 10.0 ** (math.floor(math.log10(farthest_m)) - 2)
    return math.floor(farthest_m / step * (1 + 1e-9)) * step


def spacing_for(target: TargetSection, spacing_m: float, range_m: float, pixel_rad: float) -> int:
    """The smallest spacing in whole mm at which a target in proportion is seen."""
    factor = factor_for(target, range_m, pixel_rad)
    return math.ceil(round(spacing_m * factor * 1e3, 6))
