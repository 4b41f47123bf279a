"""From how far away the search still finds the optimum."""

from collections.abc import Sequence
from typing import Final

import numpy as np
import pandas as pd
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from linepose.experiments.basin import BASIN, BASIN_SUMMARY, Region
from linepose.experiments.basin import SECTION as BASIN_SECTION
from linepose.output.figures.entry import FigureEntry, without
from linepose.output.figures.style import BLACK, BLUE, HALF_PAGE_IN, blank_figure, few_ticks, styled
from linepose.pipeline.calibration import Calibration
from linepose.pipeline.table_checks import usable_rows

_FAILED = "#E8D9C5"
_RATES = ["success_rate", "success_rate_low", "success_rate_high"]
_NAMES = {
    "powell": "Powell, the paper's equations",
    "powell_in_front": "Powell, points in front of the camera",
    "wide": "rotations first, then Powell",
}


@styled
def basin(sweep: pd.DataFrame, region: Region) -> Figure:
    """One panel an optimiser: each start a cell over distance and angle, blue where it ended at the optimum.

    `sweep` as in `BASIN`; the line bounds the claimed region.
    """
    rows = usable_rows(sweep, ["optimiser", "distance_m", "angle_rad", "success"], "basin.parquet")
    optimisers = list(dict.fromkeys(rows["optimiser"]))
    figure = blank_figure(HALF_PAGE_IN, 0.5 + 2.1 * len(optimisers))
    panels = np.atleast_1d(figure.subplots(len(optimisers), 1, sharex=True))
    for panel, optimiser in zip(panels, optimisers, strict=True):
        part = rows[rows["optimiser"] == optimiser]
        grid = part.astype({"success": float}).pivot_table(index="angle_rad", columns="distance_m", values="success")
        distance, angle = _edges(grid.columns.to_numpy()), np.degrees(_edges(grid.index.to_numpy()))
        panel.grid(visible=False)
        panel.pcolormesh(distance, angle, grid.to_numpy(), cmap=ListedColormap([_FAILED, BLUE]), vmin=0, vmax=1)
        panel.plot([0, region.distance_m], [np.degrees(region.angle_rad), 0], color=BLACK, linewidth=1.5)
        panel.set_xlim(0, distance[-1])
        panel.set_ylim(0, angle[-1])
        panel.set_ylabel("Angle of the start (°)")
        panel.set_title(f"{_NAMES.get(optimiser, optimiser)}: {100 * part['success'].mean():.0f} %", loc="left")
        few_ticks(panel)
    panels[-1].set_xlabel("Distance of the start (m)")
    handles = [Patch(color=BLUE, label="found the optimum"), Patch(color=_FAILED, label="did not")]
    claimed = figure.axes[0].lines[0]
    claimed.set_label("claimed region")
    figure.legend(handles=[*handles, claimed], loc="outside upper center", ncols=3, columnspacing=0.9)
    return figure


def _edges(
    centres: Sequence[float] | np.ndarray[tuple[int], np.dtype[np.float64]],
) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    middle = np.asarray(centres, dtype=float)
    return np.concatenate([[0.0], (middle[:-1] + middle[1:]) / 2, [middle[-1] + middle[0]]])


def basin_caption(summary: pd.DataFrame, region: Region) -> str:
    """Success rates inside and outside the claimed region, with their intervals."""
    rows = usable_rows(summary, ["optimiser", "region"], "basin_summary.parquet")
    rows = rows[rows["region"].isin(["inside", "outside"])].dropna(subset=_RATES)  # a region may have no starts
    usable_rows(rows, _RATES, "basin_summary.parquet, regions inside and outside")
    parts = []
    for optimiser, part in rows.groupby("optimiser", sort=False):
        told = ", ".join(
            f"{100 * rate:.0f} % ({100 * low:.0f}-{100 * high:.0f} %) {name}"
            for name, rate, low, high in part[["region", *_RATES]].itertuples(index=False)
        )
        parts.append(f"{_NAMES.get(str(optimiser), optimiser)}: {told}")
    return (
        "Starts by their distance and angle from the optimum, one a cell, and whether the search ended there. "
        f"Successes inside and outside the claimed triangle below {region.distance_m:g} m and "
        f"{np.degrees(region.angle_rad):.0f}°, with 95 % intervals: {'; '.join(parts)}."
    )


def _basin(r: Calibration) -> Figure:
    settings = BASIN_SECTION.of(r.platform_file)
    assert settings is not None  # left_out says so before
    return basin(r.results.table("basin", BASIN), settings.region())


def _basin_caption(r: Calibration) -> str:
    settings = BASIN_SECTION.of(r.platform_file)
    assert settings is not None
    return basin_caption(r.results.table("basin_summary", BASIN_SUMMARY), settings.region())


FIGURES: Final = (
    FigureEntry(
        "basin",
        "Basin of attraction",
        "grid of starts over distance and angle, coloured by whether the search found the optimum",
        (
            "basin",
            "basin_summary",
        ),
        _basin,
        _basin_caption,
        without("basin"),
    ),
)
