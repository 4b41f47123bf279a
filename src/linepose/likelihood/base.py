"""What every likelihood offers: the log-likelihood of one pose, of many, and the residuals behind it."""

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.geometry.camera import Camera
from linepose.geometry.pose import N_PARAMETERS, POSE_COLUMNS
from linepose.survey.observations import Survey


@dataclass(frozen=True)
class Residuals:
    """What a likelihood says of one pose; N observations, M points, NaN where there is nothing.

    error_px, sigma_px (N, M): reprojection error and its sigma; error_uv_px (N, M, 2): observed minus reprojected,
    along the line and across it; point_m (M, 3), point_covariance (M, 3, 3): estimated points, from the survey origin.
    """

    error_px: Floats
    sigma_px: Floats
    error_uv_px: Floats
    point_m: Floats
    point_covariance: Floats

    def mean_error_px(self) -> Floats:
        """Mean reprojection error of each observation over the points it has (N,); NaN where it has none."""
        count = np.sum(np.isfinite(self.error_px), axis=1)
        total = np.nansum(self.error_px, axis=1)
        return np.where(count > 0, total / np.maximum(count, 1), np.nan)


class Likelihood(ABC):
    """The log-likelihood of a survey given the parameters, of which the first six are the camera's pose.

    A likelihood with parameters of its own (a clock offset) appends them.
    A parameter vector at which the model is undefined (a point behind the camera) has minus infinity.
    """

    survey: Survey
    camera: Camera

    @property
    def parameter_names(self) -> tuple[str, ...]:
        """Names of the parameters with their units, the pose's first."""
        return POSE_COLUMNS

    @property
    def n_parameters(self) -> int:
        """Number of parameters, at least six."""
        return len(self.parameter_names)

    def start(self, pose: ArrayLike) -> Floats:
        """Parameters (P,) from which to search, given a pose (6,)."""
        return np.asarray(pose, dtype=float)[:N_PARAMETERS].copy()

    def half_widths(self, translation_m: float, rotation_rad: float) -> Floats:
        """Half of the range (P,) in which each parameter is searched around `start`."""
        return np.repeat([translation_m, rotation_rad], 3)

    def initial_walker_sigma(self, translation_m: float, rotation_rad: float) -> Floats:
        """Sigma (P,) with which walkers are scattered around the optimum, given the pose's."""
        return np.repeat([translation_m, rotation_rad], 3)

    @abstractmethod
    def log_likelihoods(self, parameters: ArrayLike) -> Floats:
        """Log-likelihood of each row; (K, P) to (K,), on all cores that the process may use."""

    @abstractmethod
    def log_likelihood(self, parameters: ArrayLike) -> float:
        """Log-likelihood of one parameter vector (P,), on one core."""

    @abstractmethod
    def residuals(self, parameters: ArrayLike) -> Residuals:
        """Residuals and estimated points at one parameter vector (P,)."""

    def chi_square(self, parameters: ArrayLike) -> tuple[float, int]:
        """Sum of the residuals' squares in sigmas at the optimum (P,), and what right sigmas make of it about.

        Here each point counts once, by its error's length over the sigma in that direction.
        """
        residuals = self.residuals(parameters)
        normalised = residuals.error_px / residuals.sigma_px
        freedom = int(np.isfinite(normalised).sum()) - N_PARAMETERS
        return float(np.nansum(normalised**2)), max(freedom, 1)

    def without_cheirality(self) -> "Likelihood":
        """The same model with points behind the camera reprojected as if in front, as the paper's equations have it.

        A model that makes no difference between the two is its own.
        """
        return self

    @abstractmethod
    def select(self, numbers: Sequence[int]) -> "Likelihood":
        """The same model of these observations only."""
