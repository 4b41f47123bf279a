"""Iterative removal of the worst observation (section 3.4)."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linepose.errors import EstimationError
from linepose.likelihood.base import Likelihood
from linepose.optimise import Optimum, Search, optimise
from linepose.rotations import Floats


@dataclass(frozen=True)
class RejectionStage:
    """One turn of the removal: the observations used (n,), their mean errors (n,), the optimum, the worst of them."""

    number: NDArray[np.int64]
    error_px: Floats
    optimum: Optimum
    worst: int


def reject_outliers(
    likelihood: Likelihood,
    start: ArrayLike,
    minimum_observations: int,
    search: Search | None = None,
    progress: Callable[[int], None] = lambda _: None,
) -> list[RejectionStage]:
    """Optimise from the start pose (6,), remove the observation of largest mean error, repeat; most observations first.

    It goes on below the accepted stage, down to `minimum_observations`, so that the whole sequence can be shown.
    `progress` is told the number of observations of each finished stage.
    """
    stages: list[RejectionStage] = []
    remaining = likelihood
    while True:
        optimum = optimise(remaining, start, search)
        error_px = remaining.residuals(optimum.parameters).mean_error_px()
        number = remaining.survey.number
        worst = int(number[np.nanargmax(error_px)])
        stages.append(RejectionStage(number, error_px, optimum, worst))
        progress(len(number))
        if len(number) <= minimum_observations:
            return stages
        remaining = remaining.select([int(n) for n in number if n != worst])


def accepted_stage(stages: list[RejectionStage], threshold_px: float) -> int:
    """Index of the first stage in which each observation's mean error is below the threshold.

    Raises EstimationError where none is.
    """
    for index, stage in enumerate(stages):
        if np.nanmax(stage.error_px) < threshold_px:
            return index
    last = stages[-1]
    raise EstimationError(
        f"outlier rejection: with {len(last.number)} observations left, observation {last.worst} still has a mean "
        f"error of {np.nanmax(last.error_px):.1f} px, expected below {threshold_px:g} px; check the labels and the "
        "navigation, or raise outliers.threshold_px"
    )
