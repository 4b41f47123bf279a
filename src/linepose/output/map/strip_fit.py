"""Whether maps fit: how far apart the same ground lies in two scans that overlap, before calibration and after."""

import logging
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.inputs.rectified.rectify import Rectified, line_poses, rectify
from linepose.inputs.rectified.surface import Surface, flat_ground
from linepose.inputs.scans.scan_files import read_intensity
from linepose.inputs.tie_points.patches import Patches, patches_of
from linepose.output.map.places import ScanOnMap
from linepose.output.map.platform_map import PlatformMap
from linepose.tables import floats, optional_floats, texts, whole_numbers

_logger = logging.getLogger(__name__)
PATCHES: Final = pa.schema(
    [
        *texts("first", "second"),
        *floats("first_line", "first_u_px", "second_line", "second_u_px", "correlation"),
        *optional_floats("easting_m", "northing_m"),
        *optional_floats("before_east_m", "before_north_m", "after_east_m", "after_north_m"),
    ]
)
FIT: Final = pa.schema(
    [
        *whole_numbers("n_scans", "n_scans_left_out", "n_pairs", "n_tried", "n_uncorrelated", "n_contradicted"),
        *whole_numbers("n_without_ground", "n_compared"),
        *optional_floats("pixel_m", "rms_before_m", "rms_after_m"),
    ]
)
FIT_TABLES: Final = {"strip_patches": PATCHES, "strip_fit": FIT}
_AFTER: Final = ("after_east_m", "after_north_m")
_BEFORE: Final = ("before_east_m", "before_north_m")


@dataclass(frozen=True, eq=False)
class _Strip:
    """A scan rectified at the calibrated pose, and what its places rest on before and after."""

    rectified: Rectified
    before: ScanOnMap
    after: ScanOnMap


def strip_fit(before: PlatformMap, after: PlatformMap) -> dict[str, pd.DataFrame]:
    """Tables of what lies apart by the name of the workflow's result; columns as in `FIT_TABLES`.

    Patches of scans are found in others by correlation on a level surface, rectified at the calibrated pose (`after`);
    what is told is how far apart the two scans' maps then put such a patch, on the ground of the maps. `before` are the
    maps at the hand-measured pose. `rms_*_m` are of the horizontal distance; `pixel_m` is what a pixel sees. A scan
    that cannot be rectified (too short, no ground, too large) is left out, counted and told.
    """
    scans = {number: after.scan_on_map(number) for number in after.paths}
    pixel_m = float(np.nanmedian([_pixel_m(one) for one in scans.values()]))
    if not pixel_m > 0:
        return _tables([], [], (len(scans), len(scans)), np.nan)
    surface = _level(list(scans.values()))
    strips = []
    for number, scan in scans.items():
        intensity = read_intensity(after.paths[number], scan.mounted.camera.n_pixels)
        poses = line_poses(*scan.bodies(0, scan.shape[0])[:2], scan.mounted.pose)
        try:
            rectified = rectify(intensity, poses, scan.mounted.camera, surface, pixel_m)
        except InputError as error:
            _logger.warning("%s is not compared with other scans: found %s", scan.name, error.found)
            continue
        strips.append(_Strip(rectified, before.scan_on_map(number), scan))
    found, compared = [], []
    for first, second in combinations(strips, 2):
        patches = patches_of(first.rectified, second.rectified)
        if patches.n_tried:
            found.append(patches)
            compared.append(_compared(first, second, patches))
    return _tables(found, compared, (len(scans), len(scans) - len(strips)), pixel_m)


def _pixel_m(scan: ScanOnMap) -> float:
    """The usual distance of neighbouring pixels on the ground (m), of a scan's middle line; NaN where it has none."""
    middle = scan.shape[0] // 2
    place = scan.places(middle, middle + 1, ()).place_m[0, :2]
    apart = np.linalg.norm(np.diff(place, axis=1), axis=0)
    return float(np.nanmedian(apart)) if np.isfinite(apart).any() else float("nan")


def _level(scans: Sequence[ScanOnMap]) -> Surface:
    """Level ground at the height of what the scans' middle lines see."""
    return flat_ground(float(np.nanmedian(np.concatenate([scan.down_m(scan.shape[0] // 2) for scan in scans]))))


def _compared(first: _Strip, second: _Strip, patches: Patches) -> pd.DataFrame:
    """One row a patch; columns as in `PATCHES`."""
    at = [first.after.places_of(*patches.first.T), second.after.places_of(*patches.second.T)]
    hand = [first.before.places_of(*patches.first.T), second.before.places_of(*patches.second.T)]
    columns: dict[str, Floats] = dict(zip(("first_line", "first_u_px"), patches.first.T, strict=True))
    columns |= dict(zip(("second_line", "second_u_px"), patches.second.T, strict=True))
    columns |= {"correlation": patches.correlation}
    columns |= dict(zip(("easting_m", "northing_m"), at[0][:, :2].T, strict=True))
    columns |= dict(zip(_BEFORE, (hand[1] - hand[0])[:, :2].T, strict=True))
    columns |= dict(zip(_AFTER, (at[1] - at[0])[:, :2].T, strict=True))
    return pd.DataFrame(columns).assign(first=first.after.name, second=second.after.name)[PATCHES.names]


def _tables(
    found: Sequence[Patches], compared: Sequence[pd.DataFrame], n_scans: tuple[int, int], pixel_m: float
) -> dict[str, pd.DataFrame]:
    patches = pd.concat(compared, ignore_index=True) if compared else PATCHES.empty_table().to_pandas()
    both = patches.dropna(subset=[*_BEFORE, *_AFTER])
    row = {
        "n_scans": n_scans[0],
        "n_scans_left_out": n_scans[1],
        "n_pairs": len(found),
        "n_tried": sum(one.n_tried for one in found),
        "n_uncorrelated": sum(one.n_uncorrelated for one in found),
        "n_contradicted": sum(one.n_contradicted for one in found),
        "n_without_ground": len(patches) - len(both),
        "n_compared": len(both),
        "pixel_m": pixel_m,
        "rms_before_m": _rms(both, _BEFORE),
        "rms_after_m": _rms(both, _AFTER),
    }
    return {"strip_patches": patches, "strip_fit": pd.DataFrame([row])}


def _rms(patches: pd.DataFrame, columns: tuple[str, str]) -> float:
    """Root of the mean squared horizontal distance (m); NaN where nothing was compared."""
    if patches.empty:
        return float("nan")
    return float(np.sqrt(np.mean(np.sum(patches[list(columns)].to_numpy(dtype=float) ** 2, axis=1))))
