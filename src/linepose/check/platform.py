"""Everything that can be known of a platform before a run, in one pass and in seconds."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import Final, TypeVar

import numpy as np
import pandas as pd

from linepose.adjustment.known_points import KnownPoints
from linepose.check import clock, contents, covariances
from linepose.check.camera import camera_findings
from linepose.check.conventions.examine import HandSigmas
from linepose.check.conventions.findings import agreed, convention_findings
from linepose.check.exchanges import exchange_findings
from linepose.check.finding import CheckReport, Finding, Level, PredictedSigma, error, of_fault, ok
from linepose.check.flight import flight_findings
from linepose.check.hand_measured import arm_findings, hand_findings
from linepose.check.labels import count_findings, position_findings
from linepose.check.map_frame import origin_findings
from linepose.check.motion import motion_findings
from linepose.check.points import file_findings, point_findings
from linepose.check.prediction import predict
from linepose.check.recorder import Recorder
from linepose.check.scans import scan_findings
from linepose.check.target import target_findings
from linepose.check.told import agreeing, readers_warnings
from linepose.check.views import view_findings
from linepose.config.platform import Platform, camera_keys, load_platform, platform_faults
from linepose.config.project import Project
from linepose.config.study import check_study
from linepose.config.yaml_file import read_yaml
from linepose.errors import InputError, LineposeError
from linepose.estimation.noise_models import noise_model
from linepose.experiments.registry import compared_platforms, experiment_faults
from linepose.inputs.navigation.covariance_file import read_covariances
from linepose.inputs.number_files import read_numbers
from linepose.inputs.source import LabelledViewsSection, ScansSection
from linepose.pipeline.load import read_record, read_reported, with_navigation
from linepose.pipeline.project_folder import CONFIG, find_project, load_platform_project
from linepose.simulation.survey import simulate_survey
from linepose.survey.datasets import check_dataset
from linepose.survey.navigation import NavigationCovariances
from linepose.survey.navigation_log import NavigationLog
from linepose.survey.observations import Survey, check_determined, survey_from_table, table_from_survey

_COVARIANCE_SIZE: Final = 12
_SINCE_AN_EPOCH: Final = {"csv", "headwall"}  # of source.time_stamps: numbers that count from 1970 or 1980
Read = TypeVar("Read")


@dataclass(frozen=True)
class Recorded:
    """What could be read of a platform's files; None where it could not."""

    points: pd.DataFrame | None = None
    log: NavigationLog | None = None
    covariances: NavigationCovariances | None = None


def check_platform(platform: str, project: Path | str = ".") -> CheckReport:
    """All that can be known of a platform before a run, in seconds.

    Parameters
    ----------
    platform : str
        Its name, as in config/platforms/NAME.yaml.
    project : path_like, optional
        The project's folder, or one below it; by default the current one.

    Returns
    -------
    CheckReport
        The findings, each with its level and advice, and the sigmas (m, rad) that the pose will be known to.

    Raises
    ------
    InputError
        There is no project; every other fault is a finding.

    Examples
    --------
    >>> report = linepose.check_platform("myrobot")
    >>> report.level < 2, len(report.predicted)
    (True, 6)
    """
    root = find_project(project)
    findings = configuration_findings(platform, root)
    if any(finding.level == Level.ERROR for finding in findings):
        return CheckReport(platform, tuple(findings))
    study = check_study(read_yaml(root / CONFIG) | {"platforms": [platform]})
    settings = load_platform(root / study.platforms_folder, platform)
    findings += camera_findings(settings.intrinsics(), camera_keys(root / study.platforms_folder, platform))
    try:
        loaded = load_platform_project(platform, root, compared_platforms, offline=True)
    except InputError as fault:
        return CheckReport(platform, (*findings, of_fault("data set", fault)))
    with readers_warnings() as told:
        more, points, observations = recorded_findings(loaded, platform, root)
    findings += [*more, *agreeing(told, more)]
    faulty = any(finding.level == Level.ERROR for finding in findings)
    if settings.flight is not None and points is None and observations is None and not faulty:
        more, sigmas = flight_findings(settings)
        return CheckReport(platform, (*findings, *more), sigmas)
    if observations is None or faulty:
        return CheckReport(platform, tuple(findings))
    more, known = point_findings(settings, root / loaded.folder(platform), observations)
    findings += more
    if any(finding.level == Level.ERROR for finding in more):
        return CheckReport(platform, tuple(findings))
    recorder = Recorder(settings, root / loaded.folder(platform), points, observations)
    more, sigmas = geometry_findings(settings, observations, recorder, known)
    return CheckReport(platform, (*findings, *more), sigmas)


def configuration_findings(platform: str, root: Path) -> list[Finding]:
    """Every fault of config.yaml and of the platform's file, or that there is none."""
    try:
        study = check_study(read_yaml(root / CONFIG) | {"platforms": [platform]}, str(root / CONFIG))
    except InputError as fault:
        return [of_fault("configuration", fault)]
    folder = root / study.platforms_folder
    faults = platform_faults(folder, platform) or experiment_faults(
        load_platform(folder, platform), str(folder / f"{platform}.yaml")
    )
    if faults:
        return [of_fault("platform file", fault) for fault in faults]
    return [ok("platform file", f"{study.platforms_folder}/{platform}.yaml has every key it needs")]


def recorded_findings(
    project: Project, platform: str, root: Path
) -> tuple[list[Finding], pd.DataFrame | None, pd.DataFrame | None]:
    """Findings on what the platform recorded, its points as they are read, and its observations where usable."""
    settings = project.platforms[platform]
    folder = root / project.folder(platform)
    if settings.source.dataset is None and not folder.is_dir():
        findings, observations = _simulated(settings)
        return findings, None, observations
    if not folder.is_dir():
        found = f"{folder}: no such folder"
        if settings.source.dataset in project.datasets:
            advice = f"it is downloaded by `linepose run {platform}`; check again after it"
            return [error("data set", found, advice)], None, None
        return [error("data set", found, "put the platform's files there, or correct source.dataset")], None, None
    findings, points = [*_sum_findings(project, platform, folder)], None
    n_pixels, source = settings.camera.n_pixels, settings.source
    if isinstance(source, LabelledViewsSection):
        more, points = view_findings(source, folder, n_pixels)
    else:
        more, points = scan_findings(source, folder, n_pixels, root / "results" / platform)
        more = [*more, *target_findings(settings.target, settings.intrinsics(), source)]
    findings += more
    if points is not None:
        removes = noise_model(settings.noise_model).removes_outliers
        findings += count_findings(points, project.study.outliers.minimum_observations if removes else None)
    more, recorded = _navigation_findings(settings, folder, points)
    findings += more
    if points is None:
        findings += arm_findings(settings.start_pose()[:3])  # else told with what the points say of it
        findings += file_findings(settings, folder, recorded.log)
    if any(finding.level == Level.ERROR for finding in findings) or recorded.points is None:
        return findings, points, None
    try:
        observations = with_navigation(recorded.points, settings, folder)
        check_determined(survey_from_table(observations), settings.n_unknown)
    except InputError as fault:
        return [*findings, of_fault("observations", fault)], points, None
    return findings, points, observations


def geometry_findings(
    settings: Platform,
    observations: pd.DataFrame,
    recorder: Recorder,
    known_points: KnownPoints | None = None,
) -> tuple[list[Finding], tuple[PredictedSigma, ...]]:
    """Findings on motion, hand-measured pose, conventions and predicted sigmas, of a usable table of observations."""
    survey, camera = survey_from_table(observations), settings.intrinsics()
    findings = motion_findings(survey)
    pose, covariance = settings.start_pose(), settings.start_covariance()
    arm = arm_findings(pose[:3])
    if any(finding.level == Level.ERROR for finding in arm):
        return [*arm, *(replace(one, advice="") for one in findings)], ()
    try:
        more, point_m = hand_findings(survey, camera, pose, covariance)
    except LineposeError as fault:
        return [*findings, error("hand measurement", str(fault), "check hand_measured and the navigation's axes")], ()
    hand = settings.hand_measured
    near = HandSigmas(hand.sigma_position_m, float(np.radians(hand.sigma_rotation_deg)))
    at = cache(recorder.at)  # tens of hypotheses look at the same few clocks
    findings = agreed([*findings, *more], convention_findings(settings, at, recorder.of, near))
    if any(finding.level == Level.ERROR for finding in findings):
        return findings, ()
    prediction = predict(survey, camera, hand, settings.pose_prior() is not None, point_m, known_points)
    if prediction.adjusted is not None:
        findings += exchange_findings(survey, camera, prediction.adjusted)
    return [*findings, *prediction.findings], prediction.sigmas


def _sum_findings(project: Project, platform: str, folder: Path) -> list[Finding]:
    """Whether every file of a public data set is there and unaltered; a user's own files have no sums."""
    dataset = project.platforms[platform].source.dataset
    if dataset is None or dataset not in project.datasets:
        return [ok("data set", f"{folder}")]
    try:
        sums = check_dataset(folder, project.datasets[dataset].sha256)
    except InputError as fault:
        return [of_fault("data set", fault)]
    return [ok("data set", f"{folder}: {len(sums)} files, unaltered")]


def _navigation_findings(
    settings: Platform, folder: Path, points: pd.DataFrame | None
) -> tuple[list[Finding], Recorded]:
    """Findings on navigation log, covariances, and their times against those of the points."""
    findings: list[Finding] = []
    record = _attempt(read_record, settings, folder, "navigation log", findings) if _has_log(settings) else None
    log = None if record is None else record.log
    reported = None
    if log is not None or not _has_log(settings):
        reported = _attempt(read_reported, settings, folder, "covariances", findings)
    elif settings.source.covariances is not None:  # the log's fault is told once
        reported = _attempt(_read_covariance_file, settings, folder, "covariances", findings)
    if reported is not None:
        findings += covariances.size_findings(reported)
        if settings.source.covariances is not None:
            findings += _column_findings(settings, folder / settings.source.covariances)
    navigation = settings.navigation
    if record is not None:
        log = record.log
        findings.append(contents.of_log(record, navigation.corrections))
        findings += position_findings(log.position_m, record.frame is None)
        findings += origin_findings(settings.map_frame, log.position_m)
        findings += clock.rate_findings(log.time_us, navigation.maximum_pose_gap_s)
    if points is not None:
        time_us = points["time_us"].to_numpy()
        offset_s = settings.source.time_offset_s if isinstance(settings.source, ScansSection) else None
        if log is not None:
            findings += clock.overlap_findings(time_us, log.time_us, "navigation log", offset_s, _epoch_keys(settings))
        if reported is not None:
            about = "covariance", "navigation.maximum_gap_s"
            within = clock.overlap_findings(time_us, reported.time_us, "covariances", offset_s)
            if log is not None and findings[-1].level == Level.OK:  # the clock is right: the file's is not
                remedy = "correct the times in source.covariances (column 1, us)"
                within = [replace(one, advice=remedy, causes=()) if one.advice else one for one in within]
            gaps = clock.gap_findings(time_us, reported.time_us, navigation.maximum_gap_s, *about)
            findings += within if within[0].level == Level.ERROR and gaps[0].level == Level.ERROR else gaps
    return findings, Recorded(points, log, reported)


def _epoch_keys(settings: Platform) -> tuple[str, str]:
    """The keys that say that times count from 1980, of camera and navigation; empty where it has none, or is so set."""
    source = settings.source
    if not isinstance(source, ScansSection):
        return "", ""
    scale = getattr(source.navigation, "time_scale", None)
    of_log = "source.navigation.time_scale: gps" if scale == "unix" else ""
    counts = source.time_scale != "gps" and source.time_stamps in _SINCE_AN_EPOCH
    return "source.time_scale: gps" if counts else "", of_log


def _has_log(settings: Platform) -> bool:
    return isinstance(settings.source, ScansSection)


def _read_covariance_file(settings: Platform, folder: Path) -> NavigationCovariances:
    return read_covariances(folder / (settings.source.covariances or ""), settings.navigation.covariance_columns)


def _attempt(
    read: Callable[[Platform, Path], Read], settings: Platform, folder: Path, subject: str, findings: list[Finding]
) -> Read | None:
    """What a reader gives, or None with its fault among the findings."""
    try:
        return read(settings, folder)
    except InputError as fault:
        findings.append(of_fault(subject, fault))
        return None


def _column_findings(settings: Platform, path: Path) -> list[Finding]:
    """Which columns of the 12x12 covariances look like the attitude."""
    _, values = read_numbers(path, 1 + _COVARIANCE_SIZE**2, "12x12 covariances")
    variances = values.reshape(-1, _COVARIANCE_SIZE, _COVARIANCE_SIZE).diagonal(axis1=1, axis2=2)
    sigma = np.sqrt(np.maximum(np.median(variances, axis=0), 0.0))
    return covariances.attitude_findings(sigma, settings.navigation.covariance_columns)


def _simulated(settings: Platform) -> tuple[list[Finding], pd.DataFrame | None]:
    """A simulated platform that has not been run: its geometry can be checked all the same."""
    if settings.flight is not None:
        return [ok("data set", "a simulated flight, not made yet: its strips are checked as they are planned")], None
    if settings.simulation is None:
        return [], None
    survey, _ = simulate_survey(settings.true_intrinsics(), settings.simulation, settings.simulation.seed)
    found = f"simulated, not made yet: {len(settings.simulation.passes)} passes; checked without images"
    return [ok("data set", found)], table_from_survey(_with_numbers(survey))


def _with_numbers(survey: Survey) -> Survey:
    return survey.select(
        [int(number) for number, row in zip(survey.number, survey.u_px, strict=True) if np.isfinite(row).any()]
    )
