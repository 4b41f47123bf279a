"""The shared-error model with its determinants at an anchor: a pose near the camera's, as measured by hand.

Navigation errors are metres and radians of the body. In pixels they shrink, as do the residuals that they leave, with
the distance at which the camera is thought to be: the same errors explain the same residuals from anywhere. So

    -log p = 1/2 min chi^2 + 1/2 sum log|C_i| + 1/2 log|H_PP| + priors

rewards a camera far away (or of short focal length) by its determinants, though nothing speaks for it: by the number of
residuals over the distance, which is ten sigmas of the lever arm where navigation errors differ from line to line and
are large. (The true body pose at each line is a nuisance parameter; the volume of what is integrated out is what
counts there.) The determinants are needed to infer the levels. Here they have the levels of the parameters, but pose,
intrinsics and points of the anchor: chi^2 alone then decides on the pose, and it is unbiased as long as the covariance
follows the pose as the residuals do.

For that, noise across the line must follow as well. No pixel was measured there, v is zero, but a time: the noise is
the body's motion during a short time, seen in the image. It is `sigma_v` across the line at the anchor; elsewhere it
grows, shrinks and turns with the image of the body's motion, whose rate is a straight line through the reported poses
of the view. Views whose points have no different times keep `sigma_v`.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from linepose.camera import Camera
from linepose.errors import InputError
from linepose.likelihood.anchored_rows import Anchor, row_log_likelihood, rows_log_likelihood
from linepose.likelihood.shared import SharedLikelihood, SharedPriors
from linepose.likelihood.shared_kernel import Levels, Optics, empty_lines, linearise, optics_at
from linepose.likelihood.shared_marginal import initial_points
from linepose.observations import Survey
from linepose.pose import check_pose
from linepose.rotations import Floats


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


class AnchoredLikelihood(SharedLikelihood):
    """Log-density of pose, levels and intrinsics under the shared-error model, determinants at an anchor pose (6,).

    Parameters (11,) are those of the shared-error model. Raises InputError as that model does, and for an anchor at
    which a point is not in front of the camera.
    """

    def __init__(
        self, survey: Survey, camera: Camera, anchor_pose: ArrayLike, priors: SharedPriors | None = None
    ) -> None:
        super().__init__(survey, camera, priors)
        self.anchor_pose = check_pose(anchor_pose, "anchor pose")
        parameters = self.start(self.anchor_pose)
        optics = optics_at(parameters, self._fixed)
        valid, points = initial_points(self._arrays, optics, len(self._points))
        if not valid or not np.all(np.isfinite(points)):
            raise InputError(
                "anchor pose",
                f"{self.anchor_pose.tolist()}, where a point is not in front of the camera",
                "a pose near the camera's",
                "give the hand-measured pose, or mend it",
            )
        self._arrays = self._arrays._replace(motion=self._motion(optics, points))
        self._anchor = Anchor(parameters, points)

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
        return rows_log_likelihood(self._arrays, self._fixed, self._anchor, self._prior_centre, self._prior_sigma, rows)

    def log_likelihood(self, parameters: ArrayLike) -> float:
        """Log-density of one parameter vector (11,), on one core."""
        vector = self._vector(parameters)
        return float(
            row_log_likelihood(self._arrays, self._fixed, self._anchor, self._prior_centre, self._prior_sigma, vector)
        )

    def select(self, numbers: Sequence[int]) -> "AnchoredLikelihood":
        """The same model of these observations only."""
        return AnchoredLikelihood(self.survey.select(numbers), self.camera, self.anchor_pose, self.priors)
