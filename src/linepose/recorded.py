"""What a platform recorded, read without the workflow: from its files to the table of observations."""

from pathlib import Path

import pandas as pd

from linepose.config.platform import LabelledViewsSection, Platform, ScansSection
from linepose.extraction.labelled_views import read_labelled_views, select_views
from linepose.extraction.labels import read_labels
from linepose.extraction.refine import METHODS
from linepose.extraction.scan_survey import detected_points, refined_points, select_scans
from linepose.navigation import NavigationCovariances, associate_covariances, read_covariances
from linepose.navigation_log import POSE_AT, NavigationLog, associate_poses, read_navigation_log
from linepose.observations import check_determined, survey_from_table
from linepose.pose import N_PARAMETERS


def read_points(platform: Platform, folder: Path) -> pd.DataFrame:
    """Points of all observations in a data set's folder, as the stage `extract` finds them.

    Columns as in `result_schemas.POINTS` (labelled views) or `SCAN_POINTS` (scans). Raises InputError.
    """
    source, n_pixels = platform.source, platform.camera.n_pixels
    if isinstance(source, LabelledViewsSection):
        return read_labelled_views(select_views(folder, source.views, source.first, source.step), n_pixels)
    scans, refine = select_scans(folder, source.scans, source.left_out), METHODS[source.refinement]
    if source.points == "detection":
        return detected_points(scans, refine, n_pixels)
    return refined_points(scans, read_labels(folder / source.labels, list(scans)), refine, n_pixels)


def with_navigation(points: pd.DataFrame, platform: Platform, folder: Path) -> pd.DataFrame:
    """The points with body pose and covariance, as the stage `associate` gives them.

    Columns as in `result_schemas.OBSERVATIONS`. Raises InputError.
    """
    navigation = platform.navigation
    if isinstance(platform.source, ScansSection):
        log = read_log(platform, folder)
        points = points.drop(columns="line", errors="ignore")
        points = associate_poses(points, log, POSE_AT[navigation.association], navigation.maximum_pose_gap_s)
    return associate_covariances(points, read_reported(platform, folder), navigation.maximum_gap_s)


def read_log(platform: Platform, folder: Path) -> NavigationLog:
    """The raw navigation log of a platform with scans; raises InputError."""
    assert isinstance(platform.source, ScansSection)
    return read_navigation_log(folder / platform.source.navigation)


def read_reported(platform: Platform, folder: Path) -> NavigationCovariances:
    """The navigation covariances of a platform; raises InputError."""
    return read_covariances(folder / platform.source.covariances, platform.navigation.covariance_columns)


def read_observations(platform: Platform, folder: Path) -> pd.DataFrame:
    """The table of observations of a platform whose files stand in this folder.

    Columns as in `result_schemas.OBSERVATIONS`. Raises InputError for the first thing that cannot be used.
    """
    observations = with_navigation(read_points(platform, folder), platform, folder)
    check_determined(survey_from_table(observations), N_PARAMETERS)
    return observations
