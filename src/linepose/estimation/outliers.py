"""Iterative removal of the worst observation (section 3.4)."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np
import pandas as pd
import pyarrow as pa
from numpy.typing import ArrayLike, NDArray
from pydantic import Field, PositiveFloat

from linepose.arrays import Floats
from linepose.errors import EstimationError
from linepose.estimation.optimise import Optimum, Search, optimise
from linepose.geometry.pose import N_PARAMETERS, POSE_COLUMNS
from linepose.settings import Settings
from linepose.tables import flags, floats, whole_numbers

if TYPE_CHECKING:
    from linepose.likelihood.base import Likelihood

OUTLIERS: Final = pa.schema(
    [
        *whole_numbers("n_observations", "observation"),
        *floats("error_px"),
        *flags("removed", "accepted"),
        *floats("neg_log_likelihood", *POSE_COLUMNS),
        *whole_numbers("n_evaluations"),
    ]
)


class OutlierSettings(Settings):
    """Iterative removal of the worst observation."""

    threshold_px: PositiveFloat = Field(5.0, description="Accepted when every observation's mean error is below (px).")
    minimum_observations: int = Field(10, ge=3, description="Removal goes on, for the figures, down to this many.")


@dataclass(frozen=True)
class RejectionStage:
    """One turn of the removal: the observations used (n,), their mean errors (n,), the optimum, the worst of them."""

    number: NDArray[np.int64]
    error_px: Floats
    optimum: Optimum
    worst: int


def reject_outliers(
    likelihood: "Likelihood",
    start: ArrayLike,
    minimum_observations: int,
    search: Search | None = None,
    progress: Callable[[int], None] = lambda _: None,
) -> list[RejectionStage]:
    """Optimise from the start pose (6,), remove the observation of largest mean error, repeat; most observations first.

    It goes on below the accepted stage, down to `minimum_observations`, so that the whole sequence can be shown.
    `progress` is told the number of observations of each finished stage.
    Raises EstimationError where no observation has an error, because the likelihood is undefined.
    """
    stages: list[RejectionStage] = []
    remaining = likelihood
    while True:
        optimum = optimise(remaining, start, search)
        error_px = remaining.residuals(optimum.parameters).mean_error_px()
        number = remaining.survey.number
        if np.all(np.isnan(error_px)):
            raise EstimationError(
                f"outlier rejection: none of {len(number)} observations has a reprojection error at the optimum; "
                "check the hand-measured pose and the observations"
            )
        worst = int(number[np.nanargmax(error_px)])
        stages.append(RejectionStage(number, error_px, optimum, worst))
        progress(len(number))
        if len(number) <= minimum_observations:
            return stages
        remaining = remaining.select([int(n) for n in number if n != worst])


def accepted_stage(
    stages: list[RejectionStage], threshold_px: float, words: Callable[[int], str] = "observation {}".format
) -> int:
    """Index of the first stage in which each observation's mean error is below the threshold.

    Raises EstimationError where none is, with the worst observation as `words` calls it by its number.
    """
    for index, stage in enumerate(stages):
        if np.nanmax(stage.error_px) < threshold_px:
            return index
    last = stages[-1]
    raise EstimationError(
        f"outlier rejection: with {len(last.number)} observations left, {words(last.worst)} still has a mean "
        f"error of {np.nanmax(last.error_px):.1f} px, expected below {threshold_px:g} px; check its labels and the "
        "navigation at its time, or raise outliers.threshold_px in config/config.yaml"
    )


def outlier_table(
    stages: list[RejectionStage], threshold_px: float, words: Callable[[int], str] = "observation {}".format
) -> pd.DataFrame:
    """One row an observation of a stage: its mean error, whether it is the one removed, whether the stage is accepted.

    Columns as in `OUTLIERS`; the last stage removes none. `words` as in `accepted_stage`.
    """
    accepted = accepted_stage(stages, threshold_px, words)
    rows = []
    for index, stage in enumerate(stages):
        pose = stage.optimum.parameters[:N_PARAMETERS]
        for number, error_px in zip(stage.number, stage.error_px, strict=True):
            rows.append(
                {
                    "n_observations": len(stage.number),
                    "observation": int(number),
                    "error_px": float(error_px),
                    "removed": index < len(stages) - 1 and int(number) == stage.worst,
                    "accepted": index == accepted,
                    "neg_log_likelihood": stage.optimum.neg_log_likelihood,
                    **dict(zip(POSE_COLUMNS, pose, strict=True)),
                    "n_evaluations": stage.optimum.n_evaluations,
                }
            )
    return pd.DataFrame(rows)


def stage_observations(outliers: pd.DataFrame) -> dict[str, list[int]]:
    """Observation numbers of each stage from all to the accepted one: `all`, `observations_24`, ..., `inliers`."""
    sizes = sorted(outliers["n_observations"].unique(), reverse=True)
    accepted = int(outliers.loc[outliers["accepted"], "n_observations"].iloc[0])
    between = {f"observations_{n}": n for n in sizes if accepted < n < sizes[0]}
    names = {"all": sizes[0], **between, "inliers": accepted}
    return {
        name: outliers.loc[outliers["n_observations"] == n, "observation"].astype(int).tolist()
        for name, n in names.items()
    }


def removal_order(outliers: pd.DataFrame) -> list[int]:
    """Observations in the order in which they are removed until the accepted stage."""
    accepted = int(outliers.loc[outliers["accepted"], "n_observations"].iloc[0])
    removed = outliers[outliers["removed"] & (outliers["n_observations"] > accepted)]
    return removed.sort_values("n_observations", ascending=False)["observation"].astype(int).tolist()
