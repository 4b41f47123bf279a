"""The noise models: one entry each, with all that others need of it; nothing else names them.

To add one: a function that makes its likelihood, and a line in `NOISE_MODELS`.
"""

import difflib
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Final

from pydantic import AfterValidator, WithJsonSchema

from linepose.errors import InputError

if TYPE_CHECKING:  # what computes them is imported when one is asked for
    from linepose.estimation.estimator import Conditions, Estimator
    from linepose.geometry.camera import Camera
    from linepose.likelihood.base import Likelihood
    from linepose.likelihood.prior import PosePrior
    from linepose.survey.observations import Survey


@dataclass(frozen=True)
class NoiseModel:
    """A noise model: its name in files, what it says, how it is drawn, and what makes its likelihood.

    With a likelihood, observations are removed one after another, and what is left is optimised and sampled. Without
    one it is the adjustment, which weights observations and has pose and posterior in one.
    """

    name: str
    meaning: str
    colour: str
    marker: str
    likelihood: "Callable[[Survey, Camera], Likelihood] | None"

    @property
    def removes_outliers(self) -> bool:
        """Whether observations are removed, and the rest optimised and sampled, stage by stage."""
        return self.likelihood is not None


def _published(survey: "Survey", camera: "Camera") -> "Likelihood":
    from linepose.likelihood.published import PublishedLikelihood

    return PublishedLikelihood(survey, camera)


ADJUSTMENT: Final = NoiseModel(
    "adjustment",
    "the navigation error drifts, is common to a view or each measurement's own, how much is inferred from the data",
    "#009E73",
    "o",
    None,
)
PUBLISHED: Final = NoiseModel(
    "published",
    "each measurement of a view errs independently, as reported (the paper)",
    "#E69F00",
    "s",
    _published,
)
NOISE_MODELS: Final[dict[str, NoiseModel]] = {one.name: one for one in (ADJUSTMENT, PUBLISHED)}
DEFAULT: Final = ADJUSTMENT


def noise_model(name: str) -> NoiseModel:
    """The noise model of this name; raises InputError for an unknown one."""
    if name not in NOISE_MODELS:
        near = difflib.get_close_matches(name, NOISE_MODELS, n=1)
        remedy = f"did you mean {near[0]}?" if near else "choose one of these"
        raise InputError("noise_model", repr(name), f"one of {', '.join(NOISE_MODELS)}", remedy)
    return NOISE_MODELS[name]


def _known(name: str) -> str:
    if name not in NOISE_MODELS:
        raise ValueError(f"one of {', '.join(NOISE_MODELS)}")
    return name


NoiseModelName = Annotated[str, AfterValidator(_known), WithJsonSchema({"type": "string", "enum": list(NOISE_MODELS)})]
MEANINGS: Final = " ".join(f"{one.name}: {one.meaning}." for one in NOISE_MODELS.values())


def likelihood_of(name: str, survey: "Survey", camera: "Camera", prior: "PosePrior | None" = None) -> "Likelihood":
    """The likelihood of a survey under a noise model that has one, by name; with a prior of the pose, if there is one.

    Raises InputError for an unknown name, and for the noise model that has none.
    """
    make = noise_model(name).likelihood
    if make is None:
        others = [one.name for one in NOISE_MODELS.values() if one.removes_outliers]
        raise InputError("noise_model", name, f"one with a likelihood: {', '.join(others)}", "choose one of these")
    likelihood = make(survey, camera)
    if prior is None:
        return likelihood
    from linepose.likelihood.prior import WithPrior

    return WithPrior(likelihood, prior)


def estimator_of(name: str, survey: "Survey", conditions: "Conditions") -> "Estimator":
    """What estimates from a survey under a noise model, by name; raises InputError for an unknown one."""
    if not noise_model(name).removes_outliers:
        from linepose.estimation.adjustment_estimator import adjustment_estimator

        return adjustment_estimator(survey, conditions)
    from linepose.estimation.likelihood_estimator import LikelihoodEstimator
    from linepose.likelihood.prior import pose_prior

    hand = conditions.hand_measured
    prior = pose_prior(hand.pose, hand.covariance) if conditions.prior else None
    likelihood = likelihood_of(name, survey, conditions.camera, prior)
    return LikelihoodEstimator(likelihood, conditions.search, conditions.sampling)
