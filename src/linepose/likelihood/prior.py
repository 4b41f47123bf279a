"""The hand measurement as a Gaussian prior of the pose, added to any noise model.

The rotation's part is measured on the rotations themselves: the turn in body axes that takes the prior's rotation to
the pose's. A difference of rotation vectors would break near half a turn, where two vectors of opposite sign are almost
the same rotation.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.geometry.distance import difference_covariance, pose_difference
from linepose.geometry.pose import N_PARAMETERS, check_pose
from linepose.likelihood.base import Likelihood, Residuals


@dataclass(frozen=True)
class PosePrior:
    """A pose (6,) with a rotation vector, and the covariance (6, 6) of position (m) and turn in body axes (rad)."""

    pose: Floats
    covariance: Floats

    def difference(self, poses: ArrayLike) -> Floats:
        """Position and turn in body axes from the prior to poses (..., 6), each turn at most half a turn; (..., 6)."""
        return pose_difference(poses, self.pose)

    def log_density(self, poses: ArrayLike) -> Floats:
        """Logarithm of the density at poses (..., 6), but for a constant; (...)."""
        difference = self.difference(poses)
        return np.asarray(-0.5 * np.einsum("...i,ij,...j->...", difference, np.linalg.inv(self.covariance), difference))

    def sigma(self) -> Floats:
        """One standard deviation of position and turn in body axes (6,)."""
        return np.sqrt(np.diag(self.covariance))


def pose_prior(pose: ArrayLike, covariance: ArrayLike) -> PosePrior:
    """The prior around a pose (6,) whose position and rotation vector have a covariance (6, 6), to first order.

    Raises InputError for a covariance that is not positive definite.
    """
    centre = check_pose(pose, "prior")
    turned = difference_covariance(centre, covariance)
    if not (np.all(np.isfinite(turned)) and np.linalg.eigvalsh(turned)[0] > 0):
        raise InputError("prior", "a covariance that is not positive definite", "one that is", "give positive sigmas")
    return PosePrior(centre, turned)


class WithPrior(Likelihood):
    """A noise model with the logarithm of a pose's prior added to its log-likelihood.

    All else is the inner model's: parameters, where they are searched, residuals.
    """

    def __init__(self, inner: Likelihood, prior: PosePrior) -> None:
        self.survey = inner.survey
        self.camera = inner.camera
        self.inner = inner
        self.prior = prior

    @property
    def parameter_names(self) -> tuple[str, ...]:
        """Those of the inner model."""
        return self.inner.parameter_names

    def start(self, pose: ArrayLike) -> Floats:
        """That of the inner model."""
        return self.inner.start(pose)

    def half_widths(self, translation_m: float, rotation_rad: float) -> Floats:
        """Those of the inner model."""
        return self.inner.half_widths(translation_m, rotation_rad)

    def initial_walker_sigma(self, translation_m: float, rotation_rad: float) -> Floats:
        """That of the inner model."""
        return self.inner.initial_walker_sigma(translation_m, rotation_rad)

    def chi_square(self, parameters: ArrayLike) -> tuple[float, int]:
        """That of the inner model: the prior is not a residual."""
        return self.inner.chi_square(parameters)

    def log_likelihood(self, parameters: ArrayLike) -> float:
        """Logarithm of likelihood times prior at one parameter vector (P,)."""
        pose = np.asarray(parameters, dtype=float)[:N_PARAMETERS]
        return self.inner.log_likelihood(parameters) + float(self.prior.log_density(pose))

    def log_likelihoods(self, parameters: ArrayLike) -> Floats:
        """The same of each row; (K, P) to (K,)."""
        rows = np.array(parameters, dtype=float, ndmin=2)
        return self.inner.log_likelihoods(rows) + self.prior.log_density(rows[:, :N_PARAMETERS])

    def residuals(self, parameters: ArrayLike) -> Residuals:
        """Those of the inner model: the prior has none."""
        return self.inner.residuals(parameters)

    def without_cheirality(self) -> "WithPrior":
        """The inner model without cheirality with the same prior."""
        return WithPrior(self.inner.without_cheirality(), self.prior)

    def select(self, numbers: Sequence[int]) -> "WithPrior":
        """The inner model of these observations only, with the whole prior: the tape measured once."""
        return WithPrior(self.inner.select(numbers), self.prior)
