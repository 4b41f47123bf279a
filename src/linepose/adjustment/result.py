"""What the adjustment finds."""

import math
from dataclasses import dataclass, field

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from linepose.adjustment.board_fit import BoardFit
from linepose.adjustment.draws_in_words import draws_in_words
from linepose.adjustment.levels import Levels
from linepose.adjustment.thresholds import (
    DISAGREEMENT_SIGMAS,
    TRUSTED_EIGENVALUE,
)
from linepose.arrays import Floats

_NAMED = 5  # contradictions in warnings


@dataclass(frozen=True)
class Contradiction:
    """A known point by its name, how many sigmas it is off what all else says, and the weight that it was given."""

    point: str
    sigmas: float
    weight: float


@dataclass(frozen=True)
class Quality:
    """What tells whether the result can be trusted.

    converged: chi squared and levels, and not where no tape measure can have been; least_eigenvalue: of the curvature
    in units of the normal equations, NaN where it could not be had; effective_draws, pareto_shape: of the draws of the
    levels; disagreement_sigmas (6,): of the hand measurement from what the data alone say, NaN without one;
    open_directions: names of the pose's parameters that the data leave to the hand measurement; drift_known: whether
    there are times; clock_known: whether the data tell the clock offset, where it is sought; contradictions: known
    points that the rest contradicts, the worst first; board: how a board's known geometry fits, None without one.
    """

    converged: bool
    least_eigenvalue: float
    effective_draws: float
    pareto_shape: float
    disagreement_sigmas: Floats
    open_directions: tuple[str, ...]
    drift_known: bool
    clock_known: bool
    contradictions: tuple[Contradiction, ...] = field(default=(), kw_only=True)
    board: BoardFit | None = field(default=None, kw_only=True)


@dataclass(frozen=True)
class Diagnostics(Quality):
    """Whether the result can be trusted, and what it took.

    n_rounds: of chi squared and levels in turn; n_passes: evaluations of the levels' density; chi_squared and
    degrees_of_freedom of the measurements; heavy_tails: whether the data asked for weights; warnings: one line each.
    """

    n_rounds: int
    n_passes: int
    chi_squared: float
    degrees_of_freedom: int
    heavy_tails: bool
    warnings: tuple[str, ...]

    @property
    def reduced_chi_squared(self) -> float:
        """Chi squared over its degrees of freedom, of which it has at least one."""
        return self.chi_squared / max(self.degrees_of_freedom, 1)


@dataclass(frozen=True)
class Adjustment:
    """The estimated pose, how sure it is, and what the errors were; N observations of M points, as in the survey.

    pose (6,): at the mode, with a rotation vector; covariance (6, 6): the posterior's, of the pose's parameters;
    principal_point_px, focal_length_m, and coefficients of the lens that were estimated, by name; intrinsics_covariance
    (I, I): of all these in this order, and pose_by_intrinsics (6, I): how the estimate of position (m) and small turn
    about body axes (rad) follows them, at the levels' mode; points_m (M, 3): from the survey's origin, NaN for a point
    left out; point_covariance (M, 3, 3): at the levels' mode, NaN where it is not known; levels: at their mode;
    level_intervals (7, 2): what holds each with 95 %, NaN for one that was not estimated; corrections (N, M, 6): of the
    reported body poses (m, rad); constants (N, 6), drifts (N, M, 6): of the process, in its own units; view_weight
    (N,), measurement_weight (N, M): 1 is as good as the levels say, towards 0 is bad; normalised (N, M, 2): whitened
    residuals along and across the line, each a standard normal number if the model is right; samples: independent draws
    of the pose, and of the clock offset if it is estimated, in the columns of a chain (walker, step, pose,
    log_likelihood); clock_offset_s: what is added to the scan's time stamps to get the navigation's time, positive if
    the stamps are too early, and clock_offset_sigma_s: the posterior's, both NaN where it was not estimated. Everything
    of a measurement is NaN where there is none. known_weight, known_sigmas (M,): of each known point, one unless it
    contradicts the rest, and how many sigmas it is off them, NaN where nothing of its own is known; common_shift_m,
    common_shift_sigma_m: how far the ground lies below the heights that err in common, NaN where none are given.
    """

    pose: Floats
    covariance: Floats
    principal_point_px: float
    focal_length_m: float
    coefficients: dict[str, float]
    intrinsics_covariance: Floats
    pose_by_intrinsics: Floats
    points_m: Floats
    point_covariance: Floats
    levels: Levels
    level_intervals: Floats
    corrections: Floats
    constants: Floats
    drifts: Floats
    view_weight: Floats
    measurement_weight: Floats
    normalised: Floats
    samples: pd.DataFrame
    diagnostics: Diagnostics
    clock_offset_s: float = math.nan
    clock_offset_sigma_s: float = math.nan
    known_weight: Floats = field(default_factory=lambda: np.full(0, np.nan))
    known_sigmas: Floats = field(default_factory=lambda: np.full(0, np.nan))
    common_shift_m: float = math.nan
    common_shift_sigma_m: float = math.nan

    @property
    def sigma(self) -> Floats:
        """One standard deviation of each of the pose's parameters (6,)."""
        return np.sqrt(np.diag(self.covariance))


def gridded(values: Floats, row: NDArray[np.int64], column: NDArray[np.int64], shape: tuple[int, int]) -> Floats:
    """Values (L, ...) of measurements on the survey's grid (N, M, ...), NaN where there is none."""
    grid = np.full((*shape, *values.shape[1:]), np.nan)
    grid[row, column] = values
    return grid


def weighted_quantiles(values: Floats, weight: Floats, shares: tuple[float, ...]) -> Floats:
    """Quantiles (Q,) of weighted values (D,)."""
    order = np.argsort(values, kind="stable")
    cumulated = (np.cumsum(weight[order]) - 0.5 * weight[order]) / np.sum(weight)
    return np.interp(shares, cumulated, values[order])


def warnings_of(quality: Quality) -> tuple[str, ...]:
    """What a user should be told, one line each."""
    said = []
    if not quality.converged:
        said.append(
            "the adjustment has not converged, or not to where a tape measure can have been: check the hand "
            "measurement, and let it count as a prior"
        )
    if not quality.least_eigenvalue >= TRUSTED_EIGENVALUE:
        said.append(
            f"chi squared curves {quality.least_eigenvalue:.2f} of what the normal equations say in one direction, "
            f"expected {TRUSTED_EIGENVALUE} or more: do not trust the sigmas; add observations"
        )
    draws = draws_in_words(quality.effective_draws, quality.pareto_shape)
    if draws.advice:
        said.append(f"draws of the levels are {draws.found}. {draws.advice.removesuffix('.')}")
    if np.any(np.abs(quality.disagreement_sigmas) > DISAGREEMENT_SIGMAS):
        said.append(
            f"data and hand measurement disagree by {np.nanmax(np.abs(quality.disagreement_sigmas)):.1f} sigmas: "
            "check the hand measurement and its sigmas"
        )
    said.extend(
        f"what is known of point {one.point} is {one.sigmas:.1f} sigmas off what all else says, and counts "
        f"{one.weight:.2g} of what is stated: correct its coordinates, its sigmas or its label"
        for one in quality.contradictions[:_NAMED]
    )
    if quality.board is not None and not quality.board.counts:
        said.append(": ".join(quality.board.in_words()))
    if quality.board is not None and np.isnan(quality.board.misfit_sigmas):
        said.append("only the target's known geometry makes an estimate possible: nothing can contradict it")
    if quality.open_directions:
        said.append(f"the data leave {', '.join(quality.open_directions)} to the hand measurement: add other motions")
    if not quality.clock_known:
        said.append("the data leave the clock offset to its prior: add views at other speeds or the other way")
    if not quality.drift_known:
        said.append("without times drift of the navigation is not known and not allowed for")
    return tuple(said)
