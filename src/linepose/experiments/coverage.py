"""Coverage: how often the region that an estimate calls 68 % holds the truth, over many surveys with a known truth.

For each survey the optimum is searched from the hand-measured pose, the posterior sampled by importance around it, and
the truth placed in it: the share of the posterior that lies nearer to its mean than the truth does (in Mahalanobis
distance) is the credibility of the smallest region that holds the truth. It is uniform over surveys where the estimate
says the truth about its uncertainty; a region of 68 % covers the surveys below 0.68. So is the rank of each true
parameter among independent draws (simulation-based calibration, Talts et al. 2018).
"""

import zlib
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import pandas as pd
import pyarrow as pa
from scipy.stats import chi2

from linepose.arrays import Floats
from linepose.errors import EstimationError, InputError
from linepose.estimation.importance import WeightedSamples, importance_samples
from linepose.estimation.noise_models import likelihood_of
from linepose.estimation.optimise import Optimum, laplace_covariance, minimise
from linepose.geometry.camera import Camera
from linepose.geometry.pose import N_PARAMETERS, POSE_COLUMNS, SIGMA_COLUMNS
from linepose.likelihood.base import Likelihood
from linepose.likelihood.shared import SharedPriors
from linepose.simulation.noise_levels import NoiseLevels
from linepose.simulation.noisy_survey import draw_survey
from linepose.simulation.settings import SimulationSettings
from linepose.survey.observations import Survey
from linepose.tables import flags, floats, optional_floats, texts, whole_numbers

N_RANKED: Final = 99  # draws among which the truth is ranked: a hundred ranks
TRUE_COLUMNS: Final = tuple(f"true_{name}" for name in POSE_COLUMNS)
RANK_COLUMNS: Final = tuple(f"rank_{name}" for name in POSE_COLUMNS)
LEVEL_COLUMNS: Final = ("shared_level", "white_level", "pixel_level")
TRUE_LEVEL_COLUMNS: Final = tuple(f"true_{name}" for name in LEVEL_COLUMNS)
CELL: Final = ["platform", "regime", "noise_model"]
_NOTHING: Final = float("nan")

COVERAGE_SURVEYS: Final = pa.schema(
    [
        *texts(*CELL),
        *whole_numbers("survey"),
        *floats(*TRUE_COLUMNS, *POSE_COLUMNS),
        *optional_floats(*TRUE_LEVEL_COLUMNS, *SIGMA_COLUMNS, *LEVEL_COLUMNS),
        *floats("neg_log_likelihood"),
        *whole_numbers("n_evaluations"),
        *flags("failed"),
        *optional_floats(*RANK_COLUMNS, "pareto_shape", "effective_sample_size"),
        *floats("laplace_credibility", "credibility"),
    ]
)


def levels_from_prior(random: np.random.Generator, priors: SharedPriors) -> NoiseLevels:
    """Levels as the shared-error model expects them before it has seen anything."""
    levels = np.log(priors.level_median) + priors.level_log_sigma * random.standard_normal(3)
    shared, white, pixel = np.exp(levels).tolist()
    return NoiseLevels(shared_level=shared, white_level=white, pixel_level=pixel)


@dataclass(frozen=True)
class Cell:
    """One cell of the study: a simulated platform under one regime of noise, estimated by one noise model.

    `levels` of the true noise, or None where they are drawn from the priors for each survey; start_pose (6,).
    """

    platform: str
    regime: str
    noise_model: str
    camera: Camera
    settings: SimulationSettings
    start_pose: Floats
    levels: NoiseLevels | None
    seed: int
    n_draws: int = 2000

    def survey(self, index: int) -> tuple[Survey, Floats, NoiseLevels]:
        """The survey of this number, the same for every noise model; its true pose (6,) and noise."""
        random = np.random.default_rng([self.seed, *map(_digest, (self.platform, self.regime)), index])
        levels = self.levels or levels_from_prior(random, SharedPriors())
        return *draw_survey(self.camera, self.settings, levels, random), levels

    def likelihood(self, survey: Survey) -> Likelihood:
        """The noise model's likelihood of a survey; raises InputError for a name that is none."""
        return likelihood_of(self.noise_model, survey, self.camera, self.start_pose)

    def compile(self) -> None:
        """Evaluate the likelihood once, on one core, so that processes that fork from this one need not compile it."""
        likelihood = self.likelihood(self.survey(0)[0])
        likelihood.log_likelihood(likelihood.start(self.start_pose))

    def row(self, index: int) -> dict[str, Any]:
        """One row: a survey's estimate, and where the truth lies in its posterior."""
        survey, truth, levels = self.survey(index)
        random = np.random.default_rng([self.seed, _digest(self.noise_model), index])
        return {
            "platform": self.platform,
            "regime": self.regime,
            "noise_model": self.noise_model,
            "survey": index,
            **dict(zip(TRUE_COLUMNS, truth, strict=True)),
            **dict(
                zip(
                    TRUE_LEVEL_COLUMNS,
                    (levels.shared_level, levels.white_level, _or_nothing(levels.pixel_level)),
                    strict=True,
                )
            ),
            **self._estimate(survey, truth, random),
        }

    def _estimate(self, survey: Survey, truth: Floats, random: np.random.Generator) -> dict[str, Any]:
        """The row's estimate; a survey so noisy that a point lies behind the camera at the start has none."""
        try:
            likelihood = self.likelihood(survey)
        except InputError:
            return failed_row(Optimum(self.start_pose, 0.0, 0, converged=False))
        return estimate_row(likelihood, self.start_pose, truth, random, self.n_draws)

    def rows(self, surveys: Iterable[int]) -> pd.DataFrame:
        """One row a survey; each depends on its number alone, not on which others are estimated with it."""
        return pd.DataFrame([self.row(index) for index in surveys])


def estimate_row(
    likelihood: Likelihood, start_pose: Floats, truth: Floats, random: np.random.Generator, n_draws: int
) -> dict[str, Any]:
    """Where the true pose (6,) lies in the posterior, from a start pose (6,).

    An estimate that fails (the curvature leaves a direction open) has no region and so does not hold the truth: its
    credibilities are 1, and what it has no number for is NaN.
    """
    found = minimise(likelihood, likelihood.start(start_pose), start_pose)
    row = failed_row(found)
    try:
        covariance = laplace_covariance(likelihood, found.parameters)
        samples = importance_samples(likelihood, found.parameters, covariance, random, n_draws)
    except EstimationError:
        return row
    error = (found.parameters - likelihood.start(truth))[:N_PARAMETERS]
    distance2 = error @ np.linalg.solve(covariance[:N_PARAMETERS, :N_PARAMETERS], error)
    ranks = np.sum(samples.resample(random, N_RANKED)[:, :N_PARAMETERS] < truth, axis=0).astype(float)
    levels = np.exp(samples.mean()[N_PARAMETERS : N_PARAMETERS + 3])
    return row | {
        "failed": not found.converged,
        **dict(zip(SIGMA_COLUMNS, np.sqrt(np.diag(samples.covariance())), strict=False)),
        **dict(zip(LEVEL_COLUMNS, levels, strict=False)),
        **dict(zip(RANK_COLUMNS, ranks, strict=True)),
        "pareto_shape": samples.pareto_shape,
        "effective_sample_size": samples.effective_sample_size,
        "laplace_credibility": float(chi2.cdf(distance2, N_PARAMETERS)),
        "credibility": credibility(samples, truth),
    }


def failed_row(found: Optimum) -> dict[str, Any]:
    """What is told of an estimate that failed: where the search ended, and that no region holds the truth."""
    unknown = [*SIGMA_COLUMNS, *LEVEL_COLUMNS, *RANK_COLUMNS, "pareto_shape", "effective_sample_size"]
    return {
        **dict(zip(POSE_COLUMNS, found.parameters, strict=False)),
        "neg_log_likelihood": found.neg_log_likelihood,
        "n_evaluations": found.n_evaluations,
        "failed": True,
        **dict.fromkeys(unknown, _NOTHING),
        "laplace_credibility": 1.0,
        "credibility": 1.0,
    }


def credibility(samples: WeightedSamples, truth: Floats) -> float:
    """Share of the posterior nearer to its mean than the truth (6,), in Mahalanobis distance of the first six."""
    pose, mean = samples.parameters[:, :N_PARAMETERS], samples.mean()[:N_PARAMETERS]
    factor = np.linalg.cholesky(samples.covariance()[:N_PARAMETERS, :N_PARAMETERS])
    distance = np.linalg.norm(np.linalg.solve(factor, (pose - mean).T), axis=0)
    return float(samples.weights @ (distance < np.linalg.norm(np.linalg.solve(factor, truth - mean))))


def _or_nothing(level: float | None) -> float:
    return _NOTHING if level is None else level


def _digest(name: str) -> int:
    return zlib.crc32(name.encode())
