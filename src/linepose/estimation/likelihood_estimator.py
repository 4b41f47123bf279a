"""Estimates from a likelihood: its optimum, with the covariance of the curvature there or of samples around it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.errors import EstimationError
from linepose.estimation.estimator import Estimate, Estimator
from linepose.estimation.optimise import Optimum, Search, laplace_covariance, optimise
from linepose.estimation.optimisers import OPTIMISERS, optimiser
from linepose.estimation.sampling import SamplingSettings, sample
from linepose.geometry.camera import Camera
from linepose.geometry.pose import N_PARAMETERS
from linepose.likelihood.base import Likelihood
from linepose.likelihood.pixels import PixelLikelihood
from linepose.survey.observations import Survey

_USUAL = ("powell", "wide")


@dataclass(frozen=True)
class LikelihoodEstimator(Estimator):
    """The most likely pose under a likelihood."""

    likelihood: Likelihood
    search: Search = field(default_factory=Search)
    sampling: SamplingSettings = field(default_factory=SamplingSettings)

    @property
    def survey(self) -> Survey:  # type: ignore[override]
        """The likelihood's survey."""
        return self.likelihood.survey

    @property
    def camera(self) -> Camera:  # type: ignore[override]
        """The likelihood's camera."""
        return self.likelihood.camera

    def select(self, numbers: Sequence[int]) -> "LikelihoodEstimator":
        """The same with these observations only."""
        return replace(self, likelihood=self.likelihood.select(list(numbers)))

    def estimate(self, start: ArrayLike, seed: int | None = None) -> Estimate:
        """The optimum from a start pose (6,); its covariance is the curvature's, a thousand times cheaper than samples.

        The curvature's is NaN where the observations leave a direction of the pose open.
        """
        optimum = optimise(self.likelihood, start, self.search)
        if seed is None:
            covariance = _curvature_or_nan(self.likelihood, optimum)
        else:
            covariance = sample(self.likelihood, optimum.parameters, seed, self.sampling).covariance()
        return self._estimate(optimum, covariance)

    def searches(self) -> tuple[str, ...]:
        """Those of `OPTIMISERS`."""
        return (*_USUAL, *(name for name in OPTIMISERS if name not in _USUAL))

    def search_by(self, name: str, start: ArrayLike) -> Estimate:
        """Where the search of this name ends from a start pose (6,)."""
        nothing = np.full((N_PARAMETERS, N_PARAMETERS), np.nan)
        return self._estimate(optimiser(name)(self.likelihood, np.asarray(start, dtype=float), self.search), nothing)

    def variations(self) -> Mapping[str, Estimator]:
        """With residuals in pixels, as calibrations without covariances have them."""
        return {"residual in pixels": replace(self, likelihood=PixelLikelihood(self.likelihood))}

    def _estimate(self, optimum: Optimum, covariance: Floats) -> Estimate:
        return Estimate(
            number=self.likelihood.survey.number,
            pose=optimum.parameters[:N_PARAMETERS],
            covariance=covariance[:N_PARAMETERS, :N_PARAMETERS],
            neg_log_likelihood=optimum.neg_log_likelihood,
            n_evaluations=optimum.n_evaluations,
        )


def _curvature_or_nan(likelihood: Likelihood, optimum: Optimum) -> Floats:
    try:
        return laplace_covariance(likelihood, optimum.parameters)
    except EstimationError:
        return np.full((likelihood.n_parameters, likelihood.n_parameters), np.nan)
