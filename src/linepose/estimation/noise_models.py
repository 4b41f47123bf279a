"""The noise models: one entry each, with all that others need of it; nothing else names them.

To add one: a function that makes its likelihood, and a line in `NOISE_MODELS`.
"""

import difflib
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Final, Literal

from numpy.typing import ArrayLike
from pydantic import AfterValidator, WithJsonSchema

from linepose.errors import InputError
from linepose.estimation.sampling import IndependenceSettings, SamplingSettings

if TYPE_CHECKING:  # what computes them is imported when one is asked for
    from linepose.geometry.camera import Camera
    from linepose.likelihood.base import Likelihood
    from linepose.likelihood.prior import PosePrior
    from linepose.survey.observations import Survey

Make = Callable[["Survey", "Camera", ArrayLike], "Likelihood"]
MakeComparable = Callable[["Survey", "Camera", ArrayLike], Callable[["Survey"], "Likelihood"]]


@dataclass(frozen=True)
class NoiseModel:
    """A noise model: its name in files, what it says, how it is drawn and sampled, and what makes its likelihood.

    `make` takes the survey, the camera and the hand-measured pose (6,). `make_comparable` takes them too and gives what
    makes likelihoods of moved surveys that can be compared; None where all that `make` gives can be. `quick`: it
    evaluates in well under a millisecond, so that hundreds of surveys can be estimated with it. `infers_levels`: it has
    noise levels of its own.
    """

    name: str
    meaning: str
    colour: str
    marker: str
    sampling: type[SamplingSettings] | type[IndependenceSettings]
    make: Make
    make_comparable: MakeComparable | None = None
    quick: bool = True
    infers_levels: bool = True

    @property
    def section(self) -> Literal["sampling", "independence_sampling"]:
        """The section of config.yaml that says how it is sampled."""
        return self.sampling.section


def _published(survey: "Survey", camera: "Camera", _: ArrayLike) -> "Likelihood":
    from linepose.likelihood.published import PublishedLikelihood

    return PublishedLikelihood(survey, camera)


def _shared(survey: "Survey", camera: "Camera", _: ArrayLike) -> "Likelihood":
    from linepose.likelihood.shared import SharedLikelihood

    return SharedLikelihood(survey, camera)


def _balanced(survey: "Survey", camera: "Camera", start_pose: ArrayLike) -> "Likelihood":
    from linepose.estimation.balancing import balanced

    return balanced(survey, camera, start_pose)


def _balanced_at_one_reference(
    survey: "Survey", camera: "Camera", start_pose: ArrayLike
) -> "Callable[[Survey], Likelihood]":
    from linepose.estimation.balancing import reference_from
    from linepose.likelihood.balanced import BalancedLikelihood

    reference = reference_from(start_pose)(survey, camera)
    return lambda moved: BalancedLikelihood(moved, camera, lambda *_: reference)


def _robust(survey: "Survey", camera: "Camera", _: ArrayLike) -> "Likelihood":
    from linepose.likelihood.robust import RobustSharedLikelihood

    return RobustSharedLikelihood(survey, camera)


PUBLISHED: Final = NoiseModel(
    "published",
    "every line of a view errs independently, as reported (the paper)",
    "#E69F00",
    "s",
    SamplingSettings,
    _published,
    infers_levels=False,
)
SHARED: Final = NoiseModel(
    "shared",
    "the navigation error is common to a view, its level inferred",
    "#0072B2",
    "o",
    IndependenceSettings,
    _shared,
)
BALANCED: Final = NoiseModel(
    "balanced",
    "shared, without the determinants' pull on the pose (recommended)",
    "#009E73",
    "D",
    IndependenceSettings,
    _balanced,
    _balanced_at_one_reference,
)
ROBUST: Final = NoiseModel(
    "robust",
    "shared, with heavy tails for bad views and points",
    "#CC79A7",
    "^",
    IndependenceSettings,
    _robust,
    quick=False,
)
NOISE_MODELS: Final[dict[str, NoiseModel]] = {one.name: one for one in (PUBLISHED, SHARED, BALANCED, ROBUST)}
DEFAULT: Final = BALANCED


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


def likelihood_of(
    name: str, survey: "Survey", camera: "Camera", start_pose: ArrayLike, prior: "PosePrior | None" = None
) -> "Likelihood":
    """The likelihood of a survey under a noise model, by name; with a prior of the pose counted in, if there is one.

    The start pose (6,) is the hand-measured one, from which the balanced model finds the levels that it needs. Raises
    InputError for an unknown name.
    """
    likelihood = noise_model(name).make(survey, camera, start_pose)
    return likelihood if prior is None else _with_prior(likelihood, prior)


def likelihood_factory(
    name: str, survey: "Survey", camera: "Camera", start_pose: ArrayLike, prior: "PosePrior | None" = None
) -> "Callable[[Survey], Likelihood]":
    """What makes the likelihood of a survey as this one with body poses that differ a little, by their clocks.

    Under the balanced model all have the reference of this one, so that their likelihoods can be compared.
    """
    make_comparable = noise_model(name).make_comparable
    if make_comparable is None:
        return lambda moved: likelihood_of(name, moved, camera, start_pose, prior)
    make = make_comparable(survey, camera, start_pose)
    return lambda moved: make(moved) if prior is None else _with_prior(make(moved), prior)


def _with_prior(likelihood: "Likelihood", prior: "PosePrior") -> "Likelihood":
    from linepose.likelihood.prior import WithPrior

    return WithPrior(likelihood, prior)
