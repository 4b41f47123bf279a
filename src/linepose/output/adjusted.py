"""What a platform's results say of the adjustment: the platform's own, or one beside a model that removes observations.

Figures and report both take it from here.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd

from linepose.arrays import Floats
from linepose.config.platform import Platform
from linepose.estimation.noise_models import ADJUSTMENT as ADJUSTMENT_MODEL
from linepose.estimation.noise_models import noise_model
from linepose.experiments.adjustment_beside import ADJUSTED_SPLITS, ADJUSTMENT, ALL, INLIERS, SECTION
from linepose.experiments.repeatability import SECTION as REPEATABILITY_SECTION
from linepose.experiments.splits import SPLITS, known_distances, sigma_factor
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from linepose.pipeline.adjusted_schemas import LEVELS
from linepose.pipeline.calibration import Calibration
from linepose.pipeline.stages import POSE
from linepose.pipeline.table_checks import stage_rows

NOT_ASKED_FOR: Final = (
    "The adjustment was not asked for: experiments.adjustment_beside is null in the platform's file, and its noise "
    "model is another."
)
CORRECTION_HEADS: Final = ("North (mm)", "East (mm)", "Down (mm)", "Roll (°)", "Pitch (°)", "Yaw (°)")
CORRECTION_SCALE: Final = np.array([1e3] * 3 + [float(np.degrees(1.0))] * 3)  # from m and rad
NO_HALVES: Final = (
    "No halves were asked for: neither repeatability nor adjustment_beside has splits in the platform's file."
)


@dataclass(frozen=True)
class Halves:
    """Random halves of one set of observations under one noise model.

    distance (K,): of the two poses of each split, in sigmas; factor: how many times as far apart as stated they lie.
    """

    noise_model: str
    set: str
    distance: Floats
    factor: float


def is_adjusted(platform: Platform) -> bool:
    """Whether the platform's own noise model is the adjustment."""
    return not noise_model(platform.noise_model).removes_outliers


def has_adjustment(platform: Platform) -> bool:
    """Whether there are results of an adjustment: the platform's own, or one beside its noise model."""
    return is_adjusted(platform) or bool(SECTION.of(platform))


def without_adjustment(platform: Platform) -> str:
    """Why a platform has nothing of the adjustment; empty where it has."""
    return "" if has_adjustment(platform) else NOT_ASKED_FOR


def has_own_halves(platform: Platform) -> bool:
    """Whether random halves were made under the platform's own noise model."""
    settings = REPEATABILITY_SECTION.of(platform)
    return bool(settings and settings.n_splits)


def has_halves_beside(platform: Platform) -> bool:
    """Whether random halves were made under an adjustment beside the platform's noise model."""
    settings = None if is_adjusted(platform) else SECTION.of(platform)
    return bool(settings and settings.n_splits)


def set_in_words(name: str) -> str:
    """A set of observations as people call it."""
    return {ALL: "all observations", INLIERS: "accepted observations"}.get(name, name)


def levels_by_set(calibration: Calibration) -> dict[str, pd.DataFrame]:
    """The levels of each set of observations, columns as in `LEVELS`; all observations first."""
    own = calibration.results.table("levels", LEVELS)
    if is_adjusted(calibration.platform_file):
        return {ALL: own}
    beside = calibration.results.table("adjustment", ADJUSTMENT)
    return {str(row["set"]): _levels_of(row, own) for _, row in beside.iterrows()}


def _levels_of(row: "pd.Series", own: pd.DataFrame) -> pd.DataFrame:
    names = own["level"]
    parts = {"value": "", "low": "_low", "high": "_high"}
    return own.assign(**{column: [float(row[f"{one}{end}"]) for one in names] for column, end in parts.items()})


def halves(calibration: Calibration) -> list[Halves]:
    """Random halves of every set under every noise model that has them; those of the adjustment first."""
    platform, results = calibration.platform_file, calibration.results
    found = []
    if has_halves_beside(platform):
        beside = results.table("adjusted_splits", ADJUSTED_SPLITS)
        found += [_halves(ADJUSTMENT_MODEL.name, str(name), part) for name, part in beside.groupby("set", sort=False)]
    if has_own_halves(platform):
        name = ALL if is_adjusted(platform) else INLIERS
        found.append(_halves(calibration.noise_model, name, results.table("splits", SPLITS)))
    return found


def _halves(model: str, name: str, splits: pd.DataFrame) -> Halves:
    return Halves(model, name, known_distances(splits), sigma_factor(splits))


def estimates(calibration: Calibration) -> pd.DataFrame:
    """The pose of each set under the adjustment beside, then under the platform's own noise model.

    Columns `noise_model`, `set`, `n_observations`, and the pose with its sigmas.
    """
    columns = ["set", "n_observations", *POSE_COLUMNS, *SIGMA_COLUMNS]
    beside = calibration.results.table("adjustment", ADJUSTMENT)[columns].assign(noise_model=ADJUSTMENT_MODEL.name)
    poses = calibration.results.table("pose", POSE)
    stages = [name for name in (ALL, INLIERS) if (poses["stage"] == name).any()]
    own = pd.concat([stage_rows(poses, name, [], f"{calibration.name}/pose.parquet") for name in stages])
    own = own.rename(columns={"stage": "set"})[columns].assign(noise_model=calibration.noise_model)
    return pd.concat([beside, own], ignore_index=True)


def common_share(correlation_time_s: float, duration_s: float) -> float:
    """Share of a drift's variance that is common to a whole survey: that of its mean over the survey.

    Of a Gauss-Markov process of this correlation time; 1 where it outlasts the survey by far.
    """
    ratio = duration_s / correlation_time_s
    if ratio < 1e-3:
        return 1.0
    return float(2 / ratio**2 * (ratio + np.expm1(-ratio)))
