"""A scan's map in words."""

from typing import Any

import pandas as pd

from linepose.inputs.tie_points.patches import HALF, SEARCH
from linepose.output.map.budget import ALL
from linepose.output.map.platform_map import ScanMap
from linepose.output.map.rasters import GEOTIFF_ENDING

_MM: int = 1000
_MEANINGS = {
    "n_missed": "miss the ground",
    "n_outside": "leave the elevation model",
    "n_in_hole": "end in a hole of it",
    "n_met_twice": "meet the ground more than once",
}
_LEFT_OUT = {
    "n_uncorrelated": "were not found again",
    "n_contradicted": "are not borne out by others of their pair",
    "n_without_ground": "see no ground",
}
_WITHOUT_PLACE = ("n_missed", "n_outside", "n_in_hole")


def scan_sentence(made: ScanMap) -> str:
    """One line: how sure the places are at the centre and at the edge, and what was counted of the pixels."""
    whole = made.budget[made.budget["source"] == ALL].set_index("place")["radius_95_m"].astype(float)
    radii = [f"{whole[place] * _MM:.1f} mm at the {place}" for place in ("centre", "edge") if whole[place] >= 0]
    name = made.name + ("" if made.is_new else " (made before)")
    told = [f"{name}: 95 % within {', '.join(radii)}" if radii else f"{name}: no place on the ground"]
    told += [
        f"{made.counts[key]} of {made.n_pixels} pixels {words}" for key, words in _MEANINGS.items() if made.counts[key]
    ]
    told += _of_rasters(made)
    return "; ".join(told)


def budget_sentences(made: ScanMap) -> list[str]:
    """One line a place: how many millimetres of the horizontal standard deviation each source gives there."""
    told = []
    for place, rows in made.budget.groupby("place", sort=False):
        by_source = rows.set_index("source")["horizontal_m"].astype(float).dropna() * _MM
        parts = [f"{source} {value:.1f}" for source, value in by_source.items() if source != ALL]
        if parts:
            told.append(
                f"  one sigma at the {place}: {by_source[ALL]:.1f} mm; its sources, each alone: {', '.join(parts)}"
            )
    return told


def fit_sentence(fit: "pd.Series[Any]") -> str:
    """Whether overlapping scans fit, from the row of `FIT`: how far apart they lie, and what was compared."""
    count = {key: int(fit[key]) for key in fit.index if key.startswith("n_")}
    left_out = ", ".join(f"{count[key]} {words}" for key, words in _LEFT_OUT.items() if count[key])
    scans = f" Scans that could not be put on level ground: {count['n_scans_left_out']} of {count['n_scans']}."
    scans = scans if count["n_scans_left_out"] else ""
    if not count["n_compared"]:
        if not count["n_tried"]:
            side = 2 * (HALF + SEARCH) + 1
            return (
                f"No two of {count['n_scans']} scans share {side} by {side} pixels of level ground, so none was "
                f"compared.{scans}"
            )
        return f"Overlapping scans could not be compared: of {count['n_tried']} patches {left_out}.{scans}"
    after, before, pixel = (float(fit[key]) for key in ("rms_after_m", "rms_before_m", "pixel_m"))
    return (
        f"Overlapping scans lie {after * _MM:.0f} mm apart on the map, {after / pixel:.1f} pixels (RMS), and "
        f"{before * _MM:.0f} mm, {before / pixel:.1f} pixels, at the hand-measured pose: {count['n_compared']} patches "
        f"of {count['n_pairs']} pairs of scans" + (f" ({left_out})." if left_out else ".") + scans
    )


def _of_rasters(made: ScanMap) -> list[str]:
    """How large the cells are, how many have no pixel of their own, and how many pixels no cell."""
    cells = made.rasters
    if cells is None or not cells.n_rows:
        return []
    placed = made.n_pixels - sum(made.counts[key] for key in _WITHOUT_PLACE)
    known = cells.n_cells + cells.n_filled
    filled = f"{cells.n_filled} of {known} cells of {cells.cell_m:g} m are filled from beside"
    bands = ", ".join(map(str, cells.bands))
    geotiff = [f"GeoTIFF {made.name}{GEOTIFF_ENDING} of the band{'s' if len(cells.bands) > 1 else ''} {bands}"]
    unused = f"{placed - cells.n_cells} pixels are not the nearest of their cell's centre"
    return [filled, unused, *(geotiff if cells.bands else [])]
