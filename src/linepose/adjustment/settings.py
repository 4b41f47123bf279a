"""Settings of the adjustment."""

from dataclasses import dataclass, field
from typing import Final

import numpy as np

from linepose.adjustment.hand_measured import covariance_of_sigmas
from linepose.adjustment.levels import START, LevelPriors, Levels
from linepose.rotations import Floats

HAND_POSITION_M: Final = 0.1
HAND_ROTATION_RAD: Final = float(np.deg2rad(2.0))


@dataclass(frozen=True)
class Settings:
    """How the adjustment is done.

    hand_measured_prior: whether the hand measurement counts, or is but a start; priors and start of the levels;
    line_period_s: duration of a line, None to read it from the time stamps; tails: whether a view's constant and
    single measurements may have heavy tails; n_draws of the levels; n_samples of the pose; seed of both; max_rounds of
    Gauss-Newton and levels in turn.
    """

    hand_measured_prior: bool = True
    priors: LevelPriors = field(default_factory=LevelPriors)
    start: Levels = START
    line_period_s: float | None = None
    tails: bool = True
    n_draws: int = 200
    n_samples: int = 2000
    seed: int = 0
    max_rounds: int = 12


def default_hand_covariance() -> Floats:
    """Covariance (6, 6) of a pose measured by hand: 0.1 m and 2 deg about every body axis."""
    return covariance_of_sigmas(HAND_POSITION_M, HAND_ROTATION_RAD)
