"""The adjustment beside a noise model that removes observations: pose, levels and halves from the same observations."""

import logging
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np
import pandas as pd
import pyarrow as pa
from numpy.typing import ArrayLike
from pydantic import Field, PositiveInt

from linepose.adjustment.levels import LEVEL_NAMES
from linepose.estimation.noise_models import ADJUSTMENT as ADJUSTMENT_MODEL
from linepose.experiments.estimate import estimate_fields, estimate_row
from linepose.experiments.experiment import Experiment
from linepose.experiments.inputs import Inputs, log_rows
from linepose.experiments.section import Section
from linepose.experiments.splits import SPLITS, random_splits, sigma_factor
from linepose.geometry.distance import euclidean_distance_m, geodesic_angle_rad, mahalanobis_distance
from linepose.pipeline.adjusted_schemas import ADJUSTED
from linepose.pipeline.batches import batch_ranges
from linepose.settings import Settings
from linepose.tables import floats, optional_floats, texts

if TYPE_CHECKING:  # configuration has these settings and must be read quickly: what computes is imported late
    from linepose.adjustment.result import Adjustment
    from linepose.estimation.adjustment_estimator import AdjustmentEstimator

_logger = logging.getLogger(__name__)
ALL: Final = "all"
INLIERS: Final = "inliers"
_INTERVALS: Final = tuple(f"{name}{end}" for name in LEVEL_NAMES for end in ("_low", "_high"))

ADJUSTMENT: Final = pa.schema(
    [
        *texts("set"),
        *estimate_fields(),
        *floats(*LEVEL_NAMES),
        *optional_floats(*_INTERVALS, "least_eigenvalue"),
        *floats("smallest_weight"),
        *texts("warning"),
        *optional_floats("position_error_m", "rotation_error_rad", "error_in_sigmas"),
    ]
)
ADJUSTED_SPLITS: Final = pa.schema([*texts("set"), *SPLITS])


class AdjustmentBesideSettings(Settings):
    """The adjustment beside a noise model that removes observations."""

    platforms: list[str] = Field(
        [],
        description="Platform files of the same camera with other data choices (covariance columns, views), which are "
        "adjusted too; they are run as far as the outlier removal.",
    )
    n_splits: int = Field(30, ge=0, le=1_000_000, description="Random halves of each set of observations.")
    batch_size: PositiveInt = Field(10, description="Splits between two savings; no result depends on it.")


SECTION: Final = Section(
    "adjustment_beside",
    AdjustmentBesideSettings,
    None,
    "The adjustment beside, of platforms whose noise model removes observations.",
)


def adjustment_table(
    sets: "Mapping[str, AdjustmentEstimator]", adjusted: "Mapping[str, Adjustment]", true_pose: ArrayLike | None = None
) -> pd.DataFrame:
    """One row a set of observations: pose, sigmas, levels, and the error where the true pose (6,) is known.

    `adjusted` has what the adjustment of each set found; columns as in `ADJUSTMENT`.
    """
    rows = []
    for name, estimator in sets.items():
        found = adjusted[name]
        weights = [found.view_weight, found.measurement_weight.ravel()]
        intervals = dict(zip(_INTERVALS, found.level_intervals.ravel(), strict=True))
        rows.append(
            {
                "set": name,
                **estimate_row(estimator.noted(found)),
                **found.levels._asdict(),
                **intervals,
                "least_eigenvalue": found.diagnostics.least_eigenvalue,
                "smallest_weight": float(np.nanmin(np.concatenate(weights))),
                "warning": "; ".join(found.diagnostics.warnings),
                **_errors(found.pose, found.covariance, true_pose),
            }
        )
    return pd.DataFrame(rows)


def _errors(pose: ArrayLike, covariance: ArrayLike, truth: ArrayLike | None) -> dict[str, float]:
    if truth is None:
        return dict.fromkeys(("position_error_m", "rotation_error_rad", "error_in_sigmas"), np.nan)
    return {
        "position_error_m": float(euclidean_distance_m(pose, truth)),
        "rotation_error_rad": float(geodesic_angle_rad(pose, truth)),
        "error_in_sigmas": float(mahalanobis_distance(truth, pose, covariance)),
    }


def adjusted_splits(
    sets: "Mapping[str, AdjustmentEstimator]", name: str, start: ArrayLike, indices: Sequence[int], seed: int
) -> pd.DataFrame:
    """Random halves of one set; columns as in `ADJUSTED_SPLITS`."""
    estimator = sets[name]
    half = estimator.survey.n_observations // 2
    return random_splits(estimator, start, half, indices, seed).assign(set=name)


def _run(inputs: Inputs) -> dict[str, pd.DataFrame]:
    from linepose.adjustment.reprojection import reprojection
    from linepose.estimation.adjustment_estimator import adjustment_estimator
    from linepose.pipeline.adjusted_tables import error_tables

    settings, conditions, seed = inputs.required(SECTION), inputs.conditions, inputs.seed
    surveys = {ALL: inputs.data.all.survey, INLIERS: inputs.data.accepted.survey}
    surveys |= {name: other.all.survey for name, other in inputs.other_data.items()}
    sets = {name: adjustment_estimator(survey, conditions) for name, survey in surveys.items()}
    simulation = inputs.platform.simulation
    adjusted = {name: estimator.adjusted(seed=seed) for name, estimator in sets.items()}
    table = adjustment_table(sets, adjusted, None if simulation is None else np.array(simulation.true_pose))
    log_rows(_logger, "%s: r_z %.3f m", table, ("set", "r_z_m"))
    found = adjusted[ALL]
    errors = reprojection(surveys[ALL], conditions.camera, found, sets[ALL].settings.line_period_s)
    ranges = batch_ranges(settings.n_splits, settings.batch_size)
    parts = {f"{name}-{part}": (name, ranges[part]) for name in sets for part in ranges}
    start = inputs.platform.start_pose()
    splits = inputs.in_batches(
        lambda part: adjusted_splits(sets, parts[part][0], start, list(parts[part][1]), seed),
        list(parts),
        ADJUSTED_SPLITS,
    )
    for name, rows in splits.groupby("set", sort=False):
        _logger.info("%s: halves %.2f times as far apart as stated", name, sigma_factor(rows))
    return {
        "adjustment": table,
        "adjusted_splits": splits,
        **error_tables(surveys[ALL], conditions.camera, found, errors, sets[ALL].settings),
    }


EXPERIMENT: Final = Experiment(
    name="adjustment_beside",
    title="The adjustment beside",
    outputs={"adjustment": ADJUSTMENT, "adjusted_splits": ADJUSTED_SPLITS, **ADJUSTED},
    run=_run,
    section=SECTION,
    needs=("observations", "outliers"),
    compares=True,
    removal=True,
    noise_model=ADJUSTMENT_MODEL.name,
    cores=None,
)
