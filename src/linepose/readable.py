"""Reading all that a platform recorded before any result is touched, so that a fault of it spoils none."""

from pathlib import Path

from linepose.config.platform import LabelledViewsSection, Platform
from linepose.extraction.labelled_views import read_labelled_views, select_views
from linepose.extraction.labels import read_labels
from linepose.extraction.scan_survey import select_scans
from linepose.extraction.scans import read_scan
from linepose.navigation import associate_covariances, read_covariances
from linepose.navigation_log import read_navigation_log
from linepose.observations import check_determined, survey_from_table
from linepose.pose import N_PARAMETERS


def check_readable(platform: Platform, folder: Path) -> str:
    """What the folder of a platform's records holds, in words; raises InputError for the first fault.

    Of labelled views all is known then; what only extraction can tell of scans (is the board in them?) is left to it.
    """
    source, navigation = platform.source, platform.navigation
    covariances = read_covariances(folder / source.covariances, navigation.covariance_columns)
    if isinstance(source, LabelledViewsSection):
        views = select_views(folder, source.views, source.first, source.step)
        points = read_labelled_views(views, platform.camera.n_pixels)
        observations = associate_covariances(points, covariances, navigation.maximum_gap_s)
        check_determined(survey_from_table(observations), N_PARAMETERS, str(folder / source.views))
        return f"{len(points)} points in {len(views)} views"
    scans = select_scans(folder, source.scans, source.left_out)
    for path in scans.values():
        read_scan(path)
    if source.points == "labels":
        read_labels(folder / source.labels, list(scans))
    read_navigation_log(folder / source.navigation)
    return f"{len(scans)} scans"
