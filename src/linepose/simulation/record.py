"""Writing what a simulated platform records, and the truth aside.

A folder holds `scans/observation-NN.{bil,hdr}` and `-times.csv`, `navigation.parquet`, `covariances.csv` (no heading:
time in microseconds and a row-major 12x12 covariance, position in 0-2, angles in 3-5), `labels.csv` (rough pixel and
line of each labelled point), and `truth.parquet`, which no estimate may read.
"""

from collections.abc import Iterator
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.geometry import rotations
from linepose.geometry.camera import Camera
from linepose.geometry.pose import POSE_COLUMNS
from linepose.simulation import envi, sensor
from linepose.simulation.faults import clock_offsets_s, id_of_label, jumps, missing
from linepose.simulation.navigation_error import navigation_errors
from linepose.simulation.projection import exact_projections
from linepose.simulation.render import Exposure, line_of_time, line_times_s, render
from linepose.simulation.settings import SimulationSettings
from linepose.simulation.survey import faulty_observations, reported_covariance
from linepose.simulation.trajectory import body_poses, schedule, time_us
from linepose.survey.observations import EULER_COLUMNS, POSITION_COLUMNS
from linepose.tables import write_table

_NAVIGATION, _LABELS, _IMAGES = 1, 2, 3  # streams of random numbers, so that one part does not move another
_BLOCK_VALUES: Final = 4_000_000  # pixels times bands that are in memory at once
_COVARIANCE_SIZE: Final = 12
_COVARIANCE_RATE_HZ: Final = 1.0
_LABEL_REACH: Final = 3.0  # in sigmas: nobody clicks beyond


def write_survey(folder: Path, camera: Camera, settings: SimulationSettings) -> None:
    """Writes everything that the simulated platform records into `folder`, and `truth.parquet`."""
    (folder / "scans").mkdir(parents=True, exist_ok=True)
    _write(navigation_log(settings), folder / "navigation.parquet")
    write_covariances(folder / "covariances.csv", settings)
    labels(camera, settings).to_csv(folder / "labels.csv", index=False, float_format="%.2f")
    _write(truth_table(camera, settings), folder / "truth.parquet")
    offsets_us = np.rint(clock_offsets_s(settings) * 1e6).astype(np.int64)
    for number in range(1, len(settings.passes) + 1):
        exposure = render(camera, settings, number)
        path = folder / "scans" / f"observation-{number:02d}"
        envi.write_scan(path, _digital_blocks(settings, exposure), sensor.wavelengths_nm(settings.image.n_bands))
        envi.write_line_times(path, time_us(settings, exposure.time_s) + offsets_us[number - 1])


def _write(table: pd.DataFrame, path: Path) -> None:
    write_table(table, path, pa.Schema.from_pandas(table, preserve_index=False))


def navigation_log(settings: SimulationSettings) -> pd.DataFrame:
    """The erroneous solution at the log's rate over the whole survey, one row a time stamp."""
    time_s = np.arange(0.0, schedule(settings).survey_end_s, 1 / settings.navigation_rate_hz)
    rng = np.random.default_rng([settings.seed, _NAVIGATION])
    position, euler = body_poses(settings, time_s)
    errors = navigation_errors(rng, settings.navigation_error, time_s, _view(settings, time_s)) + jumps(
        settings, time_s
    )
    position = position + errors[:, :3] + np.asarray(settings.origin_m)
    euler = (euler + errors[:, 3:] + np.pi) % (2 * np.pi) - np.pi
    columns: dict[str, NDArray[np.int64] | Floats] = {"time_us": time_us(settings, time_s)}
    columns |= {name: position[:, axis] for axis, name in enumerate(POSITION_COLUMNS)}
    columns |= {name: euler[:, axis] for axis, name in enumerate(EULER_COLUMNS)}
    return pd.DataFrame(columns)


def write_covariances(path: Path, settings: SimulationSettings) -> None:
    """Writes the reported covariance at 1 Hz."""
    time_s = np.arange(0.0, schedule(settings).survey_end_s, 1 / _COVARIANCE_RATE_HZ)
    path.write_text(covariance_rows(time_us(settings, time_s), reported_covariance(settings.reported_sigma)))


def covariance_rows(stamps_us: NDArray[np.int64], reported: Floats) -> str:
    """Rows of time stamps (K,) with the reported covariance (6, 6) of position and angles within a 12x12 one."""
    matrix = np.zeros((_COVARIANCE_SIZE, _COVARIANCE_SIZE))
    matrix[:6, :6] = reported
    row = ",".join(f"{value:.8g}" for value in matrix.ravel())
    return "".join(f"{stamp},{row}\n" for stamp in stamps_us)


def labels(camera: Camera, settings: SimulationSettings) -> pd.DataFrame:
    """What a person clicked: observation, point, u_px and line of every visible point, a few pixels off."""
    rng = np.random.default_rng([settings.seed, _LABELS])
    truth = exact_projections(camera, settings)
    noise = np.clip(rng.standard_normal((2, *truth.u_px.shape)), -_LABEL_REACH, _LABEL_REACH)
    noise *= settings.extraction.label_sigma_px
    u_px, line = truth.u_px + noise[0], true_lines(camera, settings) + noise[1]
    rows, points = np.nonzero(_visible(camera, settings))
    names = np.argsort(id_of_label(settings), axis=1)[rows, points]
    table = pd.DataFrame(
        {
            "observation": rows + 1,
            "point": names,
            "u_px": np.clip(u_px[rows, points], 0, camera.n_pixels - 1),
            "line": np.clip(line[rows, points], 0, None),
        }
    )
    return table.sort_values(["observation", "point"], ignore_index=True)


def true_lines(camera: Camera, settings: SimulationSettings) -> Floats:
    """Line number at which each point crosses the scan line, whole at a line's middle; (N, M), NaN where none."""
    time_s = exact_projections(camera, settings).time_s
    return np.stack([line_of_time(camera, settings, row + 1, one) for row, one in enumerate(time_s)])


def truth_table(camera: Camera, settings: SimulationSettings) -> pd.DataFrame:
    """The truth, one row a point of an observation; its map positions are like the log's.

    u_px, line, how far the point moves across the scan line from one line to the next (v_px_per_line), time_s (from the
    survey's start) and the body's pose then, the point's position and its distance from the camera (range_m), the
    camera's pose, whether the point is visible, and whether the observation is spoilt by a planted fault.
    """
    truth = exact_projections(camera, settings)
    shape = truth.u_px.shape
    row, point = np.indices(shape).reshape(2, -1)
    origin = np.asarray(settings.origin_m)
    body = truth.position_m.reshape(-1, 3) + origin
    camera_m = truth.position_m + rotations.matrix_from_euler(truth.euler_rad) @ truth.pose[:3]
    columns: dict[str, NDArray[np.int64] | NDArray[np.bool_] | Floats] = {
        "observation": row + 1,
        "point": point,
        "visible": _visible(camera, settings).ravel(),
        "faulty": np.isin(row + 1, faulty_observations(settings)),
        "u_px": truth.u_px.ravel(),
        "line": true_lines(camera, settings).ravel(),
        "v_px_per_line": truth.v_px_s.ravel() / settings.image.line_rate_hz,
        "range_m": np.linalg.norm(truth.point_m - camera_m, axis=-1).ravel(),
        "time_s": truth.time_s.ravel(),
    }
    columns |= {name: body[:, axis] for axis, name in enumerate(POSITION_COLUMNS)}
    columns |= {name: truth.euler_rad[..., axis].ravel() for axis, name in enumerate(EULER_COLUMNS)}
    columns |= {f"point_{name}": (truth.point_m + origin)[point, axis] for axis, name in enumerate(POSITION_COLUMNS)}
    columns |= {name: np.full(len(row), value) for name, value in zip(POSE_COLUMNS, truth.pose, strict=True)}
    return pd.DataFrame(columns)


def _visible(camera: Camera, settings: SimulationSettings) -> NDArray[np.bool_]:
    """Which points the scans show; (N, M)."""
    line = true_lines(camera, settings)
    n_lines = np.array([len(line_times_s(camera, settings, row + 1)) for row in range(len(line))])
    inside = np.isfinite(line) & (line >= 0) & (line <= n_lines[:, None] - 1)
    return inside & ~missing(settings)


def _view(settings: SimulationSettings, time_s: Floats) -> NDArray[np.int64]:
    """The pass to which each time is nearest; (K,)."""
    times = schedule(settings)
    return np.searchsorted((times.end_s[:-1] + times.start_s[1:]) / 2, time_s)


def _digital_blocks(settings: SimulationSettings, exposure: Exposure) -> Iterator[NDArray[np.uint16]]:
    """The scan in digital numbers, a block of lines at a time."""
    rng = np.random.default_rng([settings.seed, _IMAGES, exposure.observation])
    step = max(1, _BLOCK_VALUES // (exposure.light.shape[1] * settings.image.n_bands))
    for first in range(0, len(exposure.light), step):
        yield sensor.expose(rng, settings.image, exposure.light[first : first + step])
