"""The adjustment of a survey, from its observations to the posterior of the camera's pose."""

from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from linepose import rotations
from linepose.adjustment.curvature import Curvature, curvature
from linepose.adjustment.estimate import Estimate
from linepose.adjustment.hand_measured import HandMeasured, hand_measured
from linepose.adjustment.heavy_tailed import with_tails
from linepose.adjustment.levels import N_LEVELS
from linepose.adjustment.measurements import KnownPoints, Measurements, measurements_from_survey
from linepose.adjustment.normal import N_POSE
from linepose.adjustment.posterior import Mixture, mixture
from linepose.adjustment.process import Weights
from linepose.adjustment.residuals import normalised_residuals
from linepose.adjustment.result import Adjustment, Diagnostics, Quality, gridded, warnings_of, weighted_quantiles
from linepose.adjustment.settings import Settings, default_hand_covariance
from linepose.adjustment.start import start_points
from linepose.adjustment.state import Knowledge, State, state_at
from linepose.camera import Camera
from linepose.errors import InputError
from linepose.observations import Survey
from linepose.pose import POSE_COLUMNS, check_pose
from linepose.rotations import Floats

_OPEN_SHARE: Final = 0.9  # of the hand measurement's sigma, above which the data have said nothing
_INTERVAL: Final = (0.025, 0.975)


def adjust(
    survey: Survey,
    camera: Camera,
    hand_measured_pose: ArrayLike,
    hand_covariance: ArrayLike | None = None,
    settings: Settings | None = None,
    known_points: KnownPoints | None = None,
) -> Adjustment:
    """The camera's pose with its posterior, from a hand-measured pose (6,), which is start and prior.

    hand_covariance (6, 6): of its position (m) and turn about body axes (rad); 0.1 m and 2 deg if None. Raises
    InputError for observations, covariances or sigmas of the camera that are of no use, EstimationError where no start
    leads to an estimate.
    """
    settings = settings or Settings()
    pose = check_pose(hand_measured_pose, "hand-measured pose")
    _check_camera(camera)
    hand = hand_measured(
        pose, np.asarray(default_hand_covariance() if hand_covariance is None else hand_covariance, dtype=float)
    )
    measurements = measurements_from_survey(survey, camera, known_points, settings.line_period_s)
    if measurements.n_views < 2:
        raise InputError("observations", "one observation", "two or more", "add observations of the same pattern")
    knowledge = Knowledge(camera, hand if settings.hand_measured_prior else None)
    start = state_at(pose, camera, start_points(measurements, camera, pose), len(measurements.u_px))
    found = with_tails(measurements, knowledge, Knowledge(camera, hand), start, settings)
    return _result(survey, measurements, knowledge, found, settings)


def _result(
    survey: Survey,
    measurements: Measurements,
    knowledge: Knowledge,
    found: Estimate,
    settings: Settings,
) -> Adjustment:
    weights = found.weights
    curved = curvature(measurements, knowledge, found.solution, found.levels, weights)
    spread = mixture(found.restricted, found.log_levels, curved.stretch, settings.n_draws, settings.seed)
    state = found.solution.state
    _, step_covariance = spread.moments()
    by_parameters = np.eye(N_POSE)
    by_parameters[3:, 3:] = np.linalg.inv(rotations.small_rotation_by_rotation_vector(state.pose[3:]))
    grid = measurements.row, measurements.column, survey.u_px.shape
    points = np.full((survey.n_points, 3), np.nan)
    points[measurements.points] = state.points_m
    rows = np.searchsorted(survey.number, measurements.number, sorter=np.argsort(survey.number))
    view_rows = np.argsort(survey.number)[rows]
    constants, view_weight = np.full((survey.n_observations, N_POSE), np.nan), np.full(survey.n_observations, np.nan)
    constants[view_rows], view_weight[view_rows] = found.solution.q, weights.of_view
    return Adjustment(
        pose=state.pose,
        covariance=by_parameters @ step_covariance @ by_parameters.T,
        principal_point_px=state.principal_point_px,
        focal_length_m=state.focal_length_m,
        points_m=points,
        levels=found.levels,
        level_intervals=_intervals(found, spread),
        corrections=gridded(state.correction, *grid),
        constants=constants,
        drifts=gridded(found.solution.z, *grid),
        view_weight=view_weight,
        measurement_weight=gridded(weights.of_measurement, *grid),
        normalised=gridded(normalised_residuals(found.solution.done), *grid),
        samples=_samples(state, spread, settings),
        diagnostics=_diagnostics(measurements, knowledge, found, curved, spread, step_covariance, weights),
    )


def _samples(state: State, spread: Mixture, settings: Settings) -> pd.DataFrame:
    """Independent draws in a chain's columns: each its own walker of one step; log_likelihood is of its levels."""
    random = np.random.default_rng([settings.seed, 1])
    steps, component = spread.draw(random, settings.n_samples)
    poses = stepped(state, steps)
    return pd.DataFrame(
        {
            "walker": np.arange(len(steps), dtype=np.int64),
            "step": np.zeros(len(steps), dtype=np.int64),
            **{name: poses[:, i] for i, name in enumerate(POSE_COLUMNS)},
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
    found: Estimate,
    curved: Curvature,
    spread: Mixture,
    covariance: Floats,
    weights: Weights,
) -> Diagnostics:
    disagreement = np.full(N_POSE, np.nan)
    open_directions: tuple[str, ...] = ()
    if knowledge.hand is not None:
        disagreement, open_directions = _beside_hand(knowledge.hand, found.solution.state, covariance)
    quality = Quality(
        converged=found.converged,
        least_eigenvalue=curved.least_eigenvalue,
        effective_draws=spread.effective_size,
        pareto_shape=spread.pareto_shape,
        disagreement_sigmas=disagreement,
        open_directions=open_directions,
        drift_known=measurements.timed,
    )
    return Diagnostics(
        **vars(quality),
        n_rounds=found.n_rounds,
        n_passes=found.n_passes,
        chi_squared=found.solution.done.chi_squared,
        degrees_of_freedom=2 * len(measurements.u_px) - 3 * measurements.n_points - N_POSE,
        heavy_tails=bool(np.any(weights.of_view != 1) or np.any(weights.of_measurement != 1)),
        warnings=warnings_of(quality),
    )


def _beside_hand(hand: HandMeasured, state: State, covariance: Floats) -> tuple[Floats, tuple[str, ...]]:
    """How many sigmas the hand measurement is off what the data say alone (6,), and what the data leave to it."""
    hand_matrix = rotations.matrix_from_rotation_vector(hand.pose[3:])
    turn = rotations.rotation_vector_from_matrix(hand_matrix @ state.rotation.T)
    error = np.concatenate([hand.pose[:3] - state.position_m, turn])
    prior, posterior = np.diag(hand.covariance), np.diag(covariance)
    left = np.maximum(prior - posterior, 0.01 * prior)
    open_ = tuple(
        name for name, share in zip(POSE_COLUMNS, np.sqrt(posterior / prior), strict=True) if share > _OPEN_SHARE
    )
    return error / np.sqrt(left), open_


def _check_camera(camera: Camera) -> None:
    sigmas = {
        "u_px": camera.sigmas.u_px,
        "principal_point_px": camera.sigmas.principal_point_px,
        "focal_length_m": camera.sigmas.focal_length_m,
    }
    for name, value in sigmas.items():
        if not (np.isfinite(value) and value > 0):
            raise InputError(f"camera.sigmas.{name}", f"{value}", "a positive number", "give how well it is known")
