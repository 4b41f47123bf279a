"""The noise models by the name that a platform file gives them."""

from collections.abc import Callable
from typing import Final

from linepose.camera import Camera
from linepose.likelihood.base import Likelihood
from linepose.likelihood.names import PUBLISHED, ROBUST, SHARED
from linepose.likelihood.prior import PosePrior, WithPrior
from linepose.likelihood.published import PublishedLikelihood
from linepose.likelihood.robust import RobustSharedLikelihood
from linepose.likelihood.shared import SharedLikelihood
from linepose.observations import Survey

NOISE_MODELS: Final[dict[str, Callable[[Survey, Camera], Likelihood]]] = {
    PUBLISHED: PublishedLikelihood,
    SHARED: SharedLikelihood,
    ROBUST: RobustSharedLikelihood,
}


def likelihood_of(noise_model: str, survey: Survey, camera: Camera, prior: PosePrior | None = None) -> Likelihood:
    """The likelihood of a survey under a noise model, by name; with a prior of the pose counted in, if there is one."""
    likelihood = NOISE_MODELS[noise_model](survey, camera)
    return likelihood if prior is None else WithPrior(likelihood, prior)
