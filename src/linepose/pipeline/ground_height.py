"""The height of the ground that strips are rectified on to begin with: as it is told, or of the height model."""

import logging
from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from linepose.arrays import Floats
from linepose.config.platform import Platform
from linepose.errors import InputError
from linepose.inputs.source import ScansSection
from linepose.inputs.terrain import read_terrain
from linepose.pipeline.survey_frame import map_frame_table, survey_frame

_APART: Final = 25  # lines between places of a strip at which the model is asked
_COVERED: Final = 0.5  # of these places, below which a height model is not the survey's

log = logging.getLogger(__name__)


def ground_down_m(platform: Platform, folder: Path, positions_m: Sequence[Floats], origin_m: Floats) -> float:
    """Down of the ground from an origin (3,), to begin with, below strips whose lines lie at positions (L, 3) from it.

    A height that the platform's file tells counts before the height model, of which it is the median below the strips.
    Raises InputError where neither is given, or the model does not cover the strips.
    """
    assert isinstance(platform.source, ScansSection)
    height_m = platform.source.matching.ground_height_m
    ground = None if platform.points is None else platform.points.ground
    if height_m is None and ground is not None and ground.height_m is not None:
        height_m = ground.height_m + ground.height_offset_m
    if height_m is not None:
        return float(-height_m - origin_m[2])
    if ground is None or ground.dem is None:
        found, expected = "no height of the ground", "one to a tenth of the range"
        raise InputError("source.matching.ground_height_m", found, expected, "add it (m), or points.ground")
    section = None if platform.map_frame is None else platform.map_frame.model_dump()
    frame = survey_frame(section, map_frame_table(platform, folder) if section is None else pd.DataFrame())
    terrain = read_terrain(folder / ground.dem, frame, origin_m, ground.height_offset_m)
    below = np.concatenate([position[::_APART, :2] for position in positions_m])
    covered = terrain.covers(below)
    if covered.mean() < _COVERED:
        north, east = below[int(np.argmin(covered))] + origin_m[:2]
        raise InputError(
            str(folder / ground.dem),
            f"no height below {np.sum(~covered)} of {len(covered)} places of the strips, one near north {north:.1f}, "
            f"east {east:.1f} m",
            "heights all over the survey",
            "give a larger model, or check map_frame",
        )
    down_m = float(np.median(terrain(below[covered])[0]))
    log.info("ground at a height of %.1f m to begin with, by %s", -(down_m + origin_m[2]), ground.dem)
    return down_m
