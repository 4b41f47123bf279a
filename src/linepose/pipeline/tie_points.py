"""Tie points without labels: strips rectified at the pose at hand, matched, adjusted, and so again."""

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from linepose.adjustment.at_levels import PoseAtLevels, pose_at_levels
from linepose.arrays import Floats
from linepose.config.platform import Platform
from linepose.errors import EstimationError, InputError
from linepose.geometry.camera import Camera
from linepose.inputs.navigation import log_covariances, read_navigation
from linepose.inputs.observed_points import scan_points, select_scans
from linepose.inputs.rectified.rectify import Rectified, line_poses, rectify
from linepose.inputs.rectified.surface import flat_ground
from linepose.inputs.scans.line_times import line_times_of
from linepose.inputs.scans.scan_files import Scan, read_scan
from linepose.inputs.source import ScansSection
from linepose.inputs.tie_points.features import Features, features_of
from linepose.inputs.tie_points.pairs import Matches, matches_of
from linepose.inputs.tie_points.settings import MatchingSection
from linepose.inputs.tie_points.tracks import thinned, tracks_of
from linepose.pipeline.ground_height import ground_down_m
from linepose.survey.navigation import NavigationCovariances, associate_covariances
from linepose.survey.navigation_log import POSE_AT, NavigationLog, associate_poses
from linepose.survey.observations import EULER_COLUMNS, POSITION_COLUMNS, Survey, survey_from_table

_SIGMAS: Final = 3.0  # of the pose at hand, within which matches are sought
_DRIFT_M: Final = 0.3  # by which strips may be apart besides, since navigation errs
_OFF_LEVEL: Final = 0.5  # by which rays of two strips differ across: what relief makes maps differ by
_FEWEST_POINTS: Final = 10
_WRONG_WEIGHT: Final = 0.2  # below which the adjustment takes a measurement for wrong: five sigmas off

log = logging.getLogger(__name__)


@dataclass(frozen=True)
class MatchedStrip:
    """One strip: its observation number, its scan, and the body's pose at each line (L, 3) twice, from the origin."""

    number: int
    scan: Scan
    position_m: Floats
    euler_rad: Floats


@dataclass(frozen=True)
class _Hand:
    """What is at hand: pose (6,), the ground's down (m), and how far maps of two strips may be apart (m)."""

    pose: Floats
    down_m: float
    search_m: float


def matched_points(platform: Platform, folder: Path) -> pd.DataFrame:
    """Tie points of all strips of a platform; columns as in `SCAN_POINTS`.

    Raises InputError where strips do not overlap, their ground tells nothing apart, or it is not where it is said.
    """
    source = platform.source
    assert isinstance(source, ScansSection)
    settings = source.matching
    corrections = platform.navigation.corrections
    record = read_navigation(source, folder, corrections)
    reported = log_covariances(record, source, platform.navigation.covariance_columns, folder, corrections)
    origin_m = record.log.position_m[0]
    strips = read_strips(platform, folder, record.log, origin_m)
    hand = _by_hand(platform, strips, ground_down_m(platform, folder, [one.position_m for one in strips], origin_m))
    points = pd.DataFrame()
    for number in range(settings.rounds):
        cell_m = _cell_m(platform.camera, strips, hand, settings) * 2 ** (settings.rounds - 1 - number)
        points = _points_of_round(strips, platform.camera, hand, settings, cell_m, folder / source.scans)
        survey = _survey(points, platform, record.log, reported)
        adjusted = _adjusted(survey, platform)
        hand = _at_hand(hand, survey, adjusted, settings, origin_m[2])
    return _without_wrong(points, survey, adjusted)


def read_strips(platform: Platform, folder: Path, log_of_body: NavigationLog, origin_m: Floats) -> list[MatchedStrip]:
    """Every scan of a platform with the body's pose at each line; raises InputError where the log has no pose."""
    source, navigation, strips = platform.source, platform.navigation, []
    assert isinstance(source, ScansSection)
    line_times = line_times_of(source)
    for number, path in select_scans(folder, source.scans, source.left_out).items():
        scan = read_scan(path, line_times, platform.camera.n_pixels)
        lines = pd.DataFrame({"observation": number, "point": "none, but a line", "time_us": scan.time_us})
        lines = associate_poses(lines, log_of_body, POSE_AT[navigation.association], navigation.maximum_pose_gap_s)
        position = lines[list(POSITION_COLUMNS)].to_numpy() - origin_m
        strips.append(MatchedStrip(number, scan, position, lines[list(EULER_COLUMNS)].to_numpy()))
    return strips


def _by_hand(platform: Platform, strips: Sequence[MatchedStrip], down_m: float) -> _Hand:
    """What is at hand before anything is matched; raises InputError where the ground lies above a strip."""
    range_m = np.array([down_m - np.median(one.position_m[:, 2]) for one in strips])
    if range_m.min() <= 0:
        worst = strips[int(range_m.argmin())]
        raise InputError(
            f"source.matching.ground_height_m: scan {worst.number}",
            f"a flight {-range_m.min():.1f} m below the ground",
            "ground below every strip",
            "correct it (m), or points.ground: it counts upwards, as the positions' heights do",
        )
    by_hand, source = platform.hand_measured, platform.source
    assert isinstance(source, ScansSection)
    sigma_m = range_m.max() * np.deg2rad(by_hand.sigma_rotation_deg) + by_hand.sigma_position_m
    search_m = _SIGMAS * np.sqrt(2) * sigma_m + _OFF_LEVEL * source.matching.relief_m + _DRIFT_M
    return _Hand(platform.start_pose(), down_m, float(search_m))


def _cell_m(camera: Camera, strips: Sequence[MatchedStrip], hand: _Hand, settings: MatchingSection) -> float:
    """The cell of the last round's maps: by default what a pixel of a strip of middling height sees."""
    range_m = float(np.median([hand.down_m - np.median(one.position_m[:, 2]) for one in strips]))
    return settings.cell_m or range_m / camera.focal_length_px


def _points_of_round(
    strips: Sequence[MatchedStrip],
    camera: Camera,
    hand: _Hand,
    settings: MatchingSection,
    cell_m: float,
    place: Path,
) -> pd.DataFrame:
    """Matched and thinned points; columns as in `SCAN_POINTS`."""
    features = []
    extents = []
    for one in strips:
        poses = line_poses(one.position_m, one.euler_rad, hand.pose)
        rectified = rectify(one.scan.intensity, poses, camera, flat_ground(hand.down_m), cell_m)
        features.append(features_of(rectified, settings.n_features))
        extents.append(_extent(rectified))
    relief_m = _OFF_LEVEL * settings.relief_m
    matches: dict[tuple[int, int], Matches] = {}
    beside = [pair for pair in combinations(range(len(strips)), 2) if _overlap(*(extents[k] for k in pair))]
    if not beside:
        raise InputError(str(place), "strips that do not overlap", "ground that two strips show", "fly them closer")
    for first, second in beside:
        found = matches_of(features[first], features[second], hand.search_m, settings.ratio, relief_m, cell_m)
        matches[first, second] = found
    _check_matched(strips, matches, features, place)
    tracks = tracks_of(features, matches)
    kept = thinned(tracks, features, settings.n_points)
    log.info(
        "%d pairs of strips, %d matches of %d that look alike; %d points, of which %d are in two places of a strip and "
        "left out, %d kept",
        len(beside),
        sum(len(one.rows) for one in matches.values()),
        sum(one.n_alike for one in matches.values()),
        tracks.n_points + tracks.n_contradicted,
        tracks.n_contradicted,
        kept.n_points,
    )
    tables = []
    for k, one in enumerate(strips):
        mine = kept.strip == k
        rows = kept.row[mine]
        position = np.column_stack([features[k].u_px[rows], features[k].line[rows]])
        tables.append(scan_points(one.number, one.scan, kept.point[mine], position))
    return pd.concat(tables, ignore_index=True)


def _check_matched(
    strips: Sequence[MatchedStrip],
    matches: Mapping[tuple[int, int], Matches],
    features: Sequence[Features],
    place: Path,
) -> None:
    """Raise InputError where there are no points; a strip without any match is told in the log."""
    n_matches, n_alike = sum(len(one.rows) for one in matches.values()), sum(one.n_alike for one in matches.values())
    if n_matches < _FEWEST_POINTS:
        n_features = sum(len(one) for one in features)
        raise InputError(
            str(place),
            f"{n_matches} matches between {len(matches)} pairs of strips ({n_features} features, {n_alike} look alike)",
            f"at least {_FEWEST_POINTS}: ground with a texture that does not repeat, where hand_measured says",
            "correct hand_measured and source.matching.ground_height_m, or label points (source.points: labels)",
        )
    matched = {k for pair, one in matches.items() if len(one.rows) for k in pair}
    for k in sorted(set(range(len(strips))) - matched):
        log.warning("scan %d: no match with any other strip: left out", strips[k].number)
    refused = n_alike - n_matches
    if refused:
        log.info("%d of %d matches that look alike lie where the others do not say: left out", refused, n_alike)


def _survey(
    points: pd.DataFrame, platform: Platform, log_of_body: NavigationLog, reported: NavigationCovariances
) -> Survey:
    """The points with the body's poses and covariances."""
    navigation = platform.navigation
    points = points.drop(columns="line")
    points = associate_poses(points, log_of_body, POSE_AT[navigation.association], navigation.maximum_pose_gap_s)
    return survey_from_table(associate_covariances(points, reported, navigation.maximum_gap_s))


def _adjusted(survey: Survey, platform: Platform) -> PoseAtLevels:
    """The pose from what was matched; raises InputError where it leads to none."""
    by_hand = platform.hand_measured
    try:
        found = pose_at_levels(survey, platform.camera, by_hand.pose, by_hand.body_covariance)
    except EstimationError as error:
        raise InputError(
            "source.points",
            f"matched points that lead to no pose ({error})",
            "strips that overlap at two heights or in two directions",
            "correct hand_measured, or label points (source.points: labels)",
        ) from None
    if not found.converged:
        log.warning("the pose at hand for the next round has not converged: look at the weights of the result")
    return found


def _at_hand(
    before: _Hand, survey: Survey, adjusted: PoseAtLevels, settings: MatchingSection, origin_down_m: float
) -> _Hand:
    """What the adjustment leaves at hand for the next round."""
    down_m = adjusted.points_m[:, 2] + survey.origin_m[2] - origin_down_m
    middle = float(np.nanmedian(down_m))
    range_m = middle - np.nanmin(survey.position_m[..., 2] + survey.origin_m[2] - origin_down_m)
    turn_m = range_m * float(np.sqrt(np.trace(adjusted.covariance[3:, 3:])))
    search_m = min(before.search_m, _SIGMAS * np.sqrt(2) * turn_m + _OFF_LEVEL * settings.relief_m + _DRIFT_M)
    return _Hand(adjusted.pose, middle, float(search_m))


def _without_wrong(points: pd.DataFrame, survey: Survey, adjusted: PoseAtLevels) -> pd.DataFrame:
    """The points without measurements that the adjustment takes for wrong, nor what is then seen once alone."""
    row = np.searchsorted(survey.number, points["observation"])
    column = pd.Index(survey.names).get_indexer(points["point"])
    of_point = adjusted.measurement_weight[row, column]
    right = points[~(of_point < _WRONG_WEIGHT)]
    kept = right[right.groupby("point")["observation"].transform("size") > 1]
    log.info(
        "%d of %d measurements are taken for wrong and left out, and %d of points that are then seen once",
        len(points) - len(right),
        len(points),
        len(right) - len(kept),
    )
    for number in sorted(set(survey.number.tolist()) - set(kept["observation"])):
        log.warning("scan %d: no measurement is left: left out", number)
    return kept.reset_index(drop=True)


def _extent(strip: Rectified) -> Floats:
    """First and last corner (2, 2) of a map, along its axes (m)."""
    size = np.array(strip.intensity.shape[::-1])
    return np.stack([strip.first_m, strip.first_m + strip.cell_m * (size - 1)])


def _overlap(first: Floats, second: Floats) -> bool:
    """Whether two maps have ground in common."""
    return bool(np.all(np.minimum(first[1], second[1]) > np.maximum(first[0], second[0])))
