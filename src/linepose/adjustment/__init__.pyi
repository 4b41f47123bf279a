from .adjust import adjust as adjust
from .known_points import KnownPoints as KnownPoints
from .levels import LevelPriors as LevelPriors
from .levels import Levels as Levels
from .result import Adjustment as Adjustment
from .result import Diagnostics as Diagnostics
from .settings import AdjustmentSettings as AdjustmentSettings
