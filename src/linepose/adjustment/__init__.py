"""The adjustment: camera pose, points and body poses together, the scales of their errors estimated from the same data.

`adjust` is what a user calls. Mathematics first: `process` says what the errors are, `whitening` makes measurements
independent, `normal` and `solve` find the minimum of chi squared, `reml` the levels, `curvature` and `posterior` how
sure the pose is.
"""

from linepose.adjustment.adjust import adjust
from linepose.adjustment.levels import LevelPriors, Levels
from linepose.adjustment.measurements import KnownPoints
from linepose.adjustment.result import Adjustment, Diagnostics
from linepose.adjustment.settings import AdjustmentSettings

__all__ = ["Adjustment", "AdjustmentSettings", "Diagnostics", "KnownPoints", "LevelPriors", "Levels", "adjust"]
