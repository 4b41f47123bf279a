"""A platform of scans under the adjustment, whose principal point was found far off its file's; files and results."""

from pathlib import Path

import numpy as np

from linepose.config.platform import Platform, load_platform
from linepose.pipeline.calibration import Calibration
from linepose.pipeline.results import Results
from unit import made_up
from unit.recorded_files import write_scan_files

CONFIG = Path(__file__).parents[4] / "config"
HEIGHT_M = 0.05


def adjusted_scans(folder: Path, n_observations: int = 1, **changes) -> tuple[Platform, Path]:
    """The platform's file, and the folder of what it recorded: the first passes of the simulated Ladybird.

    With a `map_frame` they are about an origin, otherwise northings and eastings.
    """
    given = load_platform(CONFIG / "platforms", "ladybird-sim").model_dump(mode="json")
    ground = {"ground": "height", "height_m": HEIGHT_M}
    values = given | {"noise_model": "adjustment", "prior": "hand_measured", "map": ground} | changes
    if "map_frame" in changes:
        values["simulation"] = values["simulation"] | {"origin_m": (0.0, 0.0, 0.0)}
    platform, data = Platform.model_validate(values), folder / "data"
    write_scan_files(data, platform, n_observations)
    return platform, data


def adjusted_calibration(platform: Platform, folder: Path, data: Path) -> Calibration:
    """The made-up results of an adjustment as this platform's."""
    made_up.write_adjusted_results(folder)
    views = made_up.TABLES["adjusted_views"][0]()
    corrections = [name for name in views if name.startswith("correction_")]
    given = Calibration.from_results(folder, platform, data_folder=data)
    tables = given.tables()
    tables["adjusted_views"] = views.assign(**dict.fromkeys(corrections, np.float64(0.0)))
    return Calibration(
        Results(folder.name, folder, tables),
        platform.hand_measured,
        platform.intrinsics(),
        given.threshold_px,
        platform.noise_model,
        platform=platform,
        data_folder=data,
    )
