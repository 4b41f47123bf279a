"""What a format of export is: one entry, from which command line, Python interface and documentation take all."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from linepose.pipeline.exports.options import ExportOptions

if TYPE_CHECKING:
    from linepose.pipeline.calibration import Calibration


@dataclass(frozen=True)
class ExportFormat:
    """A format's name, what it is in a few words, how its files end, and what writes a calibration to a path."""

    name: str
    title: str
    suffix: str
    write: Callable[["Calibration", ExportOptions, Path], None]
