"""The scan that figures show: that of the first accepted observation, with the points found in it."""

from dataclasses import dataclass

import pandas as pd

from linepose.config.platform import ScansSection
from linepose.errors import InputError
from linepose.extraction.scan_survey import select_scans
from linepose.extraction.scans import read_intensity
from linepose.figures.results import PlatformResults
from linepose.figures.scan import Intensity
from linepose.result_schemas import SCAN_POINTS


@dataclass(frozen=True)
class ScanExample:
    """One observation's scan lines (L, P) and the points found in it: point, u_px, line."""

    observation: int
    intensity: Intensity
    points: pd.DataFrame


def scan_example(results: PlatformResults) -> ScanExample:
    """The example of a platform with scans; raises InputError where it has none."""
    source, folder = results.platform.source, results.data_folder
    if not isinstance(source, ScansSection) or folder is None:
        raise InputError(results.name, "no scans", "scan images", "give source.scans in the platform's file")
    observation = results.accepted()[0]
    path = select_scans(folder, source.scans, source.left_out)[observation]
    points = results.table("points", SCAN_POINTS)
    return ScanExample(observation, read_intensity(path), points[points["observation"] == observation])
