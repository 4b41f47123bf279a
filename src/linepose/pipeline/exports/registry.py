"""The formats of export by name: entry points of the group `linepose.exports`, ours and others' alike."""

from typing import Final

from linepose.pipeline.exports.format import ExportFormat
from linepose.plugins import PluginGroup

EXPORTS: Final = PluginGroup("linepose.exports", ExportFormat, "format")
