"""The error budget of a scan: which source gives how many metres on the ground, at a line's centre and at its edge."""

from dataclasses import replace
from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa

from linepose.arrays import Floats
from linepose.output.map.places import ScanOnMap
from linepose.output.map.sources import SOURCES, Source
from linepose.tables import optional_floats, texts

BUDGET: Final = pa.schema(
    [*texts("scan", "place", "source"), *optional_floats("horizontal_m", "height_m", "radius_95_m")]
)
AS_REPORTED: Final = "navigation as reported"
ALL: Final = "all"
_LINES: Final = 101


def budget_table(scan: ScanOnMap) -> pd.DataFrame:
    """Medians over the scan's lines of what each source gives, and of all together; columns as in `BUDGET`.

    `horizontal_m`: root of the sum of the two map axes' variances; `radius_95_m`: the radius that holds 95 %. The edge
    is the end of the line with the larger one. `navigation as reported` stands beside what the levels make of it, and
    is no part of the whole. Null where no pixel has a place.
    """
    rows = np.unique(np.linspace(0, len(scan.time_us) - 1, _LINES).round().astype(int))
    some = replace(scan, time_us=scan.time_us[rows])
    reported = replace(some, mounted=replace(some.mounted, levels=None))
    parts: dict[str, Floats] = {source: _medians(some, (source,)) for source in SOURCES}
    if scan.mounted.levels is not None:
        parts[AS_REPORTED] = _medians(reported, ("navigation",))
    parts[ALL] = _medians(some, SOURCES)
    centre = int(np.clip(np.rint(scan.mounted.camera.principal_point_px), 0, scan.shape[1] - 1))
    ends = np.nan_to_num(parts[ALL][2, [0, -1]], nan=-1.0)
    edge = 0 if ends[0] > ends[1] else scan.shape[1] - 1
    return pd.DataFrame(
        [
            [scan.name, place, source, *(float(one) for one in values[:, pixel])]
            for place, pixel in (("centre", centre), ("edge", edge))
            for source, values in parts.items()
        ],
        columns=BUDGET.names,
    )


def _medians(scan: ScanOnMap, sources: tuple[Source, ...]) -> Floats:
    """Median over the lines of horizontal sigma, sigma of height, and radius; (3, P)."""
    sigma = scan.places(0, len(scan.time_us), sources).sigma_m.astype(float)
    values = np.stack([np.hypot(sigma[:, 0], sigma[:, 1]), sigma[:, 2], sigma[:, 3]])
    known = np.isfinite(values[0]).any(axis=0)
    medians = np.full((3, values.shape[2]), np.nan)
    medians[:, known] = np.nanmedian(values[:, :, known], axis=1)
    return medians
