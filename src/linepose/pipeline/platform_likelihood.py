"""The likelihood that a platform's file asks for."""

from linepose.config.platform import Platform
from linepose.estimation.noise_models import likelihood_of
from linepose.geometry.camera import Camera
from linepose.likelihood.base import Likelihood
from linepose.survey.observations import Survey


def platform_likelihood(platform: Platform, survey: Survey, camera: Camera | None = None) -> Likelihood:
    """The likelihood of a survey under the platform's noise model and prior; with another camera than its own if given.

    Raises InputError where an observed point has no usable body pose or covariance.
    """
    return likelihood_of(
        platform.noise_model,
        survey,
        camera or platform.intrinsics(),
        platform.start_pose(),
        platform.pose_prior(),
    )
