"""The balanced noise model: the shared-error model without its determinants' pull on the pose.

Navigation errors are metres and radians of the body. In pixels they shrink, as do the residuals that they leave, with
the distance at which the camera is thought to be: the same errors explain the same residuals from anywhere. The
determinants of the shared-error model reward a camera far away (or of short focal length) all the same. The reason is
the true body pose at each line, which is integrated out under a flat prior: there is more room far away. With a prior
that is even in the image instead, of density `|C_i|^1/2 |H_PP|^1/2` at the levels that the errors have,

    -log p = 1/2 min chi^2 + 1/2 (sum log|C_i| + log|H_PP|) - 1/2 (sum log|C_i| + log|H_PP|)_reference + priors

where the last determinants have the same pose, intrinsics and points, but the reference's levels. At these levels
chi squared alone decides on the pose, which is unbiased; at others the determinants still tell levels apart. The
reference's levels are those that the data have, see `balancing`.

Noise across the line must follow the pose as the residuals do. No pixel was measured there, v is zero, but a time: that
noise is the body's motion during a short time, seen in the image. It is `sigma_v` across the line at the reference
pose; elsewhere it grows, shrinks and turns with the image of the body's motion, whose rate is a straight line through
the reported poses of the view. Views whose points have no different times keep `sigma_v`. A point is at most about as
late as the camera's sigma says: what the pixel level has above one is the platform's shaking, the same from any pose.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.geometry.camera import Camera
from linepose.geometry.pose import check_pose
from linepose.likelihood.balanced_rows import row_log_likelihood, rows_log_likelihood
from linepose.likelihood.shared import SharedLikelihood, SharedPriors
from linepose.likelihood.shared_kernel import Levels, Optics, empty_lines, linearise, optics_at
from linepose.likelihood.shared_marginal import initial_points
from linepose.survey.observations import Survey


@dataclass(frozen=True)
class Reference:
    """A pose (6,) near the camera's, and the levels that the errors have there."""

    pose: Floats
    levels: Levels


FindReference = Callable[[Survey, Camera], Reference]


def body_rates(survey: Survey) -> Floats:
    """Rate of position (m/s) and Euler angles (rad/s) in each view, a straight line through its points' times; (N, 6).

    NaN where the times do not differ.
    """
    rates = np.full((survey.n_observations, 6), np.nan)
    for view in range(survey.n_observations):
        seen = np.isfinite(survey.u_px[view])
        if not np.any(seen):
            continue
        time_us = survey.time_us[view, seen]
        time_s = 1e-6 * (time_us - time_us.min()).astype(float)
        angles = np.unwrap(survey.euler_rad[view, seen], axis=0)
        pose = np.concatenate([survey.position_m[view, seen], angles], axis=1)
        centred = time_s - time_s.mean()
        spread = centred @ centred
        if spread > 0:
            rates[view] = centred @ (pose - pose[0]) / spread
    return rates


class BalancedLikelihood(SharedLikelihood):
    """Log-density of pose, levels and intrinsics under the balanced model, priors counted in.

    Parameters (11,) are those of the shared-error model. `refer` finds the reference of a survey, and of each selection
    of it anew. Raises InputError as the shared-error model does, and for a reference pose at which a point is not in
    front of the camera.
    """

    def __init__(
        self, survey: Survey, camera: Camera, refer: FindReference, priors: SharedPriors | None = None
    ) -> None:
        super().__init__(survey, camera, priors)
        self._refer = refer
        self.reference = refer(survey, camera)
        optics = optics_at(self.start(check_pose(self.reference.pose, "reference pose")), self._fixed)
        valid, points = initial_points(self._arrays, optics, len(self._points))
        if not valid or not np.all(np.isfinite(points)):
            raise InputError(
                "reference pose",
                f"{self.reference.pose.tolist()}, where a point is not in front of the camera",
                "a pose near the camera's",
                "give the hand-measured pose, or mend it",
            )
        self._arrays = self._arrays._replace(motion=self._motion(optics, points))

    def _motion(self, optics: Optics, points_m: Floats) -> Floats:
        """What `SharedArrays.motion` holds (L, 7), for noise that is `sigma_v` straight across the line here."""
        arrays, rates = self._arrays, body_rates(self.survey)[self._arrays.line_view]
        lines, identity = empty_lines(len(rates)), np.tile(np.eye(6), (self.survey.n_observations, 1, 1))
        linearise(arrays._replace(shared_root=identity), optics, Levels(1.0, 1.0, 1.0), points_m, lines)
        along, across = np.einsum("lrc,lc->rl", lines.by_shared, rates)
        known = np.isfinite(across) & (across != 0.0)
        across = np.where(known, across, np.nan)
        return np.ascontiguousarray(np.column_stack([rates / across[:, None], along / across]))

    def log_likelihoods(self, parameters: ArrayLike) -> Floats:
        """Log-density of each row; (K, 11) to (K,), the same on any number of cores."""
        rows = np.ascontiguousarray(parameters, dtype=float).reshape(-1, self.n_parameters)
        return rows_log_likelihood(
            *(self._arrays, self._fixed, self.reference.levels, len(self._points)),
            *(self._prior_centre, self._prior_sigma, rows),
        )

    def log_likelihood(self, parameters: ArrayLike) -> float:
        """Log-density of one parameter vector (11,), on one core."""
        return float(
            row_log_likelihood(
                *(self._arrays, self._fixed, self.reference.levels, len(self._points)),
                *(self._prior_centre, self._prior_sigma, self._vector(parameters)),
            )
        )

    def select(self, numbers: Sequence[int]) -> "BalancedLikelihood":
        """The same model of these observations only, with the reference that they have."""
        return BalancedLikelihood(self.survey.select(numbers), self.camera, self._refer, self.priors)
