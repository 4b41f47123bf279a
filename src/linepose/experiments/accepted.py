"""What the experiments start from: estimators of all and of the accepted observations, and the platform's estimate."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from linepose.arrays import Floats
from linepose.config.platform import Platform
from linepose.estimation.estimator import Conditions, Estimator
from linepose.estimation.outliers import OUTLIERS, stage_observations
from linepose.geometry.pose import N_PARAMETERS, POSE_COLUMNS
from linepose.pipeline.platform_estimator import platform_estimator
from linepose.pipeline.stages import OPTIMA, SAMPLES, samples_from_table
from linepose.survey.observations import OBSERVATIONS, survey_from_table
from linepose.tables import read_table


@dataclass(frozen=True)
class Accepted:
    """Estimators of all of a platform's observations, `all`, and of those that are accepted."""

    all: Estimator
    accepted: Estimator


@dataclass(frozen=True)
class Reference:
    """The accepted observations' pose (6,) and its covariance (6, 6), of its samples."""

    pose: Floats
    covariance: Floats


def read_accepted(
    platform: Platform, conditions: Conditions, observations: Path | str, outliers: Path | str
) -> Accepted:
    """From the observations and the table of which are accepted."""
    survey = survey_from_table(read_table(observations, OBSERVATIONS))
    estimator = platform_estimator(platform, survey, conditions)
    inliers = stage_observations(read_table(outliers, OUTLIERS))["inliers"]
    return Accepted(estimator, estimator.select(inliers))


def read_reference(optima: Path | str, samples: Path | str) -> Reference:
    """From the tables of optima and samples; `samples` is the folder of all stages' samples."""
    names = list(POSE_COLUMNS)
    optimum = read_table(optima, OPTIMA).set_index("stage").loc["inliers", names]
    chain = samples_from_table(read_table(Path(samples) / "inliers.parquet", SAMPLES), names)
    return Reference(optimum.to_numpy(dtype=float, copy=True), np.cov(chain.reshape(-1, N_PARAMETERS).T))
