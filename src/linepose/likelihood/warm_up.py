"""Compiling every noise model's kernel on a small made-up survey; the compiled code is kept on disk."""

import numpy as np

from linepose.camera import Camera
from linepose.likelihood.models import NOISE_MODELS, likelihood_of
from linepose.observations import Survey

_N_OBSERVATIONS = 4
_N_POINTS = 3


def warm_up() -> list[str]:
    """Evaluate each noise model once in every way that there is; their names."""
    camera = Camera(focal_length_m=8e-3, pixel_pitch_m=8e-6, n_pixels=600, principal_point_px=300.0)
    survey = _survey()
    for name in NOISE_MODELS:
        likelihood = likelihood_of(name, survey, camera)
        parameters = likelihood.start(np.zeros(6))
        likelihood.log_likelihood(parameters)
        likelihood.log_likelihoods(np.tile(parameters, (2, 1)))
        likelihood.residuals(parameters)
    return sorted(NOISE_MODELS)


def _survey() -> Survey:
    """Views from different places, a few metres above points on the ground, the camera looking down."""
    shape = (_N_OBSERVATIONS, _N_POINTS)
    along, across = np.meshgrid(np.arange(_N_POINTS), np.arange(_N_OBSERVATIONS))
    position = np.stack([0.2 * along + 0.0 * across, 0.5 * across, np.full(shape, -3.0)], axis=-1)
    return Survey(
        number=np.arange(1, _N_OBSERVATIONS + 1),
        time_us=np.zeros(shape, dtype=np.int64),
        u_px=np.asarray(300.0 + 60.0 * across, dtype=float),
        position_m=position,
        euler_rad=np.zeros((*shape, 3)),
        covariance=np.broadcast_to(1e-4 * np.eye(6), (*shape, 6, 6)).copy(),
        nav_gap_s=np.zeros(shape),
        origin_m=np.zeros(3),
    )
