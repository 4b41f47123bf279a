"""What the experiments start from: the accepted observations' likelihood, their optimum, and its sampled covariance."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from linepose.arrays import Floats
from linepose.config.platform import Platform
from linepose.estimation.outliers import OUTLIERS, stage_observations
from linepose.geometry.pose import N_PARAMETERS
from linepose.likelihood.base import Likelihood
from linepose.pipeline.platform_likelihood import platform_likelihood
from linepose.pipeline.stages import OPTIMA, SAMPLES, samples_from_table
from linepose.survey.observations import OBSERVATIONS, survey_from_table
from linepose.tables import read_table


@dataclass(frozen=True)
class Accepted:
    """A platform's likelihood of all its observations, `all`, and of those that the outlier removal accepted."""

    all: Likelihood
    accepted: Likelihood


@dataclass(frozen=True)
class Reference:
    """The accepted observations' optimum (P,) and the pose's sampled covariance (6, 6)."""

    parameters: Floats
    covariance: Floats

    @property
    def pose(self) -> Floats:
        """The optimum's pose (6,)."""
        return self.parameters[:N_PARAMETERS]


def read_accepted(platform: Platform, observations: Path | str, outliers: Path | str) -> Accepted:
    """From the results of the stages `associate` and `reject_outliers`."""
    survey = survey_from_table(read_table(observations, OBSERVATIONS))
    likelihood = platform_likelihood(platform, survey)
    inliers = stage_observations(read_table(outliers, OUTLIERS))["inliers"]
    return Accepted(likelihood, likelihood.select(inliers))


def read_reference(likelihood: Likelihood, optima: Path | str, samples: Path | str) -> Reference:
    """From the results of the stages `optimise` and `sample`; `samples` is the folder of all stages' samples."""
    names = list(likelihood.parameter_names)
    optimum = read_table(optima, OPTIMA).set_index("stage").loc["inliers", names]
    chain = samples_from_table(read_table(Path(samples) / "inliers.parquet", SAMPLES), names[:N_PARAMETERS])
    return Reference(optimum.to_numpy(dtype=float, copy=True), np.cov(chain.reshape(-1, N_PARAMETERS).T))
