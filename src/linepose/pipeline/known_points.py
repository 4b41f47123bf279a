"""What is known of a platform's points, from its files: control points, the ground of all others, the target."""

import logging
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from linepose.adjustment.known_points import KnownPoints
from linepose.adjustment.measurements import Measurements, measurements_from_survey
from linepose.adjustment.start import start_points
from linepose.arrays import Floats
from linepose.config.platform import Platform
from linepose.config.points import GroundSection
from linepose.errors import InputError
from linepose.geometry import camera as cameras
from linepose.geometry import rotations
from linepose.inputs.control_points import read_control_points
from linepose.inputs.local_frame import LocalFrame
from linepose.inputs.source import ScansSection
from linepose.inputs.terrain import read_terrain
from linepose.pipeline.survey_frame import map_frame_table, survey_frame
from linepose.survey.observations import Survey, survey_from_table
from linepose.survey.point_knowledge import PointKnowledge, arrays_of, board_of
from linepose.survey.targets.base import GridSection, TargetSection

_SIGMAS: Final = 4.0  # by which control points may lie off where scans see them
_LEAST_M: Final = 2.0  # ... but no less than this
_COVERED: Final = 0.5  # of the points, below which a height model is not the survey's
_FEWEST: Final = 3  # control points that tell a shift in common, and points of a target that tell its pose
_DAMPING: Final = 1e-4
_ROUNDS: Final = 5

log = logging.getLogger(__name__)


def names_remedy(platform: Platform) -> str:
    """What to do with control points of other names than the points of the scans have."""
    source = platform.source
    if isinstance(source, ScansSection) and source.points == "detection":
        return f"give them the numbers of the {platform.target.kind}'s points"
    return "give them the names of the labels"


def names_of_points(survey: Survey) -> list[str]:
    """The names of a survey's points (M,)."""
    return [str(name) for name in survey.names]


def known_of_platform(platform: Platform, folder: Path, observations: pd.DataFrame) -> dict[str, PointKnowledge]:
    """The same from a table of observations and what the platform's file or its log says of its place on the Earth."""
    if not platform.knows_points:
        return {}
    return known_points(platform, folder, survey_from_table(observations), frame_of_points(platform, folder))


def frame_of_points(platform: Platform, folder: Path) -> LocalFrame | None:
    """Where the survey lies on the Earth, by the platform's file or its log; None where `points` does not ask for it.

    Raises InputError.
    """
    if platform.points is None or not platform.points.is_on_the_earth:
        return None
    section = None if platform.map_frame is None else platform.map_frame.model_dump()
    return survey_frame(section, map_frame_table(platform, folder) if section is None else pd.DataFrame())


def known_points(
    platform: Platform, folder: Path, survey: Survey, frame: LocalFrame | None
) -> dict[str, PointKnowledge]:
    """What is known of the points of a survey, by name; raises InputError for what cannot be used."""
    known: dict[str, PointKnowledge] = {} if platform.points is None else _placed(platform, folder, survey, frame)
    return _with_target(platform.target, survey, known)


def _with_target(target: TargetSection, survey: Survey, known: dict[str, PointKnowledge]) -> dict[str, PointKnowledge]:
    """The same with the target's geometry, where it was measured."""
    if not isinstance(target, GridSection) or not target.known:
        return known
    names = np.array(names_of_points(survey))
    seen = set(names[np.isfinite(survey.u_px).any(axis=0)])
    of_target = dict(zip(map(str, target.ids()), target.points(), strict=True))
    on_board = {name: place for name, place in of_target.items() if name in seen}
    if len(on_board) < _FEWEST:
        found = f"{len(on_board)} of its {len(of_target)} points in the scans"
        remedy = "give the labels the ids that `linepose target` prints, or leave target.known out"
        raise InputError("target.known", found, f"{_FEWEST} or more", remedy)
    nothing = PointKnowledge(np.zeros(3), np.zeros((3, 3)))
    return known | {
        name: replace(known.get(name, nothing), board_m=place, board_sigma_m=target.sigma_m)
        for name, place in on_board.items()
    }


def _placed(platform: Platform, folder: Path, survey: Survey, frame: LocalFrame | None) -> dict[str, PointKnowledge]:
    """What is known of where points lie in the world."""
    known: dict[str, PointKnowledge] = {}
    section = platform.points
    assert section is not None
    if section.control_points is not None:
        path = folder / section.control_points
        control = read_control_points(path, section.crs, frame, section.height_offset_m)
        seen = set(np.array(names_of_points(survey))[np.isfinite(survey.u_px).any(axis=0)])
        known = {name: one for name, one in control.items() if name in seen}
        if not known:
            found, expected = f"points {', '.join(list(control)[:3])}, ...", "points that the scans show"
            raise InputError(str(path), found, expected, names_remedy(platform))
        unseen = [name for name in control if name not in seen]
        if unseen:
            log.warning("%s: %d of %d points are in no scan: %s", path, len(unseen), len(control), unseen[:5])
        _check_place(platform, survey, known, path)
    if section.ground is not None:
        known = _ground(platform, folder, survey, frame, section.ground) | known
    return known


def known_of_survey(known: Mapping[str, PointKnowledge], survey: Survey) -> KnownPoints | None:
    """The same as the adjustment takes it; None where nothing is known."""
    if not known:
        return None
    names = names_of_points(survey)
    board_m, sigma_m = board_of(known, names)
    return KnownPoints(*arrays_of(known, names, survey.origin_m), board_m=board_m, board_sigma_m=sigma_m)


def _ground(
    platform: Platform, folder: Path, survey: Survey, frame: LocalFrame | None, ground: GroundSection
) -> dict[str, PointKnowledge]:
    """What the ground says of every point that is seen."""
    seen = np.flatnonzero(np.isfinite(survey.u_px).any(axis=0))
    names, shared = names_of_points(survey), ground.shift_sigma_m is not None
    if ground.height_m is not None:
        position = np.array([0.0, 0.0, -(ground.height_m + ground.height_offset_m)])
        information = np.diag([0.0, 0.0, ground.sigma_m**-2])
        return {names[k]: PointKnowledge(position, information, shared, ground.shift_sigma_m) for k in seen}
    path = folder / (ground.dem or "")
    terrain = read_terrain(path, frame, survey.origin_m, ground.height_offset_m)
    everywhere = KnownPoints(
        np.zeros((survey.n_points, 3)),
        np.zeros((survey.n_points, 3, 3)),
        surface=terrain,
        on_surface=np.asarray(np.isfinite(survey.u_px).any(axis=0)),
        surface_sigma_m=ground.sigma_m,
    )
    measurements = measurements_from_survey(survey, platform.camera, everywhere)
    start = start_points(measurements, platform.camera, platform.start_pose())
    covered = terrain.covers(start[:, :2])
    if covered.mean() < _COVERED:
        north, east = start[int(np.argmin(covered)), :2] + survey.origin_m[:2]
        raise InputError(
            str(path),
            f"no height for {np.sum(~covered)} of {len(covered)} points, one near north {north:.1f}, east {east:.1f} m",
            "heights all over the survey",
            "give a larger model, or check map_frame",
        )
    if not covered.all():
        log.warning("%s: no height for %d of %d points: they count without", path, np.sum(~covered), len(covered))
    position, information = measurements.known.at(start)
    return {
        names[measurements.points[k]]: PointKnowledge(
            position[k] + survey.origin_m, information[k], shared, ground.shift_sigma_m
        )
        for k in np.flatnonzero(covered)
    }


def _check_place(platform: Platform, survey: Survey, known: Mapping[str, PointKnowledge], path: Path) -> None:
    """Raise InputError where control points as a whole are not where scans see them at the hand-measured pose."""
    arrays = KnownPoints(*arrays_of(known, names_of_points(survey), survey.origin_m))
    measurements = measurements_from_survey(survey, platform.camera, arrays)
    full = np.linalg.matrix_rank(measurements.known.information) == 3
    rows = full[measurements.point]
    if full.sum() < _FEWEST:
        return
    shift, range_m = _common_shift(platform, measurements, rows)
    by_hand = platform.hand_measured
    allowed = _SIGMAS * (range_m * np.deg2rad(by_hand.sigma_rotation_deg) + by_hand.sigma_position_m)
    allowed_m = max(_LEAST_M, float(allowed)) * np.array([1.0, 1.0, 4.0])  # rays tell heights least
    if np.any(np.abs(shift) > allowed_m):
        north, east, down = shift
        raise InputError(
            str(path),
            f"points {north:.1f} m north, {east:.1f} m east, {down:.1f} m down of where the scans see them",
            f"within {allowed_m[0]:.1f} m and {allowed_m[2]:.1f} m in height",
            "correct points.crs, its datum, or height_offset_m",
        )


def _common_shift(platform: Platform, measurements: Measurements, rows: np.ndarray) -> tuple[Floats, float]:
    """How far known points lie off their rays in common (3,) (m), robustly, and the median range (m)."""
    pose = platform.start_pose()
    body = rotations.matrix_from_euler(measurements.body_pose[rows, 3:])
    centre, direction = cameras.rays(
        platform.camera,
        rotations.matrix_from_rotation_vector(pose[3:]),
        pose[:3],
        body,
        measurements.body_pose[rows, :3],
        measurements.u_px[rows],
    )
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    off = measurements.known.position_m[measurements.point[rows]] - centre
    across = np.eye(3) - direction[:, :, None] * direction[:, None, :]
    miss, weight, shift = np.einsum("lij,lj->li", across, off), np.ones(len(off)), np.zeros(3)
    for _ in range(_ROUNDS):
        normal = np.einsum("l,lij->ij", weight, across) + _DAMPING * len(off) * np.eye(3)
        shift = np.linalg.solve(normal, weight @ miss)
        left = np.linalg.norm(np.einsum("lij,lj->li", across, off - shift), axis=1)
        weight = 1 / np.maximum(left, max(float(np.median(left)), 1e-6))
        weight /= weight.max()
    return shift, float(np.median(np.abs(centre[:, 2] - np.median(centre[:, 2] + off[:, 2]))))
