"""Levels: the scales of the variance components, which the adjustment estimates from the data, and their priors.

Navigation errors are scaled in units of the reported sigmas, pixels in the camera's sigma, lateness in lines.
"""

from typing import Final, NamedTuple

import numpy as np
from pydantic import Field, field_validator

from linepose.arrays import Floats
from linepose.settings import Settings


class Levels(NamedTuple):
    """Scales of the error process, all positive; zero switches a component off.

    drift: the Gauss-Markov part of the navigation error; white: its part that is independent from measurement to
    measurement; constant: its part that a view shares; pixel: noise along the line; lateness: noise across the line
    (lines); correlation_time_s: of the drift; attitude: factor of the reported attitude sigmas in all three parts.
    """

    drift: float
    white: float
    constant: float
    pixel: float
    lateness: float
    correlation_time_s: float
    attitude: float


LEVEL_NAMES: Final = Levels._fields
N_LEVELS: Final = len(LEVEL_NAMES)
START: Final = Levels(0.5, 0.5, 0.5, 0.5, 0.5, 60.0, 1.0)
MEDIAN: Final = Levels(0.5, 0.5, 0.5, 0.5, 0.5, 300.0, 1.0)
LOG_SIGMA: Final = Levels(1.5, 1.5, 1.5, 1.5, 0.7, 2.0, 0.5)
LEAST, LARGEST = 1e-6, 1e6  # that a level or its median can be given as
_LEAST_LOG_SIGMA, _LARGEST_LOG_SIGMA = 1e-3, 10.0


def check_levels(levels: Levels) -> Levels:
    """The levels; raises ValueError for one that no error has, in words for people."""
    if not all(LEAST <= one <= LARGEST for one in levels):
        raise ValueError(f"{N_LEVELS} numbers from {LEAST:g} to {LARGEST:g}")
    return levels


class LevelPriors(Settings):
    """Log-normal prior of every level: its median, and its sigma in the natural logarithm."""

    median: Levels = Field(MEDIAN, description=f"Median of each: {', '.join(LEVEL_NAMES)}.")
    log_sigma: Levels = Field(LOG_SIGMA, description="Sigma of the natural logarithm of each, in the same order.")

    @field_validator("median")
    @classmethod
    def _are_levels(cls, median: Levels) -> Levels:
        return check_levels(median)

    @field_validator("log_sigma")
    @classmethod
    def _are_sigmas(cls, log_sigma: Levels) -> Levels:
        if not all(_LEAST_LOG_SIGMA <= one <= _LARGEST_LOG_SIGMA for one in log_sigma):
            raise ValueError(f"{N_LEVELS} numbers from {_LEAST_LOG_SIGMA:g} to {_LARGEST_LOG_SIGMA:g}")
        return log_sigma


def levels_from_log(log_levels: Floats) -> Levels:
    """Levels of their natural logarithms (7,); minus infinity is a component that is switched off."""
    return Levels(*np.exp(np.asarray(log_levels, dtype=float)).tolist())


def log_from_levels(levels: Levels) -> Floats:
    """Natural logarithms (7,) of the levels; minus infinity for zero."""
    with np.errstate(divide="ignore"):
        return np.log(np.asarray(levels, dtype=float))
