"""The shared-error noise model with heavy tails: all observations in, a weight for each view and each point out.

An alternative to removing observations. A bad view is one whose shared navigation error comes from far out in the
tail, a bad point one whose own error (white navigation and pixel) does. Both are multivariate Student-t, written as
Gaussians of random scale:

    z_i ~ N(0, I / w_i),  w_i ~ Gamma(nu/2, nu/2);    n_ki ~ N(0, D_ki / w_ki),  w_ki ~ Gamma(mu/2, mu/2)

with z_i the six standardised shared errors of view i, and n_ki the own error of point k in it (u and v). With the
weights given, points and shared errors are integrated out in closed form, as in the shared-error model. The weights
are not fitted but averaged over: by variational Bayes, q(points, errors) q(weights), whose sweeps are closed-form too,

    E[w_i] = (nu + 6) / (nu + E|z_i|^2),    E[w_ki] = (mu + 2) / (mu + E[n_ki^T D_ki^-1 n_ki])

and the log-likelihood is its lower bound of the log marginal likelihood at convergence. The expectations hold the
posterior covariance of the errors, not only their best value: a view of which the residuals say nothing keeps weight
one, which reweighting by the best value (IRLS, or the joint mode) does not grant. For many degrees of freedom the bound
is the shared-error likelihood itself. It is a smooth function of the parameters, but for the sweeps' tolerance.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.geometry.camera import Camera
from linepose.likelihood.robust_marginal import Freedom, robust_marginal, row_log_likelihood, rows_log_likelihood
from linepose.likelihood.shared import SharedLikelihood, SharedPriors
from linepose.likelihood.shared_kernel import levels_at, optics_at
from linepose.likelihood.shared_marginal import Marginal
from linepose.survey.observations import Survey


@dataclass(frozen=True)
class RobustPriors(SharedPriors):
    """Priors of the levels, and the tails: degrees of freedom of a view's shared error and of a point's own."""

    view_degrees_of_freedom: float = 4.0
    point_degrees_of_freedom: float = 4.0


@dataclass(frozen=True)
class Weights:
    """Expected weights, 1 for what is as noisy as the levels say and towards 0 for what is bad.

    view (N,); point (N, M), NaN where there is no point or it is left out.
    """

    view: Floats
    point: Floats


class RobustSharedLikelihood(SharedLikelihood):
    """Log-density of pose, levels and intrinsics under the shared-error model with heavy tails, priors counted in.

    Parameters (11,) are those of the shared-error model; the levels are the scales of the Student-t distributions.
    Raises InputError as that model does, and for degrees of freedom that are not positive.
    """

    priors: RobustPriors

    def __init__(self, survey: Survey, camera: Camera, priors: RobustPriors | None = None) -> None:
        priors = priors or RobustPriors()
        super().__init__(survey, camera, priors)
        self._freedom = Freedom(priors.view_degrees_of_freedom, priors.point_degrees_of_freedom)
        for name, value in zip(("view", "point"), self._freedom, strict=True):
            if not (np.isfinite(value) and value > 0):
                raise InputError(
                    f"prior {name}_degrees_of_freedom",
                    f"{value}",
                    "a positive number",
                    "give 4 for heavy tails, 1000 for none",
                )

    def log_likelihoods(self, parameters: ArrayLike) -> Floats:
        """Log-density of each row; (K, 11) to (K,), the same on any number of cores."""
        rows = np.ascontiguousarray(parameters, dtype=float).reshape(-1, self.n_parameters)
        return rows_log_likelihood(
            self._arrays,
            self._fixed,
            self._freedom,
            len(self._points),
            self._prior_centre,
            self._prior_sigma,
            rows,
        )

    def log_likelihood(self, parameters: ArrayLike) -> float:
        """Log-density of one parameter vector (11,), on one core."""
        return float(
            row_log_likelihood(
                self._arrays,
                self._fixed,
                self._freedom,
                len(self._points),
                self._prior_centre,
                self._prior_sigma,
                self._vector(parameters),
            )
        )

    def weights(self, parameters: ArrayLike) -> Weights:
        """Weight of each view and point at one parameter vector (11,); raises EstimationError where undefined."""
        fit = self._fit(self._vector(parameters))
        point = np.full(self.survey.u_px.shape, np.nan)
        point[self._arrays.line_view, self._points[self._arrays.line_point]] = fit.line_weight
        return Weights(fit.view_weight, point)

    def surrogate(self) -> SharedLikelihood:
        """The same model without tails: its optimum is near, at a tenth of the cost."""
        return SharedLikelihood(self.survey, self.camera, self.priors)

    def select(self, numbers: Sequence[int]) -> "RobustSharedLikelihood":
        """The same model of these observations only."""
        return RobustSharedLikelihood(self.survey.select(numbers), self.camera, self.priors)

    def _weighted_marginal(self, vector: Floats) -> tuple[Marginal, Floats, Floats]:
        optics, levels = optics_at(vector, self._fixed), levels_at(vector)
        found = robust_marginal(self._arrays, optics, levels, self._freedom, len(self._points))
        return found.marginal, found.view_weight, found.line_weight
