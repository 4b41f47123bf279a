"""What a platform's file asks to estimate with."""

from linepose.adjustment.known_points import KnownPoints
from linepose.adjustment.settings import AdjustmentSection
from linepose.config.platform import Platform
from linepose.estimation.estimator import Conditions, Estimator
from linepose.estimation.noise_models import estimator_of, likelihood_of
from linepose.estimation.optimise import Search
from linepose.estimation.sampling import SamplingSettings
from linepose.geometry.camera import Camera
from linepose.likelihood.base import Likelihood
from linepose.survey.observations import Survey


def platform_likelihood(platform: Platform, survey: Survey) -> Likelihood:
    """The likelihood of a survey under the platform's noise model and prior, of one that removes outliers.

    Raises InputError where an observed point has no usable body pose or covariance.
    """
    return likelihood_of(platform.noise_model, survey, platform.intrinsics(), platform.pose_prior())


def platform_conditions(
    platform: Platform,
    search: Search | None = None,
    sampling: SamplingSettings | None = None,
    adjustment: AdjustmentSection | None = None,
    camera: Camera | None = None,
    known_points: KnownPoints | None = None,
) -> Conditions:
    """What is known of a platform beside its survey; with another camera than its own if given."""
    return Conditions(
        camera or platform.intrinsics(),
        platform.hand_measured,
        platform.prior == "hand_measured",
        search or Search(),
        sampling or SamplingSettings(),
        adjustment or AdjustmentSection(),
        known_points,
    )


def platform_estimator(platform: Platform, survey: Survey, conditions: Conditions) -> Estimator:
    """What estimates from a survey under the platform's noise model; raises InputError as `platform_likelihood`."""
    return estimator_of(platform.noise_model, survey, conditions)
