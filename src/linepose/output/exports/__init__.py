"""A finished calibration taken away: one format a file, all behind `export_platform`."""

from collections.abc import Callable
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Final

from linepose.config.platform import Platform
from linepose.errors import InputError
from linepose.output.exports.calibration import Calibration, read_calibration
from linepose.output.exports.csv_file import write_csv_pose
from linepose.output.exports.geojson import write_geojson
from linepose.output.exports.geopackage import write_geopackage
from linepose.output.exports.json_file import write_json
from linepose.output.exports.kalibr import write_kalibr
from linepose.output.exports.options import BodyAxes, ExportOptions, export_options
from linepose.output.exports.points import frame_of, read_mapped_points
from linepose.output.exports.ros2 import write_ros2
from linepose.output.exports.urdf import write_urdf
from linepose.tables import atomic_write

__all__ = ["EXPORTS", "ExportOptions", "Exporter", "Finished", "export_options", "export_platform"]


@dataclass(frozen=True)
class Finished:
    """A platform that has been run: the folder of all results, its file, its name, and the stage that is wanted."""

    results: Path
    platform: Platform
    name: str
    stage: str

    def calibration(self, options: ExportOptions, axes: BodyAxes) -> Calibration:
        """The pose in the axes that the options ask for, or in these."""
        found = read_calibration(self.results, self.platform, self.name, self.stage)
        return found.in_axes(options.body_axes or axes)


@dataclass(frozen=True)
class Exporter:
    """One format: what it is in a few words, how its files end, and what writes it to a path."""

    title: str
    suffix: str
    write: Callable[[Finished, ExportOptions, Path], None]


def _points(write: Callable[..., None]) -> Callable[[Finished, ExportOptions, Path], None]:
    """A writer of layers of points in a map frame, as an exporter's."""

    def of_finished(finished: Finished, options: ExportOptions, path: Path) -> None:  # noqa: ARG001
        frame = frame_of(finished.results, finished.platform, finished.name)
        write(read_mapped_points(finished.results, finished.name, finished.stage, frame), frame, path)

    return of_finished


def _urdf(finished: Finished, options: ExportOptions, path: Path) -> None:
    write_urdf(finished.calibration(options, "flu"), options, path)


def _ros2(finished: Finished, options: ExportOptions, path: Path) -> None:
    write_ros2(finished.calibration(options, "flu"), options, path)


def _kalibr(finished: Finished, options: ExportOptions, path: Path) -> None:
    write_kalibr(finished.calibration(options, "frd"), finished.platform, path)


def _json(finished: Finished, options: ExportOptions, path: Path) -> None:
    write_json(finished.calibration(options, "frd"), options, path)


def _csv(finished: Finished, options: ExportOptions, path: Path) -> None:
    write_csv_pose(finished.calibration(options, "frd"), options, path)


EXPORTS: Final[dict[str, Exporter]] = {
    "urdf": Exporter("fixed joint from the body to the camera", ".urdf", _urdf),
    "ros2": Exporter("ROS 2 static transform: parameters and launch line", "-transform.yaml", _ros2),
    "kalibr": Exporter("camchain as Kalibr writes it", "-camchain.yaml", _kalibr),
    "json": Exporter("pose with covariance and conventions", ".json", _json),
    "csv": Exporter("pose with covariance, one row a parameter", ".csv", _csv),
    "geojson": Exporter("mapped points in WGS84", ".geojson", _points(write_geojson)),
    "geopackage": Exporter("mapped points in the survey's reference system", ".gpkg", _points(write_geopackage)),
}


def export_platform(
    results: Path,
    platform: Platform,
    name: str,
    format: str,
    output: Path,
    stage: str = "inliers",
    options: ExportOptions | None = None,
) -> Path:
    """Write one platform's calibration, or its mapped points, in a format of EXPORTS; the path that was written.

    `results` is the folder of all results, with the platform's in results/NAME. `output` is a file, or a folder in
    which one is named after platform and format. The file is written whole or not at all.
    Raises InputError for an unknown format or stage, and where the platform has not been run as far as that needs.
    """
    if format not in EXPORTS:
        near = get_close_matches(format, EXPORTS, n=1)
        remedy = f"did you mean {near[0]}?" if near else "choose one of them"
        raise InputError("format", repr(format), f"one of {', '.join(EXPORTS)}", remedy)
    exporter = EXPORTS[format]
    path = output / f"{name}{exporter.suffix}" if output.is_dir() else output
    finished = Finished(results, platform, name, stage)
    with atomic_write(path) as temporary:
        exporter.write(finished, options or ExportOptions(), temporary)
    return path
