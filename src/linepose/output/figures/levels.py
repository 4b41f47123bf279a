"""The levels that the adjustment found, with 95 % intervals, on what was known of them before."""

from collections.abc import Mapping
from typing import Final

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from linepose.output.adjusted import levels_by_set, set_in_words, without_adjustment
from linepose.output.figures.entry import FigureEntry
from linepose.output.figures.style import BLUE, GREEN, GREY, ORANGE, PURPLE, WIDE_IN, blank_figure, styled
from linepose.pipeline.table_checks import usable_rows

NAMES: Final = {
    "drift": "drift",
    "constant": "common to an observation",
    "white": "each measurement's own",
    "attitude": "attitude (factor)",
    "pixel": "pixel noise (factor)",
    "lateness": "lateness (lines)",
    "correlation_time_s": "drift lasts (s)",
}
_STYLES: Final = ((GREEN, "o"), (BLUE, "s"), (ORANGE, "D"), (PURPLE, "^"))
_SPREAD: Final = 0.6  # of a row, over which the sets are laid out


@styled
def levels(tables: Mapping[str, pd.DataFrame]) -> Figure:
    """Value and 95 % interval of each level, a mark a set of observations, on the prior's 95 % interval.

    `tables` as in `LEVELS`, by the set's name. The correlation time has an axis of its own.
    """
    figure = blank_figure(WIDE_IN, 2.6 + 0.2 * len(tables))
    scales, time = figure.subplots(2, 1, height_ratios=[len(NAMES) - 1, 1])
    _draw(scales, tables, [name for name in NAMES if name != "correlation_time_s"])
    scales.axvline(1.0, color="black", linewidth=0.6)
    scales.set_xlabel("Of what is reported or stated; lines")
    _draw(time, tables, ["correlation_time_s"])
    time.set_xlabel("Seconds")
    handles: list[Patch | Line2D] = [Patch(color=GREY, alpha=0.35, label="before the data, 95 %")]
    handles += [
        Line2D([], [], color=colour, marker=marker, linewidth=1.2, label=set_in_words(name))
        for name, (colour, marker) in _styled_sets(tables).items()
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=2)
    return figure


def _draw(axes: Axes, tables: Mapping[str, pd.DataFrame], names: list[str]) -> None:
    for place, (name, style) in enumerate(_styled_sets(tables).items()):
        rows = _rows(tables[name]).loc[names]
        height = np.arange(len(names)) + _SPREAD * ((place + 0.5) / len(tables) - 0.5)
        if place == 0:
            width = rows["prior_high"] - rows["prior_low"]
            axes.barh(np.arange(len(names)), width, 0.85, rows["prior_low"], color=GREY, alpha=0.35, linewidth=0)
        value, low, high = (rows[column].to_numpy(dtype=float) for column in ("value", "low", "high"))
        axes.hlines(height, low, high, color=style[0], linewidth=1.2)
        axes.plot(value, height, style[1], color=style[0], markersize=3.5)
    axes.set_xscale("log")
    axes.set_yticks(np.arange(len(names)), [NAMES[name] for name in names])
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.grid(visible=False, axis="y")
    axes.xaxis.set_major_formatter("{x:g}")


def _styled_sets(tables: Mapping[str, pd.DataFrame]) -> dict[str, tuple[str, str]]:
    return {name: _STYLES[place % len(_STYLES)] for place, name in enumerate(tables)}


def _rows(table: pd.DataFrame) -> pd.DataFrame:
    rows = usable_rows(table, ["level", "value", "prior_low", "prior_high"], "levels.parquet").set_index("level")
    missing = [name for name in NAMES if name not in rows.index]
    usable_rows(rows.iloc[:0] if missing else rows, [], "levels.parquet, rows of all levels")
    return rows


def levels_caption(tables: Mapping[str, pd.DataFrame]) -> str:
    """What the levels are multiples of, and which of them the data hardly tell."""
    name, table = next(iter(tables.items()))
    rows = _rows(table)
    wide = [
        NAMES[level]
        for level, row in rows.iterrows()
        if level in NAMES and np.log(row["high"] / row["low"]) > 0.8 * np.log(row["prior_high"] / row["prior_low"])
    ]
    told = f"The data say little of: {', '.join(wide)}." if wide else "The data narrow all of them."
    return (
        "The levels with 95 % intervals; the grey bars are what was known before the data. The first three are parts "
        "of the navigation's error in reported sigmas, attitude multiplies the reported attitude sigmas once more, "
        f"pixel noise is in stated sigmas, lateness in lines. From {set_in_words(name)}: {told}"
    )


FIGURES: Final = (
    FigureEntry(
        "levels",
        "Levels of the errors",
        "each level's value and 95 % interval on the interval of its prior, by set of observations",
        ("levels", "adjustment"),
        lambda r: levels(levels_by_set(r)),
        lambda r: levels_caption(levels_by_set(r)),
        without_adjustment,
    ),
)
