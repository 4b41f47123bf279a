"""Reading a platform's navigation log, whatever format its file names."""

import datetime
from collections.abc import Sequence
from pathlib import Path

from linepose.errors import InputError
from linepose.inputs import gps_time
from linepose.inputs.navigation.covariance_file import read_covariances
from linepose.inputs.navigation.format import NavigationFormatSection
from linepose.inputs.navigation.log_file import read_navigation_log
from linepose.inputs.navigation.record import NavigationRecord, corrected_record
from linepose.inputs.navigation.registry import FORMATS
from linepose.inputs.scans.line_times import first_time_us
from linepose.inputs.source import ScansSection
from linepose.survey.corrected import corrected_covariances
from linepose.survey.navigation import NavigationCovariances


def read_navigation(
    section: ScansSection | NavigationFormatSection | str, folder: Path, corrections: Sequence[str] = ()
) -> NavigationRecord:
    """The navigation log of a data set's folder.

    `section` is `source` of a platform file, or its `source.navigation`: the path of our own table, or the section of
    a format. A log that does not say its GPS week takes that of the scans, which only `source` names. `corrections` are
    navigation.corrections. Raises InputError naming the file, the place in it, what was found and what was expected.
    """
    return corrected_record(_read(section, folder), corrections)


def _read(section: ScansSection | NavigationFormatSection | str, folder: Path) -> NavigationRecord:
    navigation = section.navigation if isinstance(section, ScansSection) else section
    if isinstance(navigation, str):
        return NavigationRecord(read_navigation_log(folder / navigation), None)
    if isinstance(section, ScansSection):
        navigation = _with_day_of_scans(navigation, section, folder)
    record: NavigationRecord = FORMATS.member(navigation.format).read(navigation, folder)
    return record


def log_covariances(
    record: NavigationRecord,
    source: ScansSection,
    attitude_columns: tuple[int, int, int],
    folder: Path,
    corrections: Sequence[str] = (),
) -> NavigationCovariances:
    """The covariances of `source.covariances`, or where it is not given those of the log itself.

    `attitude_columns` and `corrections` are navigation.covariance_columns and navigation.corrections, for the file.
    Raises InputError where there are none.
    """
    if source.covariances is not None:
        path = folder / source.covariances
        if record.covariances is not None and not path.is_file():
            remedy = "restore it, or remove source.covariances: the navigation log holds sigmas of its own"
            raise InputError(str(path), "no such file", "time (us) and 144 covariances", remedy)
        return corrected_covariances(read_covariances(path, attitude_columns), corrections)
    if record.covariances is None:
        found, expected = "nothing", "a file: the navigation log holds no covariances"
        raise InputError("source.covariances", found, expected, "write the file, or log the covariances too")
    return record.covariances


def _with_day_of_scans(
    navigation: NavigationFormatSection, source: ScansSection, folder: Path
) -> NavigationFormatSection:
    """The section with the GPS week or the day of the scans' first line, where its log counts from one and has none."""
    lacking = navigation.lacking(folder)
    if lacking is None:
        return navigation
    first_us = first_time_us(source, folder)
    day = datetime.datetime.fromtimestamp(first_us / 1e6, datetime.UTC).date()
    return navigation.model_copy(update={lacking: {"gps_week": gps_time.week_at(first_us), "date": day}[lacking]})
