"""The shared-error noise model: navigation error common to a view, its levels inferred with the pose.

The points of one observation are recorded within seconds, so most of the navigation error is the same for all of
them. The residuals of view i, stacked over its points, are Gaussian with covariance

    a^2 J_i Q_i J_i^T  +  per point k:  b^2 J_ki Q_ki J_ki^T + g^2 diag(sigma_u^2, sigma_v^2)

where Q_ki is the reported covariance of the body pose, Q_i its mean over the view, J the projection's Jacobian by the
body pose. The levels a (shared), b (white) and g (pixel) are estimated, with log-normal priors; so are the principal
point and the focal length, within the sigmas of the camera. The pattern points have a flat prior and are integrated
out in closed form, linearised at their estimate:

    -log p = 1/2 min chi^2 + 1/2 sum log|C_i| + 1/2 log|H_PP| + priors

Residuals are in pixels, observed (u, 0) minus the point projected with the distortion applied: the pixel is where the
camera's noise has a constant sigma, and the observed u does not move with the estimated intrinsics. All that depends on
a parameter counts, the determinants included; constants do not (powers of 2 pi, normalisation of the priors), so values
compare between parameters of one survey, not between surveys.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.errors import EstimationError, InputError
from linepose.geometry.camera import Camera
from linepose.geometry.pose import POSE_COLUMNS
from linepose.likelihood.base import Likelihood, Residuals
from linepose.likelihood.shared_arrays import shared_arrays
from linepose.likelihood.shared_kernel import FixedOptics, Lines, empty_lines, levels_at, linearise, optics_at
from linepose.likelihood.shared_marginal import Marginal, marginal, normal_equations
from linepose.likelihood.shared_rows import row_log_likelihood, rows_log_likelihood
from linepose.survey.observations import Survey

LEVEL_NAMES: Final = ("log_shared_level", "log_white_level", "log_pixel_level")
SHARED_PARAMETERS: Final = (*POSE_COLUMNS, *LEVEL_NAMES, "principal_point_px", "focal_length_m")
SEARCH_SIGMAS: Final = 3.0  # of the prior, on either side: where the priors' parameters are searched
SCATTER_SIGMAS: Final = 0.03  # of the prior: where walkers of the priors' parameters start


@dataclass(frozen=True)
class SharedPriors:
    """Log-normal prior of each level: its median, and its sigma in the natural logarithm."""

    level_median: float = 0.5
    level_log_sigma: float = 1.5


class _Fit(NamedTuple):
    """The marginal, the lines linearised at its points, and the weights of views (N,) and lines (L,)."""

    marginal: Marginal
    lines: Lines
    view_weight: Floats
    line_weight: Floats


class SharedLikelihood(Likelihood):
    """Log-density of pose, levels and intrinsics under the shared-error model, priors counted in.

    Parameters (11,): the pose; logarithms of the levels a, b, g; principal point (px), focal length (m). Points that
    fewer than two observations have are left out. A singular or zero reported covariance is allowed. Raises InputError
    for a covariance with negative eigenvalues, a camera sigma that is not positive, or no point with two rays.
    """

    def __init__(self, survey: Survey, camera: Camera, priors: SharedPriors | None = None) -> None:
        self.survey = survey
        self.camera = camera
        self.priors = priors or SharedPriors()
        _check_scales(camera, self.priors)
        self._arrays, self._points = shared_arrays(survey)
        self._fixed = FixedOptics(camera.pixel_pitch_m, camera.k1, camera.k2, camera.sigmas.u_px, camera.sigmas.v_px)
        log_median, log_sigma = np.log(self.priors.level_median), self.priors.level_log_sigma
        self._prior_centre = np.array([*[log_median] * 3, camera.principal_point_px, camera.focal_length_m])
        self._prior_sigma = np.array([*[log_sigma] * 3, camera.sigmas.principal_point_px, camera.sigmas.focal_length_m])

    @property
    def parameter_names(self) -> tuple[str, ...]:
        """Names of the eleven parameters with their units."""
        return SHARED_PARAMETERS

    @property
    def prior_sigma(self) -> Floats:
        """Sigma of each parameter's prior (11,), infinite for the pose, which has none."""
        return np.concatenate([np.full(6, np.inf), self._prior_sigma])

    def parameter_priors(self) -> dict[str, tuple[float, float]]:
        """Centre and sigma of the priors of levels and intrinsics."""
        centres, sigmas = self._prior_centre.tolist(), self._prior_sigma.tolist()
        return dict(zip(SHARED_PARAMETERS[6:], zip(centres, sigmas, strict=True), strict=True))

    def start(self, pose: ArrayLike) -> Floats:
        """The pose (6,), with the prior's centre of everything else."""
        return np.concatenate([super().start(pose), self._prior_centre])

    def half_widths(self, translation_m: float, rotation_rad: float) -> Floats:
        """Half of the range (11,) in which each parameter is searched: three sigmas of the prior beyond the pose."""
        return np.concatenate([super().half_widths(translation_m, rotation_rad), SEARCH_SIGMAS * self._prior_sigma])

    def initial_walker_sigma(self, translation_m: float, rotation_rad: float) -> Floats:
        """Sigma (11,) with which walkers are scattered: narrower than any posterior beyond the pose.

        The pixel level's posterior is a fortieth of its prior; walkers that start far outside come in late.
        """
        return np.concatenate(
            [super().initial_walker_sigma(translation_m, rotation_rad), SCATTER_SIGMAS * self._prior_sigma]
        )

    def log_likelihoods(self, parameters: ArrayLike) -> Floats:
        """Log-density of each row; (K, 11) to (K,), the same on any number of cores."""
        rows = np.ascontiguousarray(parameters, dtype=float).reshape(-1, self.n_parameters)
        return rows_log_likelihood(
            self._arrays, self._fixed, len(self._points), self._prior_centre, self._prior_sigma, rows
        )

    def log_likelihood(self, parameters: ArrayLike) -> float:
        """Log-density of one parameter vector (11,), on one core."""
        return float(
            row_log_likelihood(
                self._arrays,
                self._fixed,
                len(self._points),
                self._prior_centre,
                self._prior_sigma,
                self._vector(parameters),
            )
        )

    def residuals(self, parameters: ArrayLike) -> Residuals:
        """Residuals at the estimated points and the reported body poses, so the navigation error is part of them.

        `sigma_px` is that of the residual's length, from the whole covariance of its line; `point_covariance` that of
        the points given the parameters, NaN with `point_m` for points that are left out. Raises EstimationError at
        parameters for which the model is undefined.
        """
        fit = self._fit(self._vector(parameters))
        shape, lines = self.survey.u_px.shape, fit.lines
        row, point = self._arrays.line_view, self._points[self._arrays.line_point]
        error_uv, error, sigma = np.full((*shape, 2), np.nan), np.full(shape, np.nan), np.full(shape, np.nan)
        length = np.linalg.norm(lines.residual_px, axis=1)
        direction = lines.residual_px / np.where(length > 0, length, 1.0)[:, None]
        covariance = self._line_covariance(fit)
        error_uv[row, point], error[row, point] = lines.residual_px, length
        sigma[row, point] = np.sqrt(np.einsum("li,lij,lj->l", direction, covariance, direction))
        points = np.full((shape[1], 3), np.nan)
        points[self._points] = fit.marginal.points_m
        point_covariance = np.full((shape[1], 3, 3), np.nan)
        point_covariance[self._points] = self._point_covariance(fit)
        return Residuals(error, sigma, error_uv, points, point_covariance)

    def chi_square(self, parameters: ArrayLike) -> tuple[float, int]:
        """Chi squared under the whole covariances of the views, and its degrees of freedom: two a line, less the
        coordinates of the points and the pose.
        """
        found = self._fit(self._vector(parameters)).marginal
        freedom = 2 * len(self._arrays.u_px) - 3 * len(self._points) - len(POSE_COLUMNS)
        return float(found.chi_squared), max(freedom, 1)

    def select(self, numbers: Sequence[int]) -> "SharedLikelihood":
        """The same model of these observations only."""
        return SharedLikelihood(self.survey.select(numbers), self.camera, self.priors)

    def _vector(self, parameters: ArrayLike) -> Floats:
        vector = np.ascontiguousarray(parameters, dtype=float)
        if vector.shape != (self.n_parameters,):
            raise InputError(
                "parameters", f"shape {vector.shape}", f"shape ({self.n_parameters},)", "see `parameter_names`"
            )
        return vector

    def _weighted_marginal(self, vector: Floats) -> tuple[Marginal, Floats, Floats]:
        """The marginal with the weights of views (N,) and lines (L,) that belong to it."""
        weights = np.ones(self.survey.n_observations), np.ones(len(self._arrays.u_px))
        optics, levels = optics_at(vector, self._fixed), levels_at(vector)
        return marginal(self._arrays, optics, levels, len(self._points), *weights), *weights

    def _fit(self, vector: Floats) -> _Fit:
        found, view_weight, line_weight = self._weighted_marginal(vector)
        lines = empty_lines(len(self._arrays.u_px))
        optics, levels = optics_at(vector, self._fixed), levels_at(vector)
        if not np.isfinite(found.chi_squared) or not linearise(self._arrays, optics, levels, found.points_m, lines):
            raise EstimationError(
                f"no residuals at the parameters {vector.tolist()}: a point has no position in front of the camera; "
                "start from a pose nearer to the measured one"
            )
        return _Fit(found, lines, view_weight, line_weight)

    def _line_covariance(self, fit: _Fit) -> Floats:
        uu, uv, vv = fit.lines.precision.T
        own = np.linalg.inv(np.stack([np.stack([uu, uv], axis=-1), np.stack([uv, vv], axis=-1)], axis=-1))
        shared = fit.lines.by_shared @ np.swapaxes(fit.lines.by_shared, 1, 2)
        view_weight = fit.view_weight[self._arrays.line_view]
        return own / fit.line_weight[:, None, None] + shared / view_weight[:, None, None]

    def _point_covariance(self, fit: _Fit) -> Floats:
        count = len(self._points)
        system = normal_equations(self._arrays, fit.lines, count, fit.view_weight, fit.line_weight)
        information = np.zeros((3 * count, 3 * count))
        for k in range(count):
            block = slice(3 * k, 3 * k + 3)
            information[block, block] = np.triu(system.points[k]) + np.triu(system.points[k], 1).T
        cross = system.cross.reshape(-1, 6, 3 * count)
        views = np.triu(system.views) + np.swapaxes(np.triu(system.views, 1), 1, 2)
        information -= np.einsum("nip,niq->pq", cross, np.linalg.solve(views, cross))
        covariance = np.linalg.inv(information).reshape(count, 3, count, 3)
        return np.stack([covariance[k, :, k] for k in range(count)])


def _check_scales(camera: Camera, priors: SharedPriors) -> None:
    scales = {
        "camera sigma u_px": camera.sigmas.u_px,
        "camera sigma v_px": camera.sigmas.v_px,
        "camera sigma principal_point_px": camera.sigmas.principal_point_px,
        "camera sigma focal_length_m": camera.sigmas.focal_length_m,
        "prior level_median": priors.level_median,
        "prior level_log_sigma": priors.level_log_sigma,
    }
    for name, value in scales.items():
        if not (np.isfinite(value) and value > 0):
            raise InputError(name, f"{value}", "a positive number", "give a small sigma to what is known exactly")
