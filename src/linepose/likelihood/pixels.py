"""Any noise model with its residuals taken in pixels instead of in the normalised image plane.

The two differ by the focal length f alone: `e_px = f e`, so that an error of f moves `e_px` by `e` more than it moves
`f e`. Slow, since it goes through the residuals: for comparisons only.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.errors import EstimationError
from linepose.geometry.camera import normalised_from_pixel
from linepose.likelihood.base import Likelihood, Residuals


class PixelLikelihood(Likelihood):
    """The model `inner` with `e_px^2 / var(e_px)` in place of `e^2 / var(e)`."""

    def __init__(self, inner: Likelihood) -> None:
        self.survey = inner.survey
        self.camera = inner.camera
        self._inner = inner
        self._x = normalised_from_pixel(inner.camera, inner.survey.u_px)

    @property
    def parameter_names(self) -> tuple[str, ...]:
        """Those of the inner model."""
        return self._inner.parameter_names

    def start(self, pose: ArrayLike) -> Floats:
        """That of the inner model."""
        return self._inner.start(pose)

    def half_widths(self, translation_m: float, rotation_rad: float) -> Floats:
        """Those of the inner model."""
        return self._inner.half_widths(translation_m, rotation_rad)

    def initial_walker_sigma(self, translation_m: float, rotation_rad: float) -> Floats:
        """That of the inner model."""
        return self._inner.initial_walker_sigma(translation_m, rotation_rad)

    def log_likelihood(self, parameters: ArrayLike) -> float:
        """That of the inner model with the residuals' share exchanged."""
        value = self._inner.log_likelihood(parameters)
        if not np.isfinite(value):
            return value
        try:
            inner, own = self._inner.residuals(parameters), self.residuals(parameters)
        except EstimationError:
            return -np.inf
        share = np.nansum((inner.error_px / inner.sigma_px) ** 2 - (own.error_px / own.sigma_px) ** 2)
        return value + 0.5 * float(share)

    def log_likelihoods(self, parameters: ArrayLike) -> Floats:
        """Each row's, one after the other; (K, P) to (K,)."""
        return np.array([self.log_likelihood(row) for row in np.atleast_2d(np.asarray(parameters, dtype=float))])

    def residuals(self, parameters: ArrayLike) -> Residuals:
        """Those of the inner model with the sigmas of errors in pixels.

        `d e_px / df = e + f de/df`, and `e de/df = (x_reprojected - x) x / f`: the observed pixel's ray turns with f.
        """
        inner = self._inner.residuals(parameters)
        pixel, focal_px = inner.error_uv_px, self.camera.focal_length_px
        sigma_focal_px = self.camera.sigmas.focal_length_m / self.camera.pixel_pitch_m
        error = inner.error_px / focal_px
        turning = -pixel[..., 0] / focal_px * self._x  # e f de/df
        variance = inner.sigma_px**2 + sigma_focal_px**2 * (error**2 + 2 * turning)
        return Residuals(inner.error_px, np.sqrt(variance), pixel, inner.point_m, inner.point_covariance)

    def without_cheirality(self) -> "PixelLikelihood":
        """The inner model without cheirality in pixels."""
        return PixelLikelihood(self._inner.without_cheirality())

    def select(self, numbers: Sequence[int]) -> "PixelLikelihood":
        """The same model of these observations only."""
        return PixelLikelihood(self._inner.select(numbers))
