"""All readers of the set, and the registered ones that the set must hold."""

import tomllib
from functools import cache
from pathlib import Path
from typing import get_args

from linepose.inputs.labels.registry import FORMATS as LABEL_FORMATS
from linepose.inputs.navigation.presets import PRESETS
from linepose.inputs.navigation.rosbag_poses import APPLANIX, NOVATEL, ODOMETRY, POSES
from linepose.inputs.navigation.rosbag_transforms import TRANSFORMS
from linepose.inputs.navigation.rosbag_vendors import FIX_KINDS, IMU_KINDS
from linepose.inputs.scans import scan_files
from linepose.inputs.source import ScansSection
from linepose.survey.targets.registry import KINDS
from unit.bad_input.bag_readers import bag_readers
from unit.bad_input.configuration_readers import configuration_readers
from unit.bad_input.log_readers import log_readers
from unit.bad_input.point_readers import point_readers
from unit.bad_input.reader import Reader
from unit.bad_input.scan_readers import scan_readers

_PROJECT = Path(__file__).parents[3] / "pyproject.toml"
_WRITERS = {"linepose.exports"}  # groups of entry points that read nothing
_OF_NO_REGISTRY = (
    "own csv",
    "own parquet",
    "attitude log",
    "covariances",
    "labels CSV",
    "source labelled_views",
    "points.control_points",
    "points.ground.dem",
    "map.dem",
    "config/platforms",
    "config/config.yaml",
    "config/datasets",
    "results",
)


@cache
def readers() -> dict[str, Reader]:
    """All readers by their names."""
    found = [*log_readers(), *bag_readers(), *scan_readers(), *point_readers(), *configuration_readers()]
    return {one.name: one for one in found}


def registered() -> set[str]:
    """What each registry of readers holds, and the readers of no registry."""
    groups = tomllib.loads(_PROJECT.read_text())["project"]["entry-points"]
    kinds = {"linepose.navigation_formats": "navigation format"}
    plugins = {f"{kinds.get(group, group)} {name}" for group in set(groups) - _WRITERS for name in groups[group]}
    messages = {ODOMETRY, *POSES, *NOVATEL, *APPLANIX, *TRANSFORMS}
    messages |= {kind for alike in (*FIX_KINDS, *IMU_KINDS) for kind in alike}
    return {
        *plugins,
        *(f"preset {name}" for name in PRESETS),
        *(f"message {kind.rpartition('/')[2]}" for kind in messages),
        *(f"scan {ending}" for ending in scan_files._READERS),
        *(f"line times {kind}" for kind in get_args(ScansSection.model_fields["time_stamps"].annotation)),
        *(f"labels {one.tool}" for one in LABEL_FORMATS),
        *(f"target {kind}" for kind in KINDS),
        *_OF_NO_REGISTRY,
    }
