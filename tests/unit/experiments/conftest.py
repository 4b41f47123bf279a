"""A noise model whose answers are known in closed form, and a small survey."""

from collections.abc import Sequence

import numpy as np
import pytest

from linepose.geometry.camera import Camera
from linepose.geometry.camera_sigmas import CameraSigmas
from linepose.geometry.pose import POSE_COLUMNS
from linepose.likelihood.base import Likelihood, Residuals
from linepose.survey.observations import Survey

TRUE_POSE = np.array([0.19, -0.14, -0.79, -0.82, 0.74, -1.43])
SIGMA = np.array([0.1, 0.15, 0.2, 0.03, 0.04, 0.02])


class GaussianLikelihood(Likelihood):
    """Each observation measures the parameters directly, with covariance `covariance` (P, P) and its own mean."""

    def __init__(self, survey: Survey, means: np.ndarray, covariance: np.ndarray):
        self.survey = survey
        self.camera = Camera(focal_length_m=8.2e-3, pixel_pitch_m=7.4e-6, n_pixels=648, principal_point_px=323.0)
        self.means = means
        self.information = np.linalg.inv(covariance)

    @property
    def parameter_names(self):
        extra = self.means.shape[1] - len(POSE_COLUMNS)
        return (*POSE_COLUMNS, *(f"level_{k}" for k in range(extra)))

    def start(self, pose):
        return np.concatenate([np.asarray(pose, dtype=float), np.zeros(self.means.shape[1] - 6)])

    def half_widths(self, translation_m, rotation_rad):
        return np.concatenate([super().half_widths(translation_m, rotation_rad), np.ones(self.means.shape[1] - 6)])

    def initial_walker_sigma(self, translation_m, rotation_rad):
        return self.half_widths(translation_m, rotation_rad)

    def log_likelihoods(self, parameters):
        difference = np.asarray(parameters)[:, None, :] - self.means
        return -0.5 * np.einsum("kni,ij,knj->k", difference, self.information, difference)

    def log_likelihood(self, parameters):
        return float(self.log_likelihoods(np.asarray(parameters)[None])[0])

    def residuals(self, parameters):
        n, m = self.survey.u_px.shape
        empty = np.full((n, m), np.nan)
        return Residuals(empty, empty, np.full((n, m, 2), np.nan), np.full((m, 3), np.nan), np.full((m, 3, 3), np.nan))

    def select(self, numbers: Sequence[int]):
        rows = [self.survey.number.tolist().index(n) for n in numbers]
        return GaussianLikelihood(self.survey.select(numbers), self.means[rows], np.linalg.inv(self.information))


def make_survey(n_observations: int, seed: int = 3) -> Survey:
    """A vehicle driving over a flat pattern of 3 x 4 points in different headings, seen from about 2 m above."""
    random = np.random.default_rng(seed)
    m = 12
    shape = (n_observations, m)
    spread = random.standard_normal((*shape, 6, 8)) * np.array([0.01, 0.01, 0.01, 0.004, 0.004, 0.002])[:, None]
    heading = np.linspace(-np.pi, np.pi, n_observations, endpoint=False)[:, None] + np.zeros(shape)
    roll = np.radians(np.linspace(-6, 6, n_observations))[:, None] + np.zeros(shape)
    return Survey(
        number=np.arange(1, n_observations + 1),
        time_us=np.zeros(shape, dtype=np.int64),
        u_px=random.uniform(50, 600, shape),
        position_m=np.concatenate([random.uniform(-2, 2, (*shape, 2)), np.full((*shape, 1), -2.0)], axis=-1),
        euler_rad=np.stack([roll, np.full(shape, 0.01), heading], axis=-1),
        covariance=spread @ np.swapaxes(spread, -1, -2) / 8,
        nav_gap_s=np.zeros(shape),
        origin_m=np.array([6248000.0, 332960.0, -42.0]),
    )


@pytest.fixture
def camera():
    return Camera(
        focal_length_m=8.2e-3,
        pixel_pitch_m=4.8e-3 / 648,
        n_pixels=648,
        principal_point_px=323.0,
        k1=0.02,
        k2=-0.01,
        sigmas=CameraSigmas(k1=0.002, k2=0.001),
    )


@pytest.fixture
def survey():
    return make_survey(12)


@pytest.fixture
def gaussian(survey):
    """Twelve direct measurements of TRUE_POSE with SIGMA."""
    noise = np.random.default_rng(7).standard_normal((12, 6)) * SIGMA
    return GaussianLikelihood(survey, TRUE_POSE + noise, np.diag(SIGMA**2))


@pytest.fixture
def gaussian_11(survey):
    """The same with five parameters beyond the pose."""
    random = np.random.default_rng(8)
    means = np.concatenate([TRUE_POSE, np.zeros(5)]) + random.standard_normal((12, 11)) * 0.05
    return GaussianLikelihood(survey, means, np.eye(11) * 0.05**2)
