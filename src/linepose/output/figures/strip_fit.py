"""Where overlapping scans put the same ground: how far apart, at the hand-measured pose and at the calibrated one."""

from typing import Final

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from linepose.output.figures.entry import FigureEntry
from linepose.output.figures.style import BLUE, RED, WIDE_IN, blank_figure, styled
from linepose.output.map.strip_fit import FIT, PATCHES
from linepose.output.map.words import fit_sentence
from linepose.pipeline.calibration import Calibration

_LONGEST: Final = 0.15  # of the longest arrow, as a share of the ground's extent
_COLUMNS: Final = [name for name in PATCHES.names if name.endswith("_m")]
_PANELS: Final = (("before", "Hand-measured pose", RED), ("after", "Calibrated pose", BLUE))


@styled
def strip_fit_map(patches: pd.DataFrame) -> Figure:
    """An arrow a patch, from where the first scan has it towards where the second has; `patches` as in `PATCHES`.

    Each panel's arrows are as long as its longest allows; its title tells how long that is.
    """
    figure = blank_figure(WIDE_IN, 2.9)
    panels = figure.subplots(1, 2)
    patches = patches[patches[_COLUMNS].notna().all(axis=1)]
    place = patches[["easting_m", "northing_m"]].to_numpy(dtype=float)
    origin = place.min(axis=0) if len(place) else np.zeros(2)
    extent = (float(np.ptp(place, axis=0).max()) if len(place) else 0.0) or 1.0
    for panel, (name, title, colour) in zip(panels, _PANELS, strict=True):
        off = patches[[f"{name}_east_m", f"{name}_north_m"]].to_numpy(dtype=float)
        panel.set_title(title)
        panel.set_aspect("equal")
        _draw(panel, place - origin, off, extent, colour)
        panel.set_xlabel("East (m)")
    panels[0].set_ylabel("North (m)")
    return figure


def _draw(panel: Axes, place: np.ndarray, off: np.ndarray, extent: float, colour: str) -> None:
    if not len(place):
        panel.text(0.5, 0.5, "no patch of two scans", ha="center", transform=panel.transAxes)
        return
    longest = float(np.linalg.norm(off, axis=1).max())
    scale = max(longest, 1e-9) / (_LONGEST * extent)  # metres of misfit per metre of the map
    panel.quiver(*place.T, *off.T, angles="xy", scale_units="xy", scale=scale, color=colour, width=0.006)
    ends = np.concatenate([place, place + off / scale])
    low, high, rim = ends.min(axis=0), ends.max(axis=0), 0.03 * extent
    panel.set(xlim=(low[0] - rim, high[0] + rim), ylim=(low[1] - rim, high[1] + rim))
    panel.set_title(f"{panel.get_title()}, longest {longest * 1e3:.0f} mm")


def _patches(calibration: Calibration) -> pd.DataFrame:
    """The patches; a table without rows is no fault here."""
    from linepose.tables import read_table

    path = calibration.results.path("strip_patches")
    return read_table(path, PATCHES) if path.is_file() else calibration.results.table("strip_patches", PATCHES)


def _caption(calibration: Calibration) -> str:
    told = fit_sentence(calibration.results.table("strip_fit", FIT).iloc[0])
    return (
        f"{told} Each arrow leads from where the map of one scan has a patch of ground to where that of another has "
        "it; all arrows of a panel are drawn to one scale of its own."
    )


FIGURES: Final = (
    FigureEntry(
        "strip_fit",
        "Do overlapping scans fit?",
        "arrows of how far apart overlapping scans put the same ground, before calibration and after",
        ("strip_patches", "strip_fit"),
        lambda r: strip_fit_map(_patches(r)),
        _caption,
        lambda platform: "" if platform.map else "The platform's file does not ask for maps: it has no section map.",
    ),
)
