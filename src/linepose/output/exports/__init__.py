"""A finished calibration taken away: one format a file, listed in `registry`."""

from linepose.output.exports.options import ExportOptions, export_options
from linepose.output.exports.registry import EXPORTS
from linepose.output.exports.write import export_calibration

__all__ = ["EXPORTS", "ExportOptions", "export_calibration", "export_options"]
