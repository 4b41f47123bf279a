"""What a platform recorded, whatever wrote it: from its files to the table of observations."""

from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from linepose.config.platform import Platform
from linepose.inputs.labels import read_point_labels
from linepose.inputs.labels.labelled_views import read_labelled_views, select_views
from linepose.inputs.navigation import NavigationRecord, log_covariances, read_navigation
from linepose.inputs.navigation.covariance_file import read_covariances
from linepose.inputs.observed_points import detected_points, refined_points, select_scans
from linepose.inputs.scans.line_times import line_times_of
from linepose.inputs.scans.scan_files import read_scan
from linepose.inputs.source import LabelledViewsSection, ScansSection
from linepose.inputs.targets.detectors import detector_of
from linepose.inputs.targets.refine import REFINEMENTS
from linepose.survey.corrected import corrected_covariances, corrected_points
from linepose.survey.navigation import NavigationCovariances, associate_covariances
from linepose.survey.navigation_log import POSE_AT, NavigationLog, associate_poses
from linepose.survey.observations import check_determined, survey_from_table

if TYPE_CHECKING:
    from linepose.inputs.targets.rectified import HandView


def read_points(platform: Platform, folder: Path) -> pd.DataFrame:
    """Points of all observations in a data set's folder.

    Columns as in `POINTS` (labelled views) or `SCAN_POINTS` (scans). Raises InputError.
    """
    source, n_pixels = platform.source, platform.camera.n_pixels
    if isinstance(source, ScansSection) and source.points == "matching":
        from linepose.pipeline.tie_points import matched_points

        return matched_points(platform, folder)
    if isinstance(source, LabelledViewsSection):
        return read_labelled_views(select_views(folder, source.views, source.first, source.step), n_pixels)
    scans, refine = select_scans(folder, source.scans, source.left_out), REFINEMENTS[source.refinement]
    line_times = line_times_of(source)
    if source.points == "detection":
        detector = detector_of(platform.target, source.refinement, lambda: hand_view(platform, folder))
        return detected_points(scans, detector, n_pixels, line_times)
    labels = read_point_labels(folder, source.labels, scans, n_pixels, source.point_id)
    return refined_points(scans, labels, refine, n_pixels, line_times)


def hand_view(platform: Platform, folder: Path) -> "HandView":
    """The camera at its hand-measured pose with the log of a platform with scans; raises InputError."""
    from linepose.inputs.targets.rectified import HandView

    assert isinstance(platform.source, ScansSection)
    log = read_record(platform, folder).log
    return HandView(platform.intrinsics(), platform.start_pose(), log, platform.source.target_range_m)


def with_navigation(points: pd.DataFrame, platform: Platform, folder: Path) -> pd.DataFrame:
    """The points with body pose and covariance; columns as in `OBSERVATIONS`.

    Raises InputError, also where the views are too few for the pose.
    """
    source, navigation = platform.source, platform.navigation
    if isinstance(source, ScansSection):
        record = read_navigation(source, folder, navigation.corrections)
        points = points.drop(columns="line", errors="ignore")
        points = associate_poses(points, record.log, POSE_AT[navigation.association], navigation.maximum_pose_gap_s)
        reported, place = _log_covariances(platform, record, folder), folder / source.scans
    else:
        points = corrected_points(points, navigation.corrections)
        reported, place = read_reported(platform, folder), folder / source.views
    observations = associate_covariances(points, reported, navigation.maximum_gap_s)
    check_determined(survey_from_table(observations), platform.n_unknown, str(place))
    return observations


def read_record(platform: Platform, folder: Path) -> NavigationRecord:
    """What the raw log of a platform with scans holds, corrected; raises InputError."""
    assert isinstance(platform.source, ScansSection)
    return read_navigation(platform.source, folder, platform.navigation.corrections)


def read_log(platform: Platform, folder: Path) -> NavigationLog:
    """The raw navigation log of a platform with scans; raises InputError."""
    return read_record(platform, folder).log


def read_reported(platform: Platform, folder: Path) -> NavigationCovariances:
    """The navigation covariances of a platform; raises InputError."""
    source, settings = platform.source, platform.navigation
    if isinstance(source, ScansSection):
        return _log_covariances(platform, read_navigation(source, folder, settings.corrections), folder)
    reported = read_covariances(folder / source.covariances, settings.covariance_columns)
    return corrected_covariances(reported, settings.corrections)


def _log_covariances(platform: Platform, record: NavigationRecord, folder: Path) -> NavigationCovariances:
    """The covariances of a platform with scans, whose log was read."""
    assert isinstance(platform.source, ScansSection)
    settings = platform.navigation
    return log_covariances(record, platform.source, settings.covariance_columns, folder, settings.corrections)


def read_observations(platform: Platform, folder: Path) -> pd.DataFrame:
    """The table of observations of a platform whose files stand in this folder.

    Columns as in `OBSERVATIONS`. Raises InputError for the first thing that cannot be used.
    """
    return with_navigation(read_points(platform, folder), platform, folder)


def measurements_in_words(points: pd.DataFrame) -> str:
    """How many measurements of how many points, in how many views: columns `observation` and `point`."""
    n_points, n_views = points["point"].nunique(), points["observation"].nunique()
    return f"{len(points)} measurements of {n_points} points in {n_views} views"


def check_readable(platform: Platform, folder: Path) -> str:
    """What the folder of a platform's records holds, in words; raises InputError for the first fault.

    Of labelled views all is known then; what only extraction can tell of scans (is the board in them?) is left to it.
    """
    source = platform.source
    if isinstance(source, LabelledViewsSection):
        return measurements_in_words(read_observations(platform, folder))
    scans = select_scans(folder, source.scans, source.left_out)
    line_times = line_times_of(source)
    for path in scans.values():
        read_scan(path, line_times)
    if source.points == "labels":
        read_point_labels(folder, source.labels, scans, platform.camera.n_pixels, source.point_id)
    read_reported(platform, folder)
    return f"{len(scans)} scans"
