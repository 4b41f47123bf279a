"""The result of an adjustment, put together on the survey's grid."""

from typing import Final

import numpy as np
import pandas as pd

from linepose.adjustment.all_at_once import AllAtOnce
from linepose.adjustment.board_fit import BoardFit
from linepose.adjustment.estimate import Estimate
from linepose.adjustment.hand_measured import HandMeasuredPrior
from linepose.adjustment.known_board import N_BOARD_POSE
from linepose.adjustment.levels import N_LEVELS
from linepose.adjustment.measurements import Measurements
from linepose.adjustment.normal import COMMON_SHIFT, N_POSE
from linepose.adjustment.posterior import Mixture
from linepose.adjustment.result import (
    Adjustment,
    Contradiction,
    Diagnostics,
    Quality,
    gridded,
    warnings_of,
    weighted_quantiles,
)
from linepose.adjustment.settings import AdjustmentSettings
from linepose.adjustment.state import Knowledge, State
from linepose.adjustment.thresholds import OPEN_SHARE
from linepose.arrays import Floats
from linepose.geometry import rotations
from linepose.geometry.pose import POSE_COLUMNS, TURN_WORDS
from linepose.survey.observations import Survey

CLOCK_OFFSET_COLUMN: Final = "clock_offset_s"  # of the samples, where it is estimated
_INTERVAL: Final = (0.025, 0.975)

_DIRECTIONS: Final = (*POSE_COLUMNS[:3], *TURN_WORDS.values())  # of a small step of the pose


def assembled(
    survey: Survey,
    measurements: Measurements,
    knowledge: Knowledge,
    done: AllAtOnce,
    settings: AdjustmentSettings,
    board: BoardFit | None = None,
) -> Adjustment:
    """The result on the survey's grid, from the fit of all measurements and what tells its levels and its spread.

    board: what the known geometry of a board is worth, if there is one.
    """
    fit, found, spread = done.fit, done.found, done.spread
    state, weights = fit.state, fit.weights
    _, sought_covariance = spread.moments()
    step_covariance = sought_covariance[-N_POSE:, -N_POSE:]
    clock_offset_s = clock_sigma_s = np.nan
    if knowledge.clock_offset_sigma_s is not None:
        clock_offset_s, clock_sigma_s = state.clock_offset_s, float(np.sqrt(sought_covariance[0, 0]))
    grid = measurements.row, measurements.column, survey.u_px.shape
    points = np.full((survey.n_points, 3), np.nan)
    points[measurements.points] = state.points_m
    point_covariance = np.full((survey.n_points, 3, 3), np.nan)
    point_covariance[measurements.points] = fit.point_covariance
    known = np.full((2, survey.n_points), np.nan)
    known[:, measurements.points] = done.known.weight, done.known.sigmas
    shifted = bool(np.any(state.shifts))
    of_intrinsics = fit.camera_covariance[:COMMON_SHIFT, :COMMON_SHIFT]
    by_intrinsics = np.linalg.solve(of_intrinsics, fit.camera_covariance[:COMMON_SHIFT, -N_POSE:]).T
    view_rows = np.empty(measurements.n_views, dtype=np.int64)
    view_rows[measurements.view] = measurements.row
    constants, view_weight = np.full((survey.n_observations, N_POSE), np.nan), np.full(survey.n_observations, np.nan)
    constants[view_rows], view_weight[view_rows] = fit.q, weights.of_view
    return Adjustment(
        pose=state.pose,
        covariance=pose_covariance(state, spread),
        principal_point_px=state.principal_point_px,
        focal_length_m=state.focal_length_m,
        coefficients={name: float(getattr(state.lens, name)) for name in state.sought},
        intrinsics_covariance=of_intrinsics,
        pose_by_intrinsics=np.asarray(by_intrinsics, dtype=float),
        points_m=points,
        point_covariance=point_covariance,
        levels=found.levels,
        level_intervals=_intervals(found, spread),
        corrections=gridded(state.correction, *grid),
        constants=constants,
        drifts=gridded(fit.z, *grid),
        view_weight=view_weight,
        measurement_weight=gridded(weights.of_measurement, *grid),
        normalised=gridded(fit.normalised, *grid),
        samples=_samples(state, spread, settings),
        diagnostics=_diagnostics(measurements, knowledge, done, step_covariance, clock_sigma_s, survey.names, board),
        known_weight=known[0],
        known_sigmas=known[1],
        common_shift_m=state.common_shift_m if shifted else np.nan,
        common_shift_sigma_m=float(np.sqrt(fit.camera_covariance[COMMON_SHIFT, COMMON_SHIFT])) if shifted else np.nan,
        clock_offset_s=clock_offset_s,
        clock_offset_sigma_s=clock_sigma_s,
    )


def pose_covariance(state: State, spread: Mixture) -> Floats:
    """Covariance (6, 6) of the pose's parameters at a state."""
    by_parameters = np.eye(N_POSE)
    by_parameters[3:, 3:] = np.linalg.inv(rotations.left_jacobian_so3(state.pose[3:]))
    return np.asarray(by_parameters @ spread.moments()[1][-N_POSE:, -N_POSE:] @ by_parameters.T)


def _samples(state: State, spread: Mixture, settings: AdjustmentSettings) -> pd.DataFrame:
    """Independent draws in a chain's columns: each its own walker of one step; log_likelihood is of its levels."""
    random = np.random.default_rng([settings.seed, 1])
    steps, component = spread.draw(random, settings.n_samples)
    poses = stepped(state, steps[:, -N_POSE:])
    return pd.DataFrame(
        {
            "walker": np.arange(len(steps), dtype=np.int64),
            "step": np.zeros(len(steps), dtype=np.int64),
            **{name: poses[:, i] for i, name in enumerate(POSE_COLUMNS)},
            **({CLOCK_OFFSET_COLUMN: state.clock_offset_s + steps[:, 0]} if steps.shape[1] > N_POSE else {}),
            "log_likelihood": -spread.negative_log_density[component],
        }
    )


def stepped(state: State, steps: Floats) -> Floats:
    """Poses (S, 6), with rotation vectors, at steps (S, 6) of position and small rotation from a state."""
    turned = rotations.matrix_from_rotation_vector(steps[:, 3:]) @ state.rotation
    return np.concatenate([state.position_m + steps[:, :3], rotations.rotation_vector_from_matrix(turned)], axis=1)


def _intervals(found: Estimate, spread: Mixture) -> Floats:
    intervals = np.full((N_LEVELS, 2), np.nan)
    for i in found.restricted.free:
        intervals[i] = np.exp(weighted_quantiles(spread.log_levels[:, i], spread.weight, _INTERVAL))
    return intervals


def _diagnostics(
    measurements: Measurements,
    knowledge: Knowledge,
    done: AllAtOnce,
    covariance: Floats,
    clock_sigma_s: float,
    names: np.ndarray,
    board: BoardFit | None,
) -> Diagnostics:
    fit, found, curved, spread = done.fit, done.found, done.curved, done.spread
    disagreement = np.full(N_POSE, np.nan)
    open_directions: tuple[str, ...] = ()
    if knowledge.hand is not None:
        disagreement, open_directions = _beside_hand(knowledge.hand, fit.state, covariance)
    quality = Quality(
        converged=fit.converged,
        least_eigenvalue=curved.least_eigenvalue,
        effective_draws=spread.effective_size,
        pareto_shape=spread.pareto_shape,
        disagreement_sigmas=disagreement,
        open_directions=open_directions,
        drift_known=measurements.timed,
        contradictions=tuple(
            Contradiction(
                str(names[measurements.points[row]]), float(done.known.sigmas[row]), float(done.known.weight[row])
            )
            for row in done.known.contradicting
        ),
        board=board,
        clock_known=not clock_sigma_s > OPEN_SHARE * (knowledge.clock_offset_sigma_s or np.inf),
    )
    return Diagnostics(
        **vars(quality),
        n_rounds=found.n_rounds,
        n_passes=found.n_passes,
        chi_squared=fit.chi_squared,
        degrees_of_freedom=_degrees_of_freedom(measurements, knowledge),
        heavy_tails=bool(np.any(fit.weights.of_view != 1) or np.any(fit.weights.of_measurement != 1)),
        warnings=warnings_of(quality),
    )


def _degrees_of_freedom(measurements: Measurements, knowledge: Knowledge) -> int:
    """Equations less unknowns; a parameter of which something is known beforehand has an equation of its own."""
    unknown = 3 * measurements.n_points + (0 if knowledge.hand is not None else N_POSE)
    known = int(np.linalg.matrix_rank(measurements.known.information).sum() + measurements.known.on_surface.sum())
    known += max(3 * int(measurements.known.on_board.sum()) - N_BOARD_POSE, 0)
    return 2 * len(measurements.u_px) - unknown + known


def _beside_hand(hand: HandMeasuredPrior, state: State, covariance: Floats) -> tuple[Floats, tuple[str, ...]]:
    """How many sigmas the hand measurement is off what the data alone say (6,), and what the data leave to it.

    Where they leave it to the hand measurement, how many sigmas of it the estimate is off.
    """
    hand_matrix = rotations.matrix_from_rotation_vector(hand.pose[3:])
    turn = rotations.rotation_vector_from_matrix(hand_matrix @ state.rotation.T)
    error = np.concatenate([hand.pose[:3] - state.position_m, turn])
    prior, posterior = np.diag(hand.covariance), np.diag(covariance)
    is_open = posterior > OPEN_SHARE**2 * prior
    variance = np.where(is_open, prior, prior - posterior)
    return error / np.sqrt(variance), tuple(name for name, one in zip(_DIRECTIONS, is_open, strict=True) if one)
