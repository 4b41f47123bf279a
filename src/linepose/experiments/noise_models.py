"""The pose under each noise model, from several sets of observations: what the choice of the model changes.

Beside each pose stand the levels that the model infers, and how far the estimate lies from that of the shared-error
model from the accepted observations. Beside both, what the data say of each parameter of that model.
"""

import logging
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa
from numpy.typing import ArrayLike
from pydantic import Field, PositiveInt

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.estimation.diagnostics import ChainDiagnostics, diagnose_samples
from linepose.estimation.identifiability import identifiability, in_body_axes, in_words
from linepose.estimation.noise_models import BALANCED, ROBUST, SHARED, likelihood_of
from linepose.estimation.noise_models import NOISE_MODELS as MODELS
from linepose.estimation.optimise import Optimum, Search, optimise
from linepose.estimation.sampling import Chain, IndependenceSettings, SamplingSettings, sample, stage_seed
from linepose.experiments.estimate import estimate_fields, observation_list
from linepose.experiments.experiment import Experiment, Section
from linepose.experiments.inputs import Inputs
from linepose.experiments.repeatability import SECTION as REPEATABILITY_SECTION
from linepose.experiments.repeatability import named_pair
from linepose.geometry.camera import Camera
from linepose.geometry.distance import euclidean_distance_m, geodesic_angle_rad, mahalanobis_distance
from linepose.geometry.pose import N_PARAMETERS, POSE_COLUMNS, SIGMA_COLUMNS
from linepose.likelihood.base import Likelihood
from linepose.likelihood.robust import RobustSharedLikelihood
from linepose.likelihood.shared import LEVEL_NAMES, SHARED_PARAMETERS, SharedLikelihood
from linepose.settings import Settings
from linepose.survey.observations import Survey
from linepose.tables import flags, floats, optional_floats, texts, whole_numbers

_logger = logging.getLogger(__name__)
ALL, INLIERS = "all", "inliers"
_ONLY_ON: Final = dict.fromkeys(
    (BALANCED.name, ROBUST.name), (ALL, INLIERS)
)  # elsewhere they would cost more than they tell
EXTRA_PARAMETERS: Final = SHARED_PARAMETERS[N_PARAMETERS:]
LEVELS: Final = tuple(name.removeprefix("log_") for name in LEVEL_NAMES)
_QUANTILES: Final = {"": 0.5, "_low": 0.16, "_high": 0.84}
LEVEL_COLUMNS: Final = tuple(f"{level}{end}" for level in LEVELS for end in _QUANTILES)

Sampling = SamplingSettings | IndependenceSettings

NOISE_MODELS: Final = pa.schema(
    [
        *texts("noise_model", "set"),
        *estimate_fields(),
        *optional_floats(*EXTRA_PARAMETERS, *LEVEL_COLUMNS),
        *floats("effective_sample_size", "split_r_hat"),
        *texts("warning"),
        *floats("distance_m", "angle_rad", "mahalanobis"),
        *optional_floats("position_error_m", "rotation_error_rad", "error_in_sigmas"),
    ]
)
IDENTIFIABILITY: Final = pa.schema(
    [
        *texts("parameter"),
        *floats("prior_sigma", "posterior_sigma", "shrinkage", "weakest_direction", "weakest_shrinkage"),
        *texts("weakest_in_words"),
    ]
)
WEIGHTS: Final = pa.schema(
    [*whole_numbers("observation", "point"), *floats("view_weight", "point_weight"), *flags("removed")]
)


class NoiseModelsSettings(Settings):
    """The pose under each noise model, side by side, and whether disjoint observations agree under each."""

    platforms: list[str] = Field(
        [],
        description="Platform files with other views of the same pattern by the same camera, such as the forward "
        "passes; they are run as far as the outlier removal.",
    )
    n_splits: PositiveInt = Field(200, description="Random splits of each platform's accepted observations.")
    robust_steps: int = Field(
        400, ge=4, description="Steps kept of the robust model's chains, ten times as dear as the shared model's."
    )
    batch_size: PositiveInt = Field(20, description="Splits between two savings; no result depends on it.")


SECTION: Final = Section("noise_models", NoiseModelsSettings, None, "All noise models side by side.")


@dataclass(frozen=True)
class Fit:
    """One noise model fitted to one set of observations, by name: the optimum, the samples and how good they are."""

    noise_model: str
    set: str
    likelihood: Likelihood
    optimum: Optimum
    chain: Chain
    diagnostics: ChainDiagnostics

    @property
    def pose(self) -> Floats:
        """The optimum's pose (6,)."""
        return self.optimum.parameters[:N_PARAMETERS]

    def pose_covariance(self) -> Floats:
        """Covariance (6, 6) of the sampled poses."""
        return self.chain.covariance()[:N_PARAMETERS, :N_PARAMETERS]


def fit_noise_models(
    sets: Mapping[str, Survey],
    camera: Camera,
    settings: Mapping[str, Sampling],
    start: ArrayLike,
    seed: int,
    search: Search | None = None,
) -> Iterator[Fit]:
    """Each noise model of `settings`, by name with its sampling, fitted to each set, from a start pose (6,).

    The balanced and the robust one are fitted to all observations and to the accepted ones only.
    """
    for place, (name, survey) in enumerate(sets.items()):
        for noise_model, how in settings.items():
            if name not in _ONLY_ON.get(noise_model, sets):
                continue
            likelihood = likelihood_of(noise_model, survey, camera, start)
            optimum = optimise(likelihood, start, search)
            chain = sample(likelihood, optimum.parameters, stage_seed(seed, place), how)
            yield Fit(noise_model, name, likelihood, optimum, chain, diagnose_samples(chain.parameters, how.section))


def chosen(fits: list[Fit], noise_model: str, name: str) -> Fit:
    """The fit of a model to a set; raises InputError where there is none."""
    for fit in fits:
        if (fit.noise_model, fit.set) == (noise_model, name):
            return fit
    raise InputError("experiments.noise_models.models", f"no {noise_model}", "it among the models", "add it")


def noise_model_table(fits: list[Fit], true_pose: ArrayLike | None = None) -> pd.DataFrame:
    """One row a fit: pose, sampled sigmas, levels, the chain's worst diagnostics, and how far it is from two others.

    The two are the shared-error estimate of the accepted observations, and the true pose (6,) where it is known, in
    sigmas of the fit itself. Columns as in `NOISE_MODELS`.
    """
    reference = chosen(fits, SHARED.name, INLIERS)
    covariance = reference.pose_covariance()
    return pd.DataFrame(
        [
            {
                **_estimate_columns(fit),
                **_level_columns(fit),
                "distance_m": float(euclidean_distance_m(fit.pose, reference.pose)),
                "angle_rad": float(geodesic_angle_rad(fit.pose, reference.pose)),
                "mahalanobis": float(mahalanobis_distance(fit.pose, reference.pose, covariance)),
                **_error_columns(fit, true_pose),
            }
            for fit in fits
        ]
    )


def _estimate_columns(fit: Fit) -> dict[str, object]:
    names = fit.likelihood.parameter_names
    values = dict(zip(names, fit.optimum.parameters, strict=True))
    return {
        "noise_model": fit.noise_model,
        "set": fit.set,
        "n_observations": fit.likelihood.survey.n_observations,
        "observations": observation_list(fit.likelihood.survey.number),
        **{name: values[name] for name in POSE_COLUMNS},
        **dict(zip(SIGMA_COLUMNS, fit.chain.sigma()[:N_PARAMETERS], strict=True)),
        **{name: values.get(name, np.nan) for name in EXTRA_PARAMETERS},
        "neg_log_likelihood": fit.optimum.neg_log_likelihood,
        "n_evaluations": fit.optimum.n_evaluations,
        "effective_sample_size": float(fit.diagnostics.effective_sample_size.min()),
        "split_r_hat": float(fit.diagnostics.split_r_hat.max()),
        "warning": fit.diagnostics.warning,
    }


def _level_columns(fit: Fit) -> dict[str, float]:
    """Median and central 68 % interval of each level, NaN where the model has none."""
    if fit.likelihood.n_parameters == N_PARAMETERS:
        return dict.fromkeys(LEVEL_COLUMNS, np.nan)
    samples, names = fit.chain.flat(), fit.likelihood.parameter_names
    columns = [names.index(name) for name in LEVEL_NAMES]
    values = np.exp(np.quantile(samples[:, columns], list(_QUANTILES.values()), axis=0)).T
    return dict(zip(LEVEL_COLUMNS, values.ravel(), strict=True))


def _error_columns(fit: Fit, true_pose: ArrayLike | None) -> dict[str, float]:
    if true_pose is None:
        return dict.fromkeys(("position_error_m", "rotation_error_rad", "error_in_sigmas"), np.nan)
    return {
        "position_error_m": float(euclidean_distance_m(fit.pose, true_pose)),
        "rotation_error_rad": float(geodesic_angle_rad(fit.pose, true_pose)),
        "error_in_sigmas": float(mahalanobis_distance(true_pose, fit.pose, fit.pose_covariance())),
    }


def identifiability_table(fits: list[Fit], hand_pose: ArrayLike, hand_covariance: ArrayLike) -> pd.DataFrame:
    """One row a parameter of the shared-error model, from the accepted observations: prior against posterior.

    Rotations are turns about the body's axes. The hand measurement, a pose (6,) with covariance (6, 6), stands for the
    pose's prior, which takes no part in the estimate. Columns as in `IDENTIFIABILITY`.
    """
    fit = chosen(fits, SHARED.name, INLIERS)
    likelihood = fit.likelihood
    assert isinstance(likelihood, SharedLikelihood)
    names, posterior = in_body_axes(likelihood.parameter_names, fit.optimum.parameters, fit.chain.covariance())
    _, hand = in_body_axes(likelihood.parameter_names[:N_PARAMETERS], hand_pose, hand_covariance)
    prior = np.concatenate([np.sqrt(np.diag(hand)), likelihood.prior_sigma[N_PARAMETERS:]])
    found = identifiability(names, posterior, prior)
    return pd.DataFrame(
        {
            "parameter": names,
            "prior_sigma": found.prior_sigma,
            "posterior_sigma": found.posterior_sigma,
            "shrinkage": found.shrinkage,
            "weakest_direction": found.weakest_direction,
            "weakest_shrinkage": found.weakest_shrinkage,
            "weakest_in_words": in_words(names, found.weakest_direction),
        }
    )


def weights_table(fits: list[Fit], accepted: ArrayLike) -> pd.DataFrame:
    """One row an observed point: its weight and its view's under the robust model of all observations.

    `removed` says whether the outlier removal took the observation out. Columns as in `WEIGHTS`.
    """
    fit = chosen(fits, ROBUST.name, ALL)
    likelihood = fit.likelihood
    assert isinstance(likelihood, RobustSharedLikelihood)
    weights, survey = likelihood.weights(fit.optimum.parameters), likelihood.survey
    row, point = np.nonzero(np.isfinite(weights.point))
    return pd.DataFrame(
        {
            "observation": survey.number[row],
            "point": point.astype(np.int64),
            "view_weight": weights.view[row],
            "point_weight": weights.point[row, point],
            "removed": ~np.isin(survey.number[row], np.asarray(accepted)),
        }
    )


def _run(inputs: Inputs) -> dict[str, pd.DataFrame]:
    platform, data = inputs.platform, inputs.data
    sets = {ALL: data.all.survey, INLIERS: data.accepted.survey}
    sets |= {name: other.accepted.survey for name, other in inputs.other_data.items()}
    pair = named_pair(data, inputs.settings(REPEATABILITY_SECTION), inputs.file)
    sets |= {name: data.accepted.survey.select(list(numbers)) for name, numbers in pair.items()}
    settings = {model.name: inputs.sampling(model.section) for model in MODELS.values()}
    settings[ROBUST.name] = settings[ROBUST.name].replaced(n_steps=inputs.required(SECTION).robust_steps)
    camera, start = platform.intrinsics(), platform.start_pose()
    fits = []
    for fit in fit_noise_models(sets, camera, settings, start, inputs.seed, inputs.search):
        fits.append(fit)
        _logger.info("%s, %s: %s", fit.noise_model, fit.set, " ".join(f"{number:.3f}" for number in fit.pose))
    truth = None if platform.simulation is None else np.array(platform.simulation.true_pose)
    identified = identifiability_table(fits, start, platform.start_covariance())
    _logger.info("weakest direction: %s", identified["weakest_in_words"].iloc[0])
    return {
        "noise_models": noise_model_table(fits, truth),
        "identifiability": identified,
        "weights": weights_table(fits, data.accepted.survey.number),
    }


EXPERIMENT: Final = Experiment(
    name="noise_models",
    title="Noise models side by side",
    outputs={"noise_models": NOISE_MODELS, "identifiability": IDENTIFIABILITY, "weights": WEIGHTS},
    run=_run,
    section=SECTION,
    reads=(REPEATABILITY_SECTION,),
    needs=("observations", "outliers"),
    study=("seed", "search", "sampling", "independence_sampling"),
    compares=True,
    every_noise_model=True,
    cores=2,
)
