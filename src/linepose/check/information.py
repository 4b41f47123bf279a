"""How well the pose will be known, before anything is estimated: the information in a survey's geometry.

The survey is replayed as if the hand-measured pose were the true one and disturbed by errors as they are reported; the
inverse curvature of -log L at its optimum is the covariance that a calibration comes out with if all observations are
good. (At the true pose itself the published model's curvature need not be positive: its sigma turns with the error.)
"""

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.check.replay import crossing, disturbed
from linepose.errors import EstimationError, InputError
from linepose.estimation.optimise import Search, laplace_covariance, optimise
from linepose.geometry.camera import Camera
from linepose.geometry.pose import N_PARAMETERS
from linepose.likelihood.base import Likelihood
from linepose.likelihood.published import PublishedLikelihood
from linepose.likelihood.shared import SharedLikelihood
from linepose.survey.observations import Survey

N_DRAWS: Final = 2  # simulated surveys: their sigmas agree within a tenth
_STEPS: Final = np.repeat([2e-3, 5e-4], 3)  # m and rad: a tenth of a good calibration's sigmas
_INTRINSIC_STEPS: Final = 0.05  # of the intrinsics' own sigmas
_LEVELS: Final = np.log([1.0, 0.1, 1.0])  # navigation errors as reported, alike in a view; pixel errors as stated
_SIGNS: Final = np.array([1.0, -1.0])
_SEED: Final = 2017
_SEARCH: Final = Search(half_width_m=1.0, half_width_deg=30.0)


class _OneByOne(Likelihood):
    """Batches evaluated one by one: a kernel of batches takes as long to compile as the rest of a check does."""

    def log_likelihoods(self, parameters: ArrayLike) -> Floats:
        return np.array([self.log_likelihood(row) for row in np.asarray(parameters, dtype=float)])


class _Published(_OneByOne, PublishedLikelihood):
    pass


class _Shared(_OneByOne, SharedLikelihood):
    pass


def published_covariance(
    survey: Survey, camera: Camera, pose: Floats, point_m: Floats, n_draws: int = N_DRAWS
) -> Floats:
    """Covariance (6, 6) of the pose to be expected under the published model, of a replayed survey of points (M, 3).

    Raises EstimationError where the geometry leaves a direction of the pose open.
    """
    rng = np.random.default_rng(_SEED)
    points = np.broadcast_to(point_m, survey.position_m.shape)
    distance = crossing(camera, pose, survey.position_m, survey.euler_rad, points).distance_m
    total = np.zeros((N_PARAMETERS, N_PARAMETERS))
    for _ in range(n_draws):
        likelihood = _Published(disturbed(survey, camera, distance, rng), camera)
        total += laplace_covariance(likelihood, optimise(likelihood, pose, _SEARCH).parameters)
    return total / n_draws


def shared_covariance(survey: Survey, camera: Camera, pose: Floats) -> Floats | None:
    """The same under the shared-error model: every navigation error as reported, and alike for all points of a view.

    The levels do not bear on the pose's information and are held; the intrinsics are estimated within their sigmas.
    None where the model does not apply, because a sigma of the camera is zero.
    """
    try:
        likelihood = _Shared(survey, camera)
    except InputError:
        return None
    centre = likelihood.start(pose)
    centre[N_PARAMETERS : N_PARAMETERS + len(_LEVELS)] = _LEVELS
    free = np.array([*range(N_PARAMETERS), likelihood.n_parameters - 2, likelihood.n_parameters - 1])
    intrinsic = [camera.sigmas.principal_point_px, camera.sigmas.focal_length_m]
    steps = np.concatenate([_STEPS, _INTRINSIC_STEPS * np.array(intrinsic)])
    return _inverse(_curvature(likelihood, centre, free, steps))[:N_PARAMETERS, :N_PARAMETERS]


def _curvature(likelihood: Likelihood, centre: Floats, free: np.ndarray, steps: Floats) -> Floats:
    """Second derivatives (F, F) of -log L by the free parameters (F,), by central differences with steps (F,)."""
    axes = np.zeros((len(free), len(centre)))
    axes[np.arange(len(free)), free] = steps
    pairs = [(i, j) for i in range(len(free)) for j in range(i, len(free))]
    offsets = [a * axes[i] + b * axes[j] for i, j in pairs for a in _SIGNS for b in _SIGNS]
    quads = -likelihood.log_likelihoods(centre + np.array(offsets)).reshape(-1, 4)
    curvature = np.empty((len(free), len(free)))
    for (i, j), (pp, pm, mp, mm) in zip(pairs, quads, strict=True):
        curvature[i, j] = curvature[j, i] = (pp - pm - mp + mm) / (4 * steps[i] * steps[j])
    return curvature


def _inverse(information: Floats) -> Floats:
    if not np.all(np.isfinite(information)):
        raise EstimationError("predicted sigmas: the likelihood is undefined beside the hand-measured pose")
    scale = np.sqrt(np.abs(np.diag(information)))
    unit = np.where(scale > 0, scale, 1.0)
    if np.linalg.eigvalsh(information / np.outer(unit, unit))[0] <= 0:
        raise EstimationError("predicted sigmas: the observations leave a direction of the pose open")
    return np.asarray(np.linalg.inv(information))
