"""A small survey whose rays meet by construction, and a likelihood whose optimum and covariance are known."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from scipy.spatial.transform import Rotation

from linepose.config.platform import Platform, load_platform
from linepose.config.study import DatasetSection, load_dataset
from linepose.geometry.camera import Camera
from linepose.likelihood.base import Likelihood, Residuals
from linepose.survey.observations import Survey

ROOT = Path(__file__).parents[2]
CONFIG = ROOT / "config"
FIELD_DATA = ROOT.parent / "shared" / "ladybird"
TRUE_POSE = np.array([0.2, -0.1, -0.8, -0.8, 0.75, -1.4])


class GaussianLikelihood(Likelihood):
    """Each observation measures the pose itself: -2 log L = sum over n of |W (pose - measured_n)|^2, W^T W = C^-1.

    The optimum is the mean of `measured` (N, 6), the covariance there C / N. An observation's error, the same at each
    of its points, is |W (pose - measured_n)| px.
    """

    def __init__(self, survey: Survey, camera: Camera, measured: np.ndarray, covariance: np.ndarray) -> None:
        self.survey, self.camera = survey, camera
        self.measured, self.covariance = measured, covariance
        self.whitening = np.linalg.inv(np.linalg.cholesky(covariance))

    def log_likelihoods(self, parameters):
        whitened = (np.asarray(parameters)[:, None, :] - self.measured) @ self.whitening.T
        return -0.5 * np.sum(whitened**2, axis=(1, 2))

    def log_likelihood(self, parameters):
        return float(self.log_likelihoods(np.asarray(parameters)[None])[0])

    def residuals(self, parameters):
        error = np.linalg.norm((np.asarray(parameters) - self.measured) @ self.whitening.T, axis=1)
        n_points = self.survey.n_points
        error_px = np.where(np.isfinite(self.survey.u_px), error[:, None], np.nan)
        return Residuals(
            error_px=error_px,
            sigma_px=np.full_like(error_px, 2.0),
            error_uv_px=np.stack([error_px, np.zeros_like(error_px)], axis=-1),
            point_m=np.zeros((n_points, 3)),
            point_covariance=np.zeros((n_points, 3, 3)),
        )

    def select(self, numbers: Sequence[int]):
        rows = [list(self.survey.number).index(number) for number in numbers]
        return GaussianLikelihood(self.survey.select(numbers), self.camera, self.measured[rows], self.covariance)


class FunctionLikelihood(Likelihood):
    """-log L is any function of parameters (K, 6) to (K,)."""

    def __init__(self, survey: Survey, camera: Camera, negative: Callable[[np.ndarray], np.ndarray]) -> None:
        self.survey, self.camera, self.negative = survey, camera, negative

    def log_likelihoods(self, parameters):
        return -self.negative(np.asarray(parameters, dtype=float))

    def log_likelihood(self, parameters):
        return float(self.log_likelihoods(np.asarray(parameters)[None])[0])

    def residuals(self, parameters):
        nothing = np.full(self.survey.u_px.shape, np.nan)
        points = np.zeros((self.survey.n_points, 3))
        return Residuals(nothing, nothing, np.stack([nothing, nothing], axis=-1), points, np.zeros((len(points), 3, 3)))

    def select(self, numbers: Sequence[int]):
        return FunctionLikelihood(self.survey.select(numbers), self.camera, self.negative)


@pytest.fixture
def camera() -> Camera:
    return Camera(focal_length_m=8e-3, pixel_pitch_m=8e-6, n_pixels=640, principal_point_px=320.5, k1=-0.05, k2=0.01)


@pytest.fixture
def true_pose() -> np.ndarray:
    """Camera's pose behind the small survey."""
    return TRUE_POSE.copy()


@pytest.fixture
def true_points() -> np.ndarray:
    """World coordinates (4, 3) of the small survey's points, from its origin."""
    return np.array([[0.0, 0.0, 0.0], [0.4, 0.1, 0.0], [0.8, -0.1, 0.1], [0.3, 0.6, 0.05]])


@pytest.fixture
def survey(camera: Camera, true_points: np.ndarray) -> Survey:
    """Eight observations of four points: the body stands where the chosen pixel's ray meets the point."""
    rng = np.random.default_rng(20)
    shape = (8, len(true_points))
    x = rng.uniform(-0.25, 0.25, shape)
    u_px = (x + camera.k1 * x**3 + camera.k2 * x**5) * 1000.0 + 320.5
    euler = rng.normal(0.0, 0.1, (*shape, 3))
    body = Rotation.from_euler("ZYX", euler[..., ::-1].reshape(-1, 3))
    ray = np.stack([x, np.zeros(shape), np.ones(shape)], axis=-1).reshape(-1, 3)
    distance = rng.uniform(1.0, 2.0, (len(ray), 1))
    to_point = body.apply(TRUE_POSE[:3] + distance * Rotation.from_rotvec(TRUE_POSE[3:]).apply(ray))
    root = rng.normal(0.0, 0.01, (*shape, 6, 6))
    return Survey(
        number=np.arange(1, 9),
        time_us=1_466_040_000_000_000 + np.arange(32).reshape(shape) * 100_000,
        u_px=u_px,
        position_m=true_points - to_point.reshape(*shape, 3),
        euler_rad=euler,
        covariance=root @ np.swapaxes(root, -1, -2),
        nav_gap_s=np.full(shape, 0.25),
        origin_m=np.array([6_248_551.0, 332_962.0, -42.0]),
    )


@pytest.fixture
def pose_covariance() -> np.ndarray:
    """Correlated covariance (6, 6), its sigmas those of a calibrated camera, condition number about 1e3."""
    sigma = np.array([0.03, 0.05, 0.06, 0.016, 0.018, 0.009])
    factor = np.eye(6) + np.tril(np.random.default_rng(5).uniform(-0.6, 0.6, (6, 6)), -1)
    correlation = factor @ factor.T
    unit = np.sqrt(np.diag(correlation))
    return correlation / np.outer(unit, unit) * np.outer(sigma, sigma)


@pytest.fixture
def gaussian(survey: Survey, camera: Camera, pose_covariance: np.ndarray) -> GaussianLikelihood:
    """Eight measurements scattered around the true pose, each with eight times `pose_covariance`."""
    spread = np.random.default_rng(6).multivariate_normal(np.zeros(6), pose_covariance, size=8)
    return GaussianLikelihood(survey, camera, TRUE_POSE + spread, 8 * pose_covariance)


@pytest.fixture
def function_likelihood(survey: Survey, camera: Camera) -> Callable[..., FunctionLikelihood]:
    """Makes a likelihood of any -log L."""
    return lambda negative: FunctionLikelihood(survey, camera, negative)


@pytest.fixture
def field_data() -> Path:
    """Folder of the Ladybird field data; the test is skipped where there is none."""
    if not (FIELD_DATA / "nav_covs.csv").is_file():
        pytest.skip("no Ladybird field data in ../shared/ladybird")
    return FIELD_DATA


@pytest.fixture(scope="session")
def published() -> dict[str, Any]:
    """config/paper/published.yaml."""
    return yaml.safe_load((CONFIG / "paper" / "published.yaml").read_text())


@pytest.fixture(scope="session")
def ladybird() -> Platform:
    """config/platforms/ladybird.yaml."""
    return load_platform(CONFIG / "platforms", "ladybird")


@pytest.fixture(scope="session")
def ladybird_dataset() -> DatasetSection:
    """config/datasets/ladybird.yaml."""
    return load_dataset(CONFIG / "datasets" / "ladybird.yaml")


@pytest.fixture(scope="session")
def platforms_folder() -> Path:
    """config/platforms."""
    return CONFIG / "platforms"
