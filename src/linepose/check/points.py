"""What is known of points beside their measurements: whether it can be used, and where it lies."""

from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from linepose.adjustment.known_points import KnownPoints
from linepose.check.finding import Finding, error, of_fault, ok
from linepose.config.platform import Platform
from linepose.errors import InputError
from linepose.inputs.control_points import read_control_points
from linepose.inputs.source import ScansSection
from linepose.inputs.terrain import read_terrain
from linepose.pipeline.known_points import frame_of_points, known_of_platform, known_of_survey, names_remedy
from linepose.survey.navigation_log import NavigationLog
from linepose.survey.observations import survey_from_table

_SUBJECT: Final = "known points"
_APART: Final = 25  # poses of a log between those at which a height model is asked


def point_findings(
    settings: Platform, folder: Path, observations: pd.DataFrame
) -> tuple[list[Finding], KnownPoints | None]:
    """Findings on control points and ground, and what is known of the points; None where nothing is."""
    if not settings.knows_points:
        return [], None
    try:
        known = known_of_platform(settings, folder, observations)
    except InputError as fault:
        return [of_fault(_SUBJECT, fault)], None
    shared = sum(one.shared for one in known.values())
    found = f"something is known of {len(known)} points"
    if shared:
        found += f", of {shared} a height that errs in common"
    on_board = [one.board_sigma_m for one in known.values() if one.board_sigma_m is not None]
    if on_board:
        found += f", of {len(on_board)} the place on the target, to {1e3 * on_board[0]:g} mm"
    return [ok(_SUBJECT, found)], known_of_survey(known, survey_from_table(observations))


def file_findings(settings: Platform, folder: Path, log: NavigationLog | None) -> list[Finding]:
    """Findings on control points and ground where no points of the scans are known yet to hold them against."""
    by_log = settings.points is not None and settings.points.is_on_the_earth and settings.map_frame is None
    if log is None and by_log:  # the log's fault is told once
        return []
    findings = []
    for find in (_control_findings, _ground_findings):
        try:
            findings += find(settings, folder, log)
        except InputError as fault:
            findings.append(of_fault(_SUBJECT, fault))
    return findings


def _control_findings(settings: Platform, folder: Path, _: NavigationLog | None) -> list[Finding]:
    """How many control points there are, and whether the target has points of their names."""
    section = settings.points
    if section is None or section.control_points is None:
        return []
    path = folder / section.control_points
    known = read_control_points(path, section.crs, frame_of_points(settings, folder), section.height_offset_m)
    of_target = {str(name) for name in settings.target.ids()}
    detected = isinstance(settings.source, ScansSection) and settings.source.points == "detection"
    if detected and not of_target & set(known):
        found = f"{path}: points {', '.join(list(known)[:3])}, none of which is one of the {settings.target.kind}"
        return [error(_SUBJECT, found, names_remedy(settings))]
    return [ok(_SUBJECT, f"{path.name}: {len(known)} control points")]


def _ground_findings(settings: Platform, folder: Path, log: NavigationLog | None) -> list[Finding]:
    """Whether the ground lies below the flight, as far as it is told and the log could be read."""
    source, ground = settings.source, None if settings.points is None else settings.points.ground
    key, height_m = "points.ground", None
    if isinstance(source, ScansSection) and source.points == "matching":
        key, height_m = "source.matching.ground_height_m", source.matching.ground_height_m
    if height_m is None and ground is not None:
        key = "points.ground"
        height_m = None if ground.height_m is None else ground.height_m + ground.height_offset_m
        if ground.dem is not None:
            height_m = _model_height_m(settings, folder, log)
    elif ground is not None and ground.dem is not None:
        _model_height_m(settings, folder, log)
    if height_m is None or log is None:
        return []
    highest_m = -float(log.position_m[:, 2].min())
    if height_m < highest_m:
        return [ok(_SUBJECT, f"{key}: ground at {height_m:.1f} m, up to {highest_m - height_m:.1f} m below the flight")]
    found = f"{key}: ground at {height_m:.1f} m, above the whole log, whose highest pose is at {highest_m:.1f} m"
    return [error(_SUBJECT, found, f"correct {key} (m): it counts upwards, as the positions' heights do")]


def _model_height_m(settings: Platform, folder: Path, log: NavigationLog | None) -> float | None:
    """The median height of a height model below the log; None where there is no log. Raises InputError."""
    assert settings.points is not None
    assert settings.points.ground is not None
    ground, origin_m = settings.points.ground, np.zeros(3) if log is None else log.position_m[0]
    path = folder / (ground.dem or "")
    terrain = read_terrain(path, frame_of_points(settings, folder), origin_m, ground.height_offset_m)
    if log is None:
        return None
    below = log.position_m[::_APART, :2] - origin_m[:2]
    covered = terrain.covers(below)
    if not covered.any():
        north, east = log.position_m[0, :2]
        found = f"no height below the log, which begins near north {north:.1f}, east {east:.1f} m"
        raise InputError(str(path), found, "heights all over the survey", "give a larger model, or check map_frame")
    return float(np.median(-(terrain(below[covered])[0] + origin_m[2])))
