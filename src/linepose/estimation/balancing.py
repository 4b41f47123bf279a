"""The reference of the balanced noise model: the pose and levels that a survey's own optimum has.

Found by repetition: from the hand-measured pose and the prior's levels the optimum is searched, becomes the reference,
and is searched again, until its levels stay. The prior of the navigation's levels is wide meanwhile: it would hold a
level that is zero above it, and pixel noise that is taken for white navigation error moves the pose. That of the pixel
level stays, so that large white navigation errors are not taken for pixel noise.
"""

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.estimation.optimise import minimise
from linepose.geometry.camera import Camera
from linepose.geometry.pose import N_PARAMETERS, check_pose
from linepose.likelihood.balanced import BalancedLikelihood, FindReference, Reference
from linepose.likelihood.shared import SharedPriors
from linepose.likelihood.shared_kernel import Levels, levels_at
from linepose.survey.observations import Survey

WIDE_LOG_SIGMA: Final = 6.0
N_REPETITIONS: Final = 5
LEVELS_STAY: Final = 0.01


class _AtReference(BalancedLikelihood):
    """At a given reference, the navigation's levels hardly bound, and on one core whatever is asked.

    A process that has worked on several cores must not fork any more.
    """

    def __init__(self, survey: Survey, camera: Camera, reference: Reference) -> None:
        super().__init__(survey, camera, lambda *_: reference)
        self._prior_sigma[:2] = WIDE_LOG_SIGMA

    def log_likelihoods(self, parameters: ArrayLike) -> Floats:
        return np.array([self.log_likelihood(row) for row in np.asarray(parameters, dtype=float)])


def reference_from(start_pose: ArrayLike) -> FindReference:
    """What finds the reference of a survey from a start pose (6,), the hand-measured one."""
    start = check_pose(start_pose, "start pose")

    def refer(survey: Survey, camera: Camera) -> Reference:
        reference = Reference(start, Levels(*[SharedPriors().level_median] * 3))
        parameters: Floats | None = None
        for _ in range(N_REPETITIONS):
            likelihood = _AtReference(survey, camera, reference)
            found = minimise(likelihood, likelihood.start(start) if parameters is None else parameters, start)
            following = Reference(found.parameters[:N_PARAMETERS], levels_at(found.parameters))
            try:
                _AtReference(survey, camera, following)
            except InputError:  # run off to where points lie behind: the reference before stays
                break
            change = np.max(np.abs(np.subtract(following.levels, reference.levels)))
            reference, parameters = following, found.parameters
            if change < LEVELS_STAY:
                break
        return reference

    return refer


def balanced(
    survey: Survey, camera: Camera, start_pose: ArrayLike, priors: SharedPriors | None = None
) -> BalancedLikelihood:
    """The balanced model of a survey, its reference found from a start pose (6,)."""
    return BalancedLikelihood(survey, camera, reference_from(start_pose), priors)
