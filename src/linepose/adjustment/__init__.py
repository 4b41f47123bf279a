"""The adjustment: camera pose, points and body poses together, the scales of their errors estimated from the same data.

`adjust` is what a user calls. Mathematics first: `process` says what the errors are, `whitening` makes measurements
independent, `normal` and `solve` find the minimum of chi squared, `reml` the levels, `curvature` and `posterior` how
sure the pose is.
"""

from pathlib import Path

from linepose.compiling.cache import forget_outdated

forget_outdated(Path(__file__).parent)

from linepose.adjustment.adjust import adjust  # noqa: E402
from linepose.adjustment.levels import LevelPriors, Levels  # noqa: E402
from linepose.adjustment.measurements import KnownPoints  # noqa: E402
from linepose.adjustment.result import Adjustment, Diagnostics  # noqa: E402
from linepose.adjustment.settings import AdjustmentSettings  # noqa: E402

__all__ = ["Adjustment", "AdjustmentSettings", "Diagnostics", "KnownPoints", "LevelPriors", "Levels", "adjust"]
