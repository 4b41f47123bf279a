"""Writing what a simulated flight records, and the truth aside.

A folder holds `scans/strip-NN.{bil,hdr}` and `-times.csv`, `navigation.parquet`, `covariances.csv` (no heading: time
in microseconds and a row-major 12x12 covariance, position in 0-2, angles in 3-5), and `truth.parquet`, which no
estimate may read.
"""

from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa

from linepose.arrays import Floats
from linepose.geometry.camera import Camera
from linepose.geometry.pose import POSE_COLUMNS
from linepose.simulation import envi, sensor
from linepose.simulation.flight_section import FlightSection
from linepose.simulation.flown_scan import TrueFlight, light_of_strip, true_flight
from linepose.simulation.navigation_error import navigation_errors
from linepose.simulation.record import covariance_rows
from linepose.simulation.settings import ImageSettings
from linepose.simulation.survey import reported_covariance
from linepose.survey.observations import EULER_COLUMNS, POSITION_COLUMNS
from linepose.tables import write_table

_NAVIGATION, _IMAGES, _CLOCK = 2, 3, 5  # streams of random numbers, so that one part does not move another
_MARGIN_S: Final = 1.0  # of the log, before the first strip and after the last
_TRUTH_EVERY: Final = 50  # lines


def write_flight(folder: Path, camera: Camera, section: FlightSection) -> None:
    """Writes everything that the simulated flight records into `folder`, and `truth.parquet`."""
    (folder / "scans").mkdir(parents=True, exist_ok=True)
    flight = true_flight(section)
    _write(flight_log(section, flight), folder / "navigation.parquet")
    stamps = _time_us(section, np.arange(-_MARGIN_S, _end_s(flight) + _MARGIN_S, 1.0))
    (folder / "covariances.csv").write_text(
        covariance_rows(stamps, reported_covariance(section.navigation_error.reported)), encoding="utf-8"
    )
    _write(flight_truth(section, flight), folder / "truth.parquet")
    image = ImageSettings(ifov_rad=1 / camera.focal_length_px, n_bands=1)
    for strip in range(len(section.strips)):
        random = np.random.default_rng([section.seed, _IMAGES, strip])
        path = folder / "scans" / f"strip-{strip + 1:02d}"
        light = light_of_strip(camera, flight, strip)
        envi.write_scan(path, [sensor.expose(random, image, light)], sensor.wavelengths_nm(image.n_bands))
        envi.write_line_times(path, _stamped_us(section, flight, strip))


def flight_log(section: FlightSection, flight: TrueFlight) -> pd.DataFrame:
    """The erroneous solution at the log's rate over the whole flight, one row a time stamp."""
    time_s = np.arange(-_MARGIN_S, _end_s(flight) + _MARGIN_S, 1 / section.navigation_rate_hz)
    random = np.random.default_rng([section.seed, _NAVIGATION])
    view = np.zeros(len(time_s), dtype=np.int64)
    body = flight.body_poses(time_s) + navigation_errors(random, section.navigation_error.errors, time_s, view)
    return pd.DataFrame({"time_us": _time_us(section, time_s)} | _of_body(section, body))


def flight_truth(section: FlightSection, flight: TrueFlight) -> pd.DataFrame:
    """The truth, a row every 50 lines: observation, line, time_s, the body's pose, and the camera's in it."""
    tables = []
    for strip in range(len(section.strips)):
        time_s = flight.line_times_s(strip)[::_TRUTH_EVERY]
        columns = {"observation": strip + 1, "line": _TRUTH_EVERY * np.arange(len(time_s)), "time_s": time_s}
        tables.append(pd.DataFrame(columns | _of_body(section, flight.body_poses(time_s))))
    truth = pd.concat(tables, ignore_index=True)
    return truth.assign(**dict(zip(POSE_COLUMNS, flight.pose, strict=True)))


def _of_body(section: FlightSection, body: Floats) -> dict[str, Floats]:
    """Columns of poses (K, 6) on the map, angles within half a turn."""
    position = body[:, :3] + np.asarray(section.origin_m)
    euler = (body[:, 3:] + np.pi) % (2 * np.pi) - np.pi
    return dict(zip((*POSITION_COLUMNS, *EULER_COLUMNS), np.hstack([position, euler]).T, strict=True))


def _stamped_us(section: FlightSection, flight: TrueFlight, strip: int) -> np.ndarray:
    """The time stamp of each line of a strip, with its error."""
    random = np.random.default_rng([section.seed, _CLOCK, strip])
    time_s = flight.line_times_s(strip)
    late = np.clip(section.lateness_lines * random.standard_normal(len(time_s)), -0.4, 0.4)  # stamps stay in order
    return _time_us(section, time_s + late / section.line_rate_hz)


def _end_s(flight: TrueFlight) -> float:
    return float(flight.motion.start_s[-1] + flight.motion.duration_s[-1])


def _time_us(section: FlightSection, time_s: Floats) -> np.ndarray:
    return section.start_time_us + np.rint(time_s * 1e6).astype(np.int64)


def _write(table: pd.DataFrame, path: Path) -> None:
    write_table(table, path, pa.Schema.from_pandas(table, preserve_index=False))
