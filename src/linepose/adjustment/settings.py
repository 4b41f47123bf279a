"""Settings of the adjustment."""

from typing import Final

import numpy as np
from pydantic import Field, NonNegativeInt, PositiveFloat, field_validator

from linepose.adjustment.levels import START, LevelPriors, Levels, check_levels
from linepose.arrays import Floats
from linepose.settings import Settings

HAND_POSITION_M: Final = 0.1
HAND_ROTATION_RAD: Final = float(np.deg2rad(2.0))


class AdjustmentSection(Settings):
    """How the adjustment is done.

    Examples
    --------
    >>> import linepose
    >>> linepose.AdjustmentSection(n_samples=500).n_draws
    200
    """

    priors: LevelPriors = Field(LevelPriors(), description="Log-normal priors of the levels.")
    start: Levels = Field(START, description="Levels to start from, in the order of the priors.")
    line_period_s: PositiveFloat | None = Field(
        None, le=10.0, description="Duration of a line (s); what time stamps are multiples of if null."
    )
    tails: bool = Field(
        True, description="Whether views and single measurements may err far more than the rest, where the data say so."
    )
    n_draws: int = Field(200, ge=10, le=10_000, description="Draws of the levels.")
    n_samples: int = Field(2000, ge=10, le=1_000_000, description="Draws of the pose.")
    max_rounds: int = Field(12, ge=1, le=10_000, description="Rounds of Gauss-Newton and levels in turn.")

    @field_validator("start")
    @classmethod
    def _starts_at_levels(cls, start: Levels) -> Levels:
        return check_levels(start)


class AdjustmentSettings(AdjustmentSection):
    """How one adjustment is done, and what else is known and sought."""

    hand_measured_prior: bool = Field(True, description="Whether the hand measurement counts, or is but a start.")
    clock_offset_sigma_s: PositiveFloat | None = Field(
        None,
        description="How far the clocks of scan and navigation may differ, as sigma of a normal distribution about "
        "zero (s); the offset is then estimated with the pose. Not estimated if null.",
    )
    seed: NonNegativeInt = Field(0, description="Seed of all draws.")


def covariance_of_sigmas(position_m: float, rotation_rad: float) -> Floats:
    """Covariance (6, 6) of one sigma of position on every axis (m) and one of turn about every body axis (rad)."""
    return np.diag([position_m**2] * 3 + [rotation_rad**2] * 3)


def default_hand_covariance() -> Floats:
    """Covariance (6, 6) of a pose measured by hand: 0.1 m and 2 deg about every body axis."""
    return covariance_of_sigmas(HAND_POSITION_M, HAND_ROTATION_RAD)
