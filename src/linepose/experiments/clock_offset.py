"""The camera's clock against the navigation's: one parameter more, estimated with the pose.

An offset moves a view along its path as a forward lever arm does, and turns it as a pitch may: only passes of different
direction or speed tell them apart. So the estimate comes with its correlations, and with the words to go by.
"""

import logging
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np
import pandas as pd
import pyarrow as pa
from numpy.typing import ArrayLike
from pydantic import Field, PositiveFloat

from linepose.arrays import Floats
from linepose.errors import EstimationError
from linepose.estimation.estimator import Estimator
from linepose.estimation.identifiability import TURN_NAMES, in_body_axes
from linepose.estimation.noise_models import likelihood_of
from linepose.estimation.optimise import Search, laplace_covariance, optimise
from linepose.estimation.sampling import SamplingSettings, sample, stage_seed
from linepose.experiments.clock_offset_evidence import ClockOffsetEvidence
from linepose.experiments.estimate import observation_list
from linepose.experiments.experiment import ESTIMATE, Experiment
from linepose.experiments.inputs import Inputs
from linepose.experiments.jackknife import jackknife_sigma
from linepose.experiments.section import Section
from linepose.geometry.distance import mahalanobis_distance
from linepose.geometry.pose import N_PARAMETERS, POSE_COLUMNS, SIGMA_COLUMNS
from linepose.likelihood.base import Likelihood
from linepose.pipeline.stages import OPTIMA, SAMPLES, sample_table
from linepose.settings import Settings
from linepose.survey.observations import Survey
from linepose.tables import flags, floats, optional_floats, texts, whole_numbers, with_parameters

if TYPE_CHECKING:  # configuration has these settings and must be read quickly: what computes is imported late
    from linepose.estimation.adjustment_estimator import AdjustmentEstimator
    from linepose.likelihood.clock_offset import ClockOffsetLikelihood

_logger = logging.getLogger(__name__)

CORRELATION_COLUMNS: Final = tuple(f"correlation_{name.rsplit('_', 1)[0]}" for name in (*POSE_COLUMNS, *TURN_NAMES))
_INSIDE: Final = 0.75  # of the largest offset, five times the walkers' scatter from it
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
    """The camera's clock against the navigation's, one parameter beside the pose."""

    maximum_s: PositiveFloat = Field(0.1, description="The clocks differ by no more than this (s).")


SECTION: Final = Section(
    "clock_offset",
    ClockOffsetSettings,
    None,
    "Clock offset; under a noise model with a likelihood it needs scans and a raw navigation log.",
)


@dataclass(frozen=True)
class PoseWithoutOffset:
    """The estimate with clocks taken to agree: pose (6,), its covariance (6, 6), and -log L there."""

    pose: Floats
    covariance: Floats
    neg_log_likelihood: float


def estimate_clock_offset(
    likelihood: "ClockOffsetLikelihood",
    without: PoseWithoutOffset,
    start: ArrayLike,
    seed: int,
    search: Search | None = None,
    settings: SamplingSettings | None = None,
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
    found = _Found(
        np.append(optimum.parameters[:N_PARAMETERS], offset_s),
        covariance,
        sigma_s,
        sampled_sigma_s,
        with_pose,
        optimum.neg_log_likelihood,
    )
    curved = {"laplace_sigma_s": laplace_sigma, "jackknife_sigma_s": view_sigma}
    return _table(found, curved, likelihood.survey.number, likelihood.maximum_s, without), sample_table(chain, names)


@dataclass(frozen=True)
class _Found:
    """Pose and offset (7,) with their covariance (7, 7), the offset's sigmas, and its correlation with the pose."""

    parameters: Floats
    covariance: Floats
    sigma_s: float
    sampled_sigma_s: float
    correlation_pose: float
    neg_log_likelihood: float


def adjusted_clock_offset(
    estimator: "AdjustmentEstimator", without: PoseWithoutOffset, maximum_s: float, seed: int
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """The same as one parameter more of the adjustment, whose prior has `maximum_s` at two sigmas from zero.

    The bodies move along the rates of their own views, so that no raw log is needed.
    """
    from linepose.adjustment.assemble import CLOCK_OFFSET_COLUMN

    settings = estimator.settings.replaced(clock_offset_sigma_s=maximum_s / 2)
    adjusted = replace(estimator, settings=settings).adjusted(seed=seed)
    drawn = adjusted.samples[[*POSE_COLUMNS, CLOCK_OFFSET_COLUMN]].to_numpy()
    covariance = np.cov(drawn.T)
    sigma_s = adjusted.clock_offset_sigma_s
    found = _Found(
        np.append(adjusted.pose, adjusted.clock_offset_s),
        covariance,
        sigma_s,
        float(np.sqrt(covariance[-1, -1])),
        correlation_with_all(covariance),
        0.5 * adjusted.diagnostics.chi_squared,
    )
    unknown = dict.fromkeys(("laplace_sigma_s", "jackknife_sigma_s"), np.nan)
    return _table(found, unknown, estimator.survey.number, maximum_s, without), adjusted.samples


def _table(
    found: _Found, curved: dict[str, float], numbers: ArrayLike, maximum_s: float, without: PoseWithoutOffset
) -> pd.DataFrame:
    from linepose.likelihood.clock_offset import OFFSET_NAME

    pose, offset_s = found.parameters[:N_PARAMETERS], float(found.parameters[-1])
    names = (*POSE_COLUMNS, OFFSET_NAME)
    correlation = correlations(found.parameters, found.covariance, names)
    shrinkage = 1 - found.sigma_s**2 / (maximum_s**2 / 3)
    moved = float(mahalanobis_distance(pose, without.pose, without.covariance))
    evidence = ClockOffsetEvidence(
        offset_s, found.sigma_s, maximum_s, shrinkage, found.correlation_pose, correlation, moved
    )
    row = {
        "n_observations": len(np.asarray(numbers)),
        "observations": observation_list(numbers),
        "offset_s": offset_s,
        "sigma_s": found.sigma_s,
        "sampled_sigma_s": found.sampled_sigma_s,
        **curved,
        "maximum_s": maximum_s,
        "shrinkage": shrinkage,
        "correlation_pose": found.correlation_pose,
        **correlation,
        **_pose("", pose, np.sqrt(np.diag(found.covariance)[:N_PARAMETERS]), found.neg_log_likelihood),
        **_pose("_without", without.pose, np.sqrt(np.diag(without.covariance)), without.neg_log_likelihood),
        "mahalanobis": moved,
        "identifiable": evidence.is_identifiable(),
        "verdict": evidence.verdict(),
        "advice": evidence.advice(),
    }
    return pd.DataFrame([row])


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


def _pose(suffix: str, pose: Floats, sigma: Floats, neg_log_likelihood: float) -> dict[str, float]:
    columns = [f"{name}{suffix}" for name in (*POSE_COLUMNS, *SIGMA_COLUMNS)]
    return {
        **dict(zip(columns, map(float, (*pose, *sigma)), strict=True)),
        f"neg_log_likelihood{suffix}": neg_log_likelihood,
    }


def _run(inputs: Inputs) -> dict[str, pd.DataFrame]:
    from linepose.estimation.adjustment_estimator import AdjustmentEstimator

    accepted, reference = inputs.data.accepted, inputs.reference
    optimum = inputs.table("optima", OPTIMA).set_index("stage").loc["inliers"]
    without = PoseWithoutOffset(reference.pose, reference.covariance, float(optimum["neg_log_likelihood"]))
    maximum_s = inputs.required(SECTION).maximum_s
    if isinstance(accepted, AdjustmentEstimator):
        table, samples = adjusted_clock_offset(accepted, without, maximum_s, inputs.seed)
    else:
        table, samples = _of_likelihood(inputs, accepted, without, maximum_s)
    _logger.info("%s", table["verdict"].iloc[0])
    return {"clock_offset": table, "clock_offset_samples": samples}


def _of_likelihood(
    inputs: Inputs, accepted: Estimator, without: PoseWithoutOffset, maximum_s: float
) -> tuple[pd.DataFrame, pd.DataFrame]:
    from linepose.estimation.likelihood_estimator import LikelihoodEstimator
    from linepose.likelihood.clock_offset import with_clock_offset
    from linepose.pipeline.load import read_log

    assert isinstance(accepted, LikelihoodEstimator)
    platform, survey = inputs.platform, accepted.survey

    def model(moved: Survey) -> Likelihood:
        return likelihood_of(platform.noise_model, moved, platform.intrinsics(), platform.pose_prior())

    likelihood = with_clock_offset(survey, read_log(platform, inputs.folder), maximum_s, model)
    seed = stage_seed(inputs.seed, survey.n_observations, 1)
    start = platform.start_pose()
    return estimate_clock_offset(likelihood, without, start, seed, accepted.search, accepted.sampling)


def _samples_schema(table: pd.DataFrame) -> pa.Schema:
    return with_parameters(SAMPLES, [name for name in table.columns if name not in SAMPLES.names])


EXPERIMENT: Final = Experiment(
    name="clock_offset",
    title="Clock offset",
    outputs={"clock_offset": CLOCK_OFFSET, "clock_offset_samples": _samples_schema},
    run=_run,
    section=SECTION,
    needs=ESTIMATE,
    log=True,
    cores=2,
)
