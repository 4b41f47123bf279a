"""One estimate of the pose from one set of observations: what every experiment repeats under another condition."""

from dataclasses import dataclass

import numpy as np
import pyarrow as pa
from numpy.typing import ArrayLike, NDArray

from linepose.arrays import Floats
from linepose.errors import EstimationError
from linepose.estimation.optimise import Optimum, Search, laplace_covariance, minimise, optimise
from linepose.estimation.sampling import IndependenceSettings, SamplingSettings, sample
from linepose.geometry.pose import N_PARAMETERS, POSE_COLUMNS, SIGMA_COLUMNS
from linepose.likelihood.base import Likelihood
from linepose.tables import floats, optional_floats, texts, whole_numbers


@dataclass(frozen=True)
class Estimate:
    """A pose (6,) with its covariance (6, 6), the observations (n,) it rests on, and -log L there."""

    number: NDArray[np.int64]
    pose: Floats
    covariance: Floats
    neg_log_likelihood: float
    n_evaluations: int

    def sigma(self) -> Floats:
        """One standard deviation of each number of the pose (6,)."""
        return np.sqrt(np.diag(self.covariance))

    def row(self) -> dict[str, object]:
        """The estimate as the columns of one table row."""
        return {
            "n_observations": len(self.number),
            "observations": observation_list(self.number),
            **dict(zip(POSE_COLUMNS, self.pose, strict=True)),
            **dict(zip(SIGMA_COLUMNS, self.sigma(), strict=True)),
            "neg_log_likelihood": self.neg_log_likelihood,
            "n_evaluations": self.n_evaluations,
        }


def estimate_fields(suffix: str = "") -> list[pa.Field]:
    """The columns of `Estimate.row`, with a suffix at their end; a sigma of a pose that is left open is null."""
    return [
        *whole_numbers(f"n_observations{suffix}"),
        *texts(f"observations{suffix}"),
        *floats(*(f"{name}{suffix}" for name in POSE_COLUMNS)),
        *optional_floats(*(f"{name}{suffix}" for name in SIGMA_COLUMNS)),
        *floats(f"neg_log_likelihood{suffix}"),
        *whole_numbers(f"n_evaluations{suffix}"),
    ]


def observation_list(numbers: ArrayLike) -> str:
    """Observation numbers as a table shows them, in the given order, a space between."""
    return " ".join(str(int(number)) for number in np.asarray(numbers))


def estimate_by_sampling(
    likelihood: Likelihood,
    start: ArrayLike,
    seed: int,
    search: Search | None = None,
    settings: SamplingSettings | IndependenceSettings | None = None,
) -> Estimate:
    """The optimum from a start pose (6,), with the covariance of samples around it."""
    optimum = optimise(likelihood, start, search)
    chain = sample(likelihood, optimum.parameters, seed, settings)
    return _estimate(likelihood, optimum, chain.covariance())


def estimate_by_curvature(likelihood: Likelihood, start: ArrayLike, search: Search | None = None) -> Estimate:
    """The optimum from a start pose (6,), with the covariance of the curvature there: a thousand times cheaper.

    The covariance is NaN where the observations leave a direction of the pose open.
    """
    optimum = optimise(likelihood, start, search)
    return _estimate(likelihood, optimum, _curvature_or_nan(likelihood, optimum))


def estimate_nearby(
    likelihood: Likelihood, parameters: ArrayLike, start: ArrayLike, search: Search | None = None
) -> Estimate:
    """As `estimate_by_curvature`, by gradients from parameters (P,) that are nearly right: ten times cheaper again.

    The search's range lies around the start pose (6,).
    """
    optimum = minimise(likelihood, parameters, start, search)
    return _estimate(likelihood, optimum, _curvature_or_nan(likelihood, optimum))


def _curvature_or_nan(likelihood: Likelihood, optimum: Optimum) -> Floats:
    try:
        return laplace_covariance(likelihood, optimum.parameters)
    except EstimationError:
        return np.full((likelihood.n_parameters, likelihood.n_parameters), np.nan)


def _estimate(likelihood: Likelihood, optimum: Optimum, covariance: Floats) -> Estimate:
    return Estimate(
        number=likelihood.survey.number,
        pose=optimum.parameters[:N_PARAMETERS],
        covariance=covariance[:N_PARAMETERS, :N_PARAMETERS],
        neg_log_likelihood=optimum.neg_log_likelihood,
        n_evaluations=optimum.n_evaluations,
    )
