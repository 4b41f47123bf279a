"""What the data say of each parameter, and what they leave open: prior against posterior.

Works on any noise model. Parameters that have no prior of their own (the pose) are compared with the sigmas with which
they were known by hand; their shrinkage is negative where the data alone say less than the hand measurement. Give the
covariance of samples, or the inverse curvature at the optimum.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.errors import EstimationError, InputError
from linepose.geometry import rotations
from linepose.geometry.pose import TURN_WORDS

TURN_NAMES: Final = ("roll_rad", "pitch_rad", "yaw_rad")
DATA: Final = "data"
PRIOR: Final = "prior"
BOTH: Final = "data and prior"
_DECIDING: Final = 0.75  # of the weight; the sigma is then half the prior's or less
NOTABLE_SHARE: Final = 0.35  # of the largest component: what is named in the weakest direction
WORDS: Final = {
    "r_x_m": "r_x",
    "r_y_m": "r_y",
    "r_z_m": "r_z",
    "theta_x_rad": "theta_x",
    "theta_y_rad": "theta_y",
    "theta_z_rad": "theta_z",
    **{f"{axis}_rad": f"the {words}" for axis, words in TURN_WORDS.items()},
    "log_shared_level": "the shared level",
    "log_white_level": "the white level",
    "log_pixel_level": "the pixel level",
    "principal_point_px": "the principal point",
    "focal_length_m": "the focal length",
}


@dataclass(frozen=True)
class Identifiability:
    """How far the data narrow each of P parameters, and the direction that they narrow least.

    names; prior_sigma, posterior_sigma (P,); shrinkage (P,): 1 - (posterior / prior variance), 1 where the data decide
    and 0 where they say nothing; weakest_direction (P,): in prior sigmas, of unit length; weakest_shrinkage: the same
    measure along it; correlation (P, P) of the posterior.
    """

    names: tuple[str, ...]
    prior_sigma: Floats
    posterior_sigma: Floats
    shrinkage: Floats
    weakest_direction: Floats
    weakest_shrinkage: float
    correlation: Floats

    def weakest_in_words(self) -> str:
        """The weakest direction, for example "r_z with the focal length": its notable parts, largest first."""
        return in_words(self.names, self.weakest_direction)


def identifiability(names: Sequence[str], posterior_covariance: ArrayLike, prior_sigma: ArrayLike) -> Identifiability:
    """Compare the posterior (P, P) with independent priors (P,), both in the parameters' units.

    The weakest direction has the largest posterior variance once each parameter is measured in sigmas of its prior.
    Raises InputError for a prior that is not positive and finite, EstimationError for a covariance that is not one.
    """
    covariance, prior = np.asarray(posterior_covariance, dtype=float), np.asarray(prior_sigma, dtype=float)
    if prior.shape != (len(names),) or not np.all(np.isfinite(prior) & (prior > 0)):
        raise InputError(
            "prior sigma",
            f"{prior.tolist()}",
            f"{len(names)} positive numbers",
            "give the pose the sigmas of the hand measurement",
        )
    if covariance.shape != (len(names), len(names)) or not np.all(np.isfinite(covariance)):
        raise EstimationError(f"no identifiability: the posterior covariance has shape {covariance.shape} or gaps")
    values, vectors = np.linalg.eigh((covariance + covariance.T) / 2 / np.outer(prior, prior))
    if values[0] <= 0:
        raise EstimationError(
            f"no identifiability: the posterior covariance has the eigenvalue {values[0]:.3g}; draw a longer chain"
        )
    sigma = np.sqrt(np.diagonal(covariance))
    weakest = vectors[:, -1]
    return Identifiability(
        names=tuple(names),
        prior_sigma=prior,
        posterior_sigma=sigma,
        shrinkage=1 - (sigma / prior) ** 2,
        weakest_direction=weakest * np.sign(weakest[np.argmax(np.abs(weakest))]),
        weakest_shrinkage=float(1 - values[-1]),
        correlation=covariance / np.outer(sigma, sigma),
    )


def data_weight(sigma: ArrayLike, prior_sigma: ArrayLike, counted_in: bool) -> Floats:
    """The data's share of the information, 0 to 1, of a parameter whose sigma has the prior counted in, or has not."""
    ratio = np.square(np.asarray(sigma, dtype=float) / np.asarray(prior_sigma, dtype=float))
    return np.clip(1 - ratio, 0.0, 1.0) if counted_in else 1 / (1 + ratio)


def decider(weight: float) -> str:
    """Who decided a parameter with this weight of the data, the prior counted in: `DATA`, `PRIOR` or `BOTH`."""
    if weight >= _DECIDING:
        return DATA
    return PRIOR if weight <= 1 - _DECIDING else BOTH


def in_words(names: Sequence[str], direction: ArrayLike) -> str:
    """A direction (P,) as its notable parts, largest first: "r_z with the turn about forward against r_x".

    "with" joins what grows together with the first part, "against" what falls.
    """
    parts = np.asarray(direction, dtype=float)
    order = np.argsort(-np.abs(parts), kind="stable")
    first = order[0]
    words = [WORDS.get(names[first], names[first])]
    for index in order[1:]:
        if abs(parts[index]) < NOTABLE_SHARE * abs(parts[first]):
            break
        joint = "with" if parts[index] * parts[first] > 0 else "against"
        words.append(f"{joint} {WORDS.get(names[index], names[index])}")
    return " ".join(words)


def in_body_axes(names: Sequence[str], parameters: ArrayLike, covariance: ArrayLike) -> tuple[tuple[str, ...], Floats]:
    """Names and covariance (P, P) with the camera's rotation vector replaced by small turns about the body's axes.

    Turns about forward, right and down (rad) mean something to a reader; components of a rotation
    vector do not. The first six of the parameters (P,) are the pose.
    """
    vector = np.asarray(parameters, dtype=float)
    jacobian = np.eye(len(vector))
    jacobian[3:6, 3:6] = rotations.left_jacobian_so3(vector[3:6])
    return (*names[:3], *TURN_NAMES, *names[6:]), jacobian @ np.asarray(covariance, dtype=float) @ jacobian.T
