"""The noise models by the name that a platform file gives them."""

from collections.abc import Callable
from typing import Final

from numpy.typing import ArrayLike

from linepose.estimation.balancing import balanced, reference_from
from linepose.geometry.camera import Camera
from linepose.likelihood.balanced import BalancedLikelihood
from linepose.likelihood.base import Likelihood
from linepose.likelihood.names import BALANCED, PUBLISHED, ROBUST, SHARED
from linepose.likelihood.prior import PosePrior, WithPrior
from linepose.likelihood.published import PublishedLikelihood
from linepose.likelihood.robust import RobustSharedLikelihood
from linepose.likelihood.shared import SharedLikelihood
from linepose.survey.observations import Survey

NOISE_MODELS: Final[dict[str, Callable[[Survey, Camera, ArrayLike], Likelihood]]] = {
    PUBLISHED: lambda survey, camera, _: PublishedLikelihood(survey, camera),
    SHARED: lambda survey, camera, _: SharedLikelihood(survey, camera),
    BALANCED: balanced,
    ROBUST: lambda survey, camera, _: RobustSharedLikelihood(survey, camera),
}


def likelihood_of(
    noise_model: str, survey: Survey, camera: Camera, start_pose: ArrayLike, prior: PosePrior | None = None
) -> Likelihood:
    """The likelihood of a survey under a noise model, by name; with a prior of the pose counted in, if there is one.

    The start pose (6,) is the hand-measured one, from which the balanced model finds the levels that it needs.
    """
    likelihood = NOISE_MODELS[noise_model](survey, camera, start_pose)
    return likelihood if prior is None else WithPrior(likelihood, prior)


def likelihood_factory(
    noise_model: str, survey: Survey, camera: Camera, start_pose: ArrayLike, prior: PosePrior | None = None
) -> Callable[[Survey], Likelihood]:
    """What makes the likelihood of a survey as this one with body poses that differ a little, by their clocks.

    Under the balanced model all have the reference of this one, so that their likelihoods can be compared.
    """
    if noise_model != BALANCED:
        return lambda moved: likelihood_of(noise_model, moved, camera, start_pose, prior)
    reference = reference_from(start_pose)(survey, camera)

    def alike(moved: Survey) -> Likelihood:
        likelihood = BalancedLikelihood(moved, camera, lambda *_: reference)
        return likelihood if prior is None else WithPrior(likelihood, prior)

    return alike
