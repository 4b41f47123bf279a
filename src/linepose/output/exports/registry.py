"""Every format of export, one entry each."""

from typing import Final

from linepose.output.exports import csv_file, geojson, geopackage, json_file, kalibr, ros2, urdf
from linepose.output.exports.format import ExportFormat

_FORMATS: Final[tuple[ExportFormat, ...]] = (
    urdf.FORMAT,
    ros2.FORMAT,
    kalibr.FORMAT,
    json_file.FORMAT,
    csv_file.FORMAT,
    geojson.FORMAT,
    geopackage.FORMAT,
)
EXPORTS: Final[dict[str, ExportFormat]] = {one.name: one for one in _FORMATS}
