"""Compiling a noise model's kernel on a small made-up survey; the compiled code is kept on disk."""

import numpy as np

from linepose.adjustment.settings import AdjustmentSection
from linepose.estimation.estimator import Conditions
from linepose.estimation.noise_models import estimator_of, likelihood_of
from linepose.estimation.noise_models import noise_model as entry_of
from linepose.geometry.camera import Camera
from linepose.survey.hand_measured import HandMeasured
from linepose.survey.observations import Survey

_CAMERA = Camera(focal_length_m=8e-3, pixel_pitch_m=8e-6, n_pixels=600, principal_point_px=300.0)
_N_OBSERVATIONS = 4
_N_POINTS = 3


def warm_up(noise_model: str) -> None:
    """Evaluate a noise model, by name, once in every way that there is."""
    if not entry_of(noise_model).removes_outliers:
        hand = HandMeasured(position_m=(0.0, 0.0, 0.0), euler_deg=(0.0, 0.0, 0.0))
        few = AdjustmentSection(n_draws=10, n_samples=10)
        estimator_of(noise_model, _survey(), Conditions(_CAMERA, hand, adjustment=few)).estimate(np.zeros(6))
        return
    likelihood = likelihood_of(noise_model, _survey(), _CAMERA)
    parameters = likelihood.start(np.zeros(6))
    likelihood.log_likelihood(parameters)
    likelihood.log_likelihoods(np.tile(parameters, (2, 1)))
    likelihood.residuals(parameters)


def _survey() -> Survey:
    """Views from different places, a few metres above points on the ground, the camera looking down; rays meet."""
    shape = (_N_OBSERVATIONS, _N_POINTS)
    point, view = np.meshgrid(np.arange(_N_POINTS), np.arange(_N_OBSERVATIONS))
    north_m, height_m = 0.5 * view, 3.0
    position = np.stack([north_m, 0.2 * point, np.full(shape, -height_m)], axis=-1)
    return Survey(
        number=np.arange(1, _N_OBSERVATIONS + 1),
        time_us=np.zeros(shape, dtype=np.int64),
        u_px=np.asarray(_CAMERA.principal_point_px - _CAMERA.focal_length_px * north_m / height_m, dtype=float),
        position_m=position,
        euler_rad=np.zeros((*shape, 3)),
        covariance=np.broadcast_to(1e-4 * np.eye(6), (*shape, 6, 6)).copy(),
        nav_gap_s=np.zeros(shape),
        origin_m=np.zeros(3),
    )
