"""The paper's noise model, Eq. 11-22: navigation and camera errors as given, the pose's own covariance zero."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.errors import EstimationError, InputError
from linepose.geometry.camera import Camera
from linepose.geometry.pose import N_PARAMETERS
from linepose.likelihood import kernel
from linepose.likelihood import layout as at
from linepose.likelihood.base import Likelihood, Residuals
from linepose.likelihood.layout import LANES
from linepose.likelihood.prepare import check_straight, point_origins, survey_rows, usable
from linepose.survey.observations import Survey

_COVARIANCE = (at.E_NN, at.E_NE, at.E_ND, at.E_NE, at.E_EE, at.E_ED, at.E_ND, at.E_ED, at.E_DD)


class PublishedLikelihood(Likelihood):
    """Eq. 11-22 of a survey (N observations, M points) seen by a camera, compiled.

    A point with fewer than two views does not enter, and is logged. Two rays within 1e-8 rad of parallel say nothing
    of their point. The log-likelihood is minus infinity where a point lies behind a camera that observed it, or where
    all of its rays are parallel. `max_behind_camera` of such points are let pass: none, but see `without_cheirality`.
    """

    def __init__(self, survey: Survey, camera: Camera, max_behind_camera: float = 0.0) -> None:
        check_straight(camera)
        self.survey = survey
        self.camera = camera
        self._max_behind_camera = max_behind_camera
        self._mask = usable(survey)
        if not np.any(self._mask):
            raise InputError("survey", "no point with two views", "at least one", "add observations of the same points")
        self._origins = point_origins(survey, self._mask)
        self._rows = survey_rows(survey, camera, self._mask, self._origins)
        self._pose = np.zeros(N_PARAMETERS)
        single = kernel.workspace(survey.n_observations, 1)
        self._arguments = (
            self._rows,
            self._pose,
            single.rays,
            single.sums,
            single.points,
            single.residuals,
            max_behind_camera,
        )
        self._single = single
        self._many: kernel.Workspace | None = None

    def log_likelihood(self, parameters: ArrayLike) -> float:
        """Log-likelihood of one pose (6,), on one core; minus infinity where it is undefined."""
        self._pose[:] = parameters
        return kernel.evaluate(*self._arguments)

    def log_likelihoods(self, parameters: ArrayLike) -> Floats:
        """Log-likelihood of each pose, (K, 6) to (K,), bit for bit that of `log_likelihood`, on numba's threads."""
        poses = np.array(parameters, dtype=float, order="C", ndmin=2)
        if self._many is None:
            self._many = kernel.workspace(self.survey.n_observations, kernel.MAXIMUM_THREADS)
        many = self._many
        out = np.empty(len(poses))
        kernel.evaluate_rows(
            self._rows, poses, many.rays, many.sums, many.points, many.residuals, self._max_behind_camera, out
        )
        return out

    def residuals(self, parameters: ArrayLike) -> Residuals:
        """Residuals and estimated points at one pose (6,); NaN at a point with fewer than two views.

        Raises EstimationError where a point has no estimate.
        """
        self._pose[:] = parameters
        single = self._single
        scale = self.camera.focal_length_px
        shape = (self.survey.n_observations, len(self._rows) * LANES)
        error, sigma = np.empty((*shape, 2)), np.empty(shape)
        point, covariance = np.empty((shape[1], 3)), np.empty((shape[1], 3, 3))
        for block in range(len(self._rows)):
            lanes = slice(block * LANES, (block + 1) * LANES)
            kernel.evaluate(self._rows[block : block + 1], *self._arguments[1:])
            residual = single.residuals[0].reshape(shape[0], -1, LANES)
            error[:, lanes, 0], error[:, lanes, 1] = -residual[:, 0], -residual[:, 1]
            sigma[:, lanes] = np.sqrt(residual[:, 2])
            estimate = single.points[0].reshape(-1, LANES).T
            point[lanes] = estimate[:, :3]
            covariance[lanes] = estimate[:, np.array(_COVARIANCE) // LANES].reshape(LANES, 3, 3)
        m = self.survey.n_points
        absent, empty = self._mask == 0, ~np.any(self._mask, axis=0)
        error, sigma, point, covariance = error[:, :m], sigma[:, :m], point[:m] + self._origins, covariance[:m]
        error[absent], sigma[absent], point[empty], covariance[empty] = np.nan, np.nan, np.nan, np.nan
        if not np.all(np.isfinite(point[~empty])):
            raise EstimationError("a point has no estimate at this pose: its rays are parallel; give another pose")
        return Residuals(
            error_px=np.linalg.norm(error, axis=-1) * scale,
            sigma_px=sigma * scale,
            error_uv_px=error * scale,
            point_m=point,
            point_covariance=covariance,
        )

    def select(self, numbers: Sequence[int]) -> "PublishedLikelihood":
        """The same model of these observations only."""
        return PublishedLikelihood(self.survey.select(numbers), self.camera, self._max_behind_camera)

    def without_cheirality(self) -> "PublishedLikelihood":
        """The same model with points behind the camera reprojected as if in front, as Eq. 18 has it."""
        return PublishedLikelihood(self.survey, self.camera, np.inf)
