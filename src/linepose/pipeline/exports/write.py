"""A calibration in a format, whole or not at all."""

from pathlib import Path
from typing import TYPE_CHECKING

from linepose.pipeline.exports.options import ExportOptions
from linepose.pipeline.exports.registry import EXPORTS
from linepose.tables import atomic_write

if TYPE_CHECKING:
    from linepose.pipeline.calibration import Calibration


def export_calibration(
    calibration: "Calibration", format: str, output: Path, options: ExportOptions | None = None
) -> Path:
    """Write a calibration's pose, or the points it maps, in a format of EXPORTS; the path that was written.

    `output` is a file, or a folder in which one is named after platform and format. The file is written whole or not at
    all. Raises InputError for an unknown format or stage, and where the platform has not been run as far as that needs.
    """
    chosen = EXPORTS.member(format)
    path = output / f"{calibration.name}{chosen.suffix}" if output.is_dir() else output
    with atomic_write(path) as temporary:
        chosen.write(calibration, options or ExportOptions(), temporary)
    return path
