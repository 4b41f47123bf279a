"""The camera's clock against the navigation's: one parameter more, estimated with the pose.

An offset moves a view along its path as a forward lever arm does, and turns it as a pitch may: only passes of different
direction or speed tell them apart. So the estimate comes with its correlations, and with the words to go by.
"""

import logging
from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa
from numpy.typing import ArrayLike
from pydantic import Field, PositiveFloat

from linepose.arrays import Floats
from linepose.errors import EstimationError
from linepose.estimation.identifiability import TURN_NAMES, in_body_axes
from linepose.estimation.noise_models import likelihood_factory
from linepose.estimation.optimise import Search, laplace_covariance, optimise
from linepose.estimation.sampling import IndependenceSettings, SamplingSettings, sample, stage_seed
from linepose.experiments.estimate import observation_list
from linepose.experiments.experiment import ESTIMATE, Experiment, Section
from linepose.experiments.inputs import Inputs
from linepose.experiments.jackknife import jackknife_sigma
from linepose.geometry.distance import mahalanobis_distance
from linepose.geometry.pose import N_PARAMETERS, POSE_COLUMNS, SIGMA_COLUMNS
from linepose.likelihood.clock_offset import ClockOffsetLikelihood, with_clock_offset
from linepose.pipeline.load import read_log
from linepose.pipeline.stages import SAMPLES, sample_table
from linepose.settings import Settings
from linepose.tables import flags, floats, optional_floats, texts, whole_numbers, with_parameters

_logger = logging.getLogger(__name__)

CORRELATION_COLUMNS: Final = tuple(f"correlation_{name.rsplit('_', 1)[0]}" for name in (*POSE_COLUMNS, *TURN_NAMES))
IDENTIFIABLE_SHRINKAGE: Final = 0.75  # of the shrinkage: the sigma is half of what it was before any data
MOST_COMMON: Final = 0.98  # correlation with the whole pose, where a sigma is five times what it is with the pose known
LINKED: Final = 0.9  # correlation with the pose, from which it is the pose that hides the offset, and not the noise
NOTABLE: Final = 3.0  # sigmas from zero
_INSIDE: Final = 0.75  # of the largest offset, five times the walkers' scatter from it
_LARGEST: Final = 0.9  # of the largest offset, where the search has run into its end
_WORDS: Final = {
    "r_x": "forward lever arm",
    "r_y": "sideways lever arm",
    "r_z": "height",
    "roll": "roll",
    "pitch": "pitch",
    "yaw": "yaw",
}

CLOCK_OFFSET: Final = pa.schema(
    [
        *whole_numbers("n_observations"),
        *texts("observations"),
        *floats("offset_s", "sigma_s", "sampled_sigma_s"),
        *optional_floats("laplace_sigma_s", "jackknife_sigma_s"),
        *floats("maximum_s", "shrinkage", "correlation_pose", *CORRELATION_COLUMNS),
        *floats(*POSE_COLUMNS, *SIGMA_COLUMNS, "neg_log_likelihood"),
        *floats(*(f"{name}_without" for name in (*POSE_COLUMNS, *SIGMA_COLUMNS, "neg_log_likelihood")), "mahalanobis"),
        *flags("identifiable"),
        *texts("verdict", "advice"),
    ]
)


class ClockOffsetSettings(Settings):
    """The camera's clock against the navigation's, one parameter beside the pose; needs a raw navigation log."""

    maximum_s: PositiveFloat = Field(0.1, description="The clocks differ by no more than this (s).")


SECTION: Final = Section(
    "clock_offset",
    ClockOffsetSettings,
    None,
    "Clock offset, of platforms with scans and a raw navigation log only.",
)


@dataclass(frozen=True)
class PoseWithoutOffset:
    """The estimate with clocks taken to agree: pose (6,), its covariance (6, 6), and -log L there."""

    pose: Floats
    covariance: Floats
    neg_log_likelihood: float


def estimate_clock_offset(
    likelihood: ClockOffsetLikelihood,
    without: PoseWithoutOffset,
    start: ArrayLike,
    seed: int,
    search: Search | None = None,
    settings: SamplingSettings | IndependenceSettings | None = None,
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """The offset and the pose together from a start pose (6,): a table of one row, and the samples behind its sigmas.

    `correlation_pose` is that of the curvature, which no limit of the offset hides; 1 where the curvature leaves a
    direction open. The offset's sigma is the larger of the samples' and of leaving out observations. Columns as in
    `CLOCK_OFFSET`; a sigma from the curvature is NaN where the data leave a direction open.
    """
    optimum = optimise(likelihood, start, search)
    laplace_sigma, view_sigma, with_pose = float("nan"), float("nan"), 1.0
    try:
        curvature = laplace_covariance(likelihood, optimum.parameters)
        laplace_sigma, with_pose = float(np.sqrt(curvature[-1, -1])), correlation_with_all(curvature)
        view_sigma = float(jackknife_sigma(likelihood, optimum.parameters, curvature)[-1])
    except EstimationError:
        _logger.info("the data leave the clock offset or the pose open at the optimum: no sigma from the curvature")
    middle = optimum.parameters.copy()  # of the walkers, none of which may start beyond the largest offset
    middle[-1] = np.clip(middle[-1], -_INSIDE * likelihood.maximum_s, _INSIDE * likelihood.maximum_s)
    chain = sample(likelihood, middle, seed, settings)
    names, covariance = likelihood.parameter_names, chain.covariance()
    offset_s, sampled_sigma_s = float(optimum.parameters[-1]), float(chain.sigma()[-1])
    sigma_s = float(np.nanmax([sampled_sigma_s, view_sigma]))
    correlation = correlations(optimum.parameters, covariance, names)
    shrinkage = 1 - sigma_s**2 / (likelihood.maximum_s**2 / 3)
    pose = optimum.parameters[:N_PARAMETERS]
    moved = float(mahalanobis_distance(pose, without.pose, without.covariance))
    evidence = ClockOffsetEvidence(offset_s, sigma_s, likelihood.maximum_s, shrinkage, with_pose, correlation, moved)
    row = {
        "n_observations": likelihood.survey.n_observations,
        "observations": observation_list(likelihood.survey.number),
        "offset_s": offset_s,
        "sigma_s": sigma_s,
        "sampled_sigma_s": sampled_sigma_s,
        "laplace_sigma_s": laplace_sigma,
        "jackknife_sigma_s": view_sigma,
        "maximum_s": likelihood.maximum_s,
        "shrinkage": shrinkage,
        "correlation_pose": with_pose,
        **correlation,
        **_pose("", pose, np.sqrt(np.diag(covariance)[:N_PARAMETERS]), optimum.neg_log_likelihood),
        **_pose("_without", without.pose, np.sqrt(np.diag(without.covariance)), without.neg_log_likelihood),
        "mahalanobis": moved,
        "identifiable": evidence.is_identifiable(),
        "verdict": evidence.verdict(),
        "advice": evidence.advice(),
    }
    return pd.DataFrame([row]), sample_table(chain, names)


def correlations(parameters: ArrayLike, covariance: ArrayLike, names: tuple[str, ...]) -> dict[str, float]:
    """Correlation of the last parameter with each of the pose's, and with its turns about the body's axes."""
    _, turned = in_body_axes(names, parameters, covariance)
    found = []
    for matrix in (np.asarray(covariance, dtype=float), turned):
        sigma = np.sqrt(np.diag(matrix))
        found.append(matrix[-1] / sigma / sigma[-1])
    values = [*found[0][:N_PARAMETERS], *found[1][3:N_PARAMETERS]]
    return dict(zip(CORRELATION_COLUMNS, map(float, values), strict=True))


def correlation_with_all(covariance: ArrayLike) -> float:
    """Correlation, 0 to 1, of the last parameter with the best linear combination of all others."""
    matrix = np.asarray(covariance, dtype=float)
    sigma = np.sqrt(np.diag(matrix))
    inverse = np.linalg.pinv(matrix / np.outer(sigma, sigma), hermitian=True)
    return float(np.sqrt(np.clip(1 - 1 / inverse[-1, -1], 0.0, 1.0)))


@dataclass(frozen=True)
class ClockOffsetEvidence:
    """What is known of the offset, and how to say it."""

    offset_s: float
    sigma_s: float
    maximum_s: float
    shrinkage: float
    correlation_pose: float
    correlation: dict[str, float]
    mahalanobis: float

    def is_identifiable(self) -> bool:
        """Whether the data tell the offset from the pose."""
        inside = abs(self.offset_s) < _LARGEST * self.maximum_s
        return self.shrinkage >= IDENTIFIABLE_SHRINKAGE and self.correlation_pose < MOST_COMMON and inside

    def verdict(self) -> str:
        """One or two sentences: what the offset is, or why it is not known."""
        found = f"{1e3 * self.offset_s:.1f} ± {1e3 * self.sigma_s:.1f} ms"
        if not self.is_identifiable():
            if abs(self.offset_s) >= _LARGEST * self.maximum_s and self.shrinkage >= IDENTIFIABLE_SHRINKAGE:
                return f"The clock offset is at the end of its range: {found} of ±{1e3 * self.maximum_s:g} ms."
            if self.correlation_pose < LINKED:
                return (
                    f"The data do not tell the clock offset: {found}, where ±{1e3 * self.maximum_s:g} ms were allowed."
                )
            return (
                f"The clock offset cannot be told from the pose: {found}, where ±{1e3 * self.maximum_s:g} ms were "
                f"allowed; it goes with the {self._partner()}, correlation {self._correlation():+.2f}."
            )
        if abs(self.offset_s) < NOTABLE * self.sigma_s:
            return f"No clock offset shows: {found} is less than {NOTABLE:g} sigmas."
        which = "behind" if self.offset_s > 0 else "ahead of"
        return (
            f"The camera's clock is {which} the navigation's: the offset is {found}. With it the pose moves by "
            f"{self.mahalanobis:.1f} sigmas."
        )

    def advice(self) -> str:
        """What to do; empty where there is nothing to do."""
        if not self.is_identifiable():
            if abs(self.offset_s) >= _LARGEST * self.maximum_s and self.shrinkage >= IDENTIFIABLE_SHRINKAGE:
                return "Raise experiments.clock_offset.maximum_s, and check in which time scale each clock runs."
            if self.correlation_pose < LINKED:
                return (
                    "Take the pose without the offset. Faster passes, more of them, or better navigation would tell it."
                )
            return (
                "Take the pose without the offset, and add passes in the other direction and at other speeds: they "
                "move the view the other way for the same offset."
            )
        if abs(self.offset_s) < NOTABLE * self.sigma_s:
            return ""
        verb = "Add" if self.offset_s > 0 else "Subtract"
        shift = abs(round(1e6 * self.offset_s))
        preposition = "to" if self.offset_s > 0 else "from"
        return f"{verb} {shift} us {preposition} the camera's time stamps and run again, or mend its clock."

    def _strongest(self) -> str:
        named = [f"correlation_{name}" for name in _WORDS]
        return max(named, key=lambda name: abs(self.correlation[name]))

    def _partner(self) -> str:
        return _WORDS[self._strongest().removeprefix("correlation_")]

    def _correlation(self) -> float:
        return self.correlation[self._strongest()]


def _pose(suffix: str, pose: Floats, sigma: Floats, neg_log_likelihood: float) -> dict[str, float]:
    columns = [f"{name}{suffix}" for name in (*POSE_COLUMNS, *SIGMA_COLUMNS)]
    return {
        **dict(zip(columns, map(float, (*pose, *sigma)), strict=True)),
        f"neg_log_likelihood{suffix}": neg_log_likelihood,
    }


def _run(inputs: Inputs) -> dict[str, pd.DataFrame]:
    platform, accepted, reference = inputs.platform, inputs.data.accepted, inputs.reference
    without = PoseWithoutOffset(reference.pose, reference.covariance, -accepted.log_likelihood(reference.parameters))
    survey, start = accepted.survey, platform.start_pose()
    model = likelihood_factory(platform.noise_model, survey, platform.intrinsics(), start, platform.pose_prior())
    raw_log = read_log(platform, inputs.folder)
    likelihood = with_clock_offset(survey, raw_log, inputs.required(SECTION).maximum_s, model)
    seed = stage_seed(inputs.seed, survey.n_observations, 1)
    table, samples = estimate_clock_offset(likelihood, without, start, seed, inputs.search, inputs.sampling())
    _logger.info("%s", table["verdict"].iloc[0])
    return {"clock_offset": table, "clock_offset_samples": samples}


def _samples_schema(table: pd.DataFrame) -> pa.Schema:
    return with_parameters(SAMPLES, [name for name in table.columns if name not in SAMPLES.names])


EXPERIMENT: Final = Experiment(
    name="clock_offset",
    title="Clock offset",
    outputs={"clock_offset": CLOCK_OFFSET, "clock_offset_samples": _samples_schema},
    run=_run,
    section=SECTION,
    needs=ESTIMATE,
    study=("seed", "search", "own_sampling"),
    log=True,
    cores=2,
)
