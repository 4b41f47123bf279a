"""The Python interface: a platform's observations or an engineer's own arrays in, a calibration out, no workflow."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.config.platform import Platform
from linepose.config.project import Project
from linepose.errors import InputError
from linepose.estimation.noise_models import noise_model
from linepose.pipeline.calibrate import CalibrationSettings, calibrate
from linepose.pipeline.calibration import Calibration
from linepose.pipeline.known_points import known_of_platform
from linepose.pipeline.load import read_observations
from linepose.pipeline.project_folder import find_project, load_platform_project
from linepose.survey.covariance_rule import COVARIANCE_REMEDY, COVARIANCE_WORDS, first_unusable
from linepose.survey.observations import (
    COVARIANCE_COLUMNS,
    COVARIANCE_INDICES,
    EULER_COLUMNS,
    OBSERVATIONS,
    POSITION_COLUMNS,
)
from linepose.survey.point_names import WHAT, nameless, point_names
from linepose.survey.rows import checked_rows


def observations_from_arrays(
    observation: ArrayLike,
    point: ArrayLike,
    u_px: ArrayLike,
    position_m: ArrayLike,
    euler_rad: ArrayLike,
    covariance: ArrayLike,
    time_us: ArrayLike | None = None,
) -> pd.DataFrame:
    """The table of observations, from arrays with one row for each of K measurements.

    Parameters
    ----------
    observation : array_like, shape (K,)
        Number of the observation, from 1.
    point : array_like, shape (K,)
        Name of the point: numbers or text, the same in each observation that saw it.
    u_px : array_like, shape (K,)
        Pixel along the scan line, from 0 (px).
    position_m : array_like, shape (K, 3)
        The body's north, east, down when the point was recorded (m).
    euler_rad : array_like, shape (K, 3)
        The body's roll, pitch, yaw then, zyx intrinsic (rad).
    covariance : array_like, shape (6, 6) or (K, 6, 6)
        Of north, east, down, roll, pitch, yaw (m, rad).
    time_us : array_like, shape (K,), optional
        When each point was recorded (us); without it, drift of the navigation cannot be told from other errors.

    Returns
    -------
    pandas.DataFrame
        K rows, sorted by observation and point, with units in the column names.

    Raises
    ------
    InputError
        Names the first array that does not fit, its row, and what to do.

    Examples
    --------
    >>> table = linepose.observations_from_arrays(
    ...     observation=[1, 1],
    ...     point=[0, 1],
    ...     u_px=[310.2, 325.9],
    ...     position_m=[[0.0, 0.0, 0.0], [0.1, 0.0, 0.0]],
    ...     euler_rad=np.zeros((2, 3)),
    ...     covariance=np.diag([0.02, 0.02, 0.03, 0.001, 0.001, 0.002]) ** 2,
    ... )
    >>> table[["observation", "point", "u_px", "north_m"]]
       observation  point   u_px  north_m
    0            1      0  310.2      0.0
    1            1      1  325.9      0.1
    """
    pixels = np.atleast_1d(_numbers("u_px", u_px))
    count = len(pixels)
    position = _shaped("position_m", position_m, (count, 3))
    euler = _shaped("euler_rad", euler_rad, (count, 3))
    if np.any(np.abs(euler) > 2 * np.pi):
        largest = float(np.abs(euler).max())
        raise InputError("euler_rad", f"an angle of {largest:g}", "radians", "convert degrees with numpy.radians")
    matrices = _numbers("covariance", covariance)
    if matrices.shape not in ((6, 6), (count, 6, 6)):
        found = f"shape {matrices.shape}"
        raise InputError(
            "covariance", found, f"shape (6, 6) or ({count}, 6, 6)", "give one matrix for all, or one a row"
        )
    matrices = _shaped("covariance", np.broadcast_to(matrices, (count, 6, 6)), (count, 6, 6))
    _check_covariances(matrices)
    columns: dict[str, Floats | np.ndarray] = {
        "observation": _whole("observation", observation, count),
        "point": _names(point, count),
        "time_us": _whole("time_us", np.zeros(count) if time_us is None else time_us, count, "give microseconds"),
        "u_px": _shaped("u_px", pixels, (count,)),
    }
    columns |= dict(zip(POSITION_COLUMNS, position.T, strict=True))
    columns |= dict(zip(EULER_COLUMNS, euler.T, strict=True))
    columns |= {name: matrices[:, i, j] for name, (i, j) in zip(COVARIANCE_COLUMNS, COVARIANCE_INDICES, strict=True)}
    table = checked_rows(pd.DataFrame(columns).assign(nav_gap_s=0.0), OBSERVATIONS.names)
    return table.sort_values(["observation", "point"], ignore_index=True)


def _numbers(name: str, values: ArrayLike) -> Floats:
    array = np.asarray(values)
    if np.iscomplexobj(array):
        raise InputError(name, "complex numbers", "an array of real numbers", "give the real ones")
    if array.dtype.kind == "M":
        remedy = "convert them with .astype('datetime64[us]').astype('int64')"
        raise InputError(name, "dates", "an array of numbers", remedy)
    try:
        if isinstance(values, np.ma.MaskedArray):
            return np.ma.filled(values.astype(float), np.nan)
        return np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise InputError(name, "text, or rows of different lengths", "an array of numbers", "correct it") from None


def _shaped(name: str, values: ArrayLike, shape: tuple[int, ...]) -> Floats:
    array = _numbers(name, values)
    if array.shape != shape:
        raise InputError(name, f"shape {array.shape}", f"shape {shape}", "give one row a point seen, as in u_px")
    if not np.all(np.isfinite(array)):
        row = int(np.argwhere(~np.isfinite(array))[0][0])
        raise InputError(f"{name}, row {row}", "no number", "finite numbers", "leave out points that were not seen")
    return array


def _whole(name: str, values: ArrayLike, count: int, remedy: str = "number the views") -> np.ndarray:
    array = _shaped(name, values, (count,))
    wrong = np.flatnonzero((array != np.rint(array)) | (array < 0) | (array >= 2.0**63))
    if wrong.size:
        row = int(wrong[0])
        raise InputError(f"{name}, row {row}", f"{array[row]:g}", "a whole number, not negative", remedy)
    return np.asarray(values).astype(np.int64)


def _names(values: ArrayLike, count: int) -> np.ndarray:
    array = np.atleast_1d(np.asarray(values, dtype=object))
    if array.shape != (count,):
        raise InputError("point", f"shape {array.shape}", f"shape {(count,)}", "give one row a point seen, as in u_px")
    for row in nameless(array)[:1]:
        raise InputError(f"point, row {row}", str(array[row]), WHAT, "number or name the points")
    return point_names(array)


def _check_covariances(matrices: Floats) -> None:
    unusable = first_unusable(matrices)
    if unusable is not None:
        row, found = unusable
        remedy = "check the order of rows and columns" if np.any(matrices[row]) else COVARIANCE_REMEDY
        raise InputError(f"covariance, row {row}", found, COVARIANCE_WORDS, remedy)


def load_platform_file(platform: str, project: Path | str = ".") -> Platform:
    """What a platform's file says.

    Parameters
    ----------
    platform : str
        Its name, as in config/platforms/NAME.yaml.
    project : path_like, optional
        The project's folder, or one below it; by default the current one.

    Returns
    -------
    Platform
        The settings of the file, checked, defaults filled in.

    Raises
    ------
    InputError
        The project or the file is missing, or a key of it is wrong.

    Examples
    --------
    >>> linepose.load_platform_file("myrobot").camera.n_pixels
    648
    """
    return _loaded(platform, project).platforms[platform]


def load_observations(platform: str, project: Path | str = ".") -> pd.DataFrame:
    """The table of observations of a platform, read from its files.

    Parameters
    ----------
    platform : str
        Its name, as in config/platforms/NAME.yaml.
    project : path_like, optional
        The project's folder, or one below it; by default the current one.

    Returns
    -------
    pandas.DataFrame
        One row for each measurement, as `observations_from_arrays` makes it.

    Raises
    ------
    InputError
        Names the file, the row, what was found and what to do.

    Examples
    --------
    >>> linepose.load_observations("myrobot")["observation"].nunique()
    16
    """
    loaded = _loaded(platform, project)
    return read_observations(loaded.platforms[platform], recorded_folder(loaded, platform, find_project(project)))


def calibrate_platform(platform: str, project: Path | str = ".") -> Calibration:
    """The calibration of a platform, with the settings of its project's config.yaml.

    The pose, its covariance and all tables are those of `linepose run`, for the accepted observations.

    Parameters
    ----------
    platform : str
        Its name, as in config/platforms/NAME.yaml.
    project : path_like, optional
        The project's folder, or one below it; by default the current one.

    Returns
    -------
    Calibration
        The pose, its covariance and all that it rests on.

    Raises
    ------
    InputError
        A file of the platform cannot be used.
    EstimationError
        No set of observations agrees on a pose.

    Examples
    --------
    >>> linepose.calibrate_platform("myrobot").covariance.shape
    (6, 6)
    """
    loaded = _loaded(platform, project)
    settings, study = loaded.platforms[platform], loaded.study
    folder = recorded_folder(loaded, platform, find_project(project))
    observations = read_observations(settings, folder)
    made = {"noise_model": settings.noise_model, "prior": settings.prior, "seed": study.seed}
    if noise_model(settings.noise_model).removes_outliers:
        made |= {"search": study.search, "sampling": study.sampling} | dict(study.outliers)
    else:
        made |= {"adjustment": study.adjustment}
    calibrated = calibrate(
        observations,
        settings.intrinsics(),
        settings.hand_measured,
        CalibrationSettings(**made),
        platform,
        known_points=known_of_platform(settings, folder, observations),
    )
    return replace(calibrated, platform=settings)


def recorded_folder(project: Project, platform: str, root: Path) -> Path:
    """Folder of what a platform recorded; raises InputError where a simulated survey was not made yet."""
    folder = root / project.folder(platform)
    if project.platforms[platform].source.dataset is None and not folder.is_dir():
        remedy = f"make it with `linepose run {platform}`"
        raise InputError(str(folder), "no such folder", "the simulated survey", remedy)
    return folder


def _loaded(platform: str, project: Path | str) -> Project:
    return load_platform_project(platform, find_project(project))
