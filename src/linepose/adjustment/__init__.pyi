from .adjust import adjust as adjust
from .levels import LevelPriors as LevelPriors
from .levels import Levels as Levels
from .measurements import KnownPoints as KnownPoints
from .result import Adjustment as Adjustment
from .result import Diagnostics as Diagnostics
from .settings import AdjustmentSettings as AdjustmentSettings
