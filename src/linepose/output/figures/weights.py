"""What the robust noise model makes of each view and point: weights, where outlier removal says in or out."""

from typing import Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from linepose.experiments.noise_models import WEIGHTS
from linepose.output.figures.entry import FigureEntry, without
from linepose.output.figures.style import BLUE, RED, WIDE_IN, blank_figure, styled
from linepose.pipeline.table_checks import usable_rows

_COLUMNS = ("observation", "point", "view_weight", "point_weight", "removed")


@styled
def weights(table: pd.DataFrame) -> Figure:
    """Bars of each view's weight above, a matrix of each point's below, observations across.

    `table` as in `WEIGHTS`; observations that outlier removal took out are red.
    """
    rows = usable_rows(table, _COLUMNS, "weights.parquet")
    views = rows.groupby("observation")[["view_weight", "removed"]].first()
    matrix = rows.pivot_table("point_weight", "point", "observation").to_numpy()
    points = np.sort(rows["point"].unique())
    figure = blank_figure(WIDE_IN, 3.9)
    bars, cells = figure.subplots(2, 1, sharex=True, height_ratios=[1, 1.5])
    place = np.arange(len(views))
    bars.bar(place, views["view_weight"], 0.8, color=np.where(views["removed"], RED, BLUE))
    bars.axhline(1.0, color="black", linewidth=0.6)
    bars.set_ylabel("Weight of the view")
    bars.grid(visible=False, axis="x")
    image = cells.pcolormesh(np.arange(len(views) + 1) - 0.5, np.arange(len(points) + 1) - 0.5, matrix, vmin=0.0)
    cells.set_yticks(np.arange(0, len(points), 2), points[::2])
    shown = slice(None, None, 1 + len(place) // 20)
    cells.set_xticks(place[shown], views.index[shown])
    cells.set(xlabel="Observation", ylabel="Point")
    cells.grid(visible=False)
    figure.colorbar(image, ax=cells, label="Weight of the point")
    handles = [Patch(color=BLUE, label="accepted by outlier removal"), Patch(color=RED, label="removed by it")]
    figure.legend(handles=handles, loc="outside upper center", ncols=2)
    return figure


def weights_caption(table: pd.DataFrame) -> str:
    """Which views have the lowest weights, and whether outlier removal took the same out."""
    views = table.groupby("observation")[["view_weight", "removed"]].first().sort_values("view_weight")
    lowest = ", ".join(f"{number} ({row['view_weight']:.2f})" for number, row in views.head(4).iterrows())
    n_removed = int(views["removed"].sum())
    among = int(views["removed"].head(n_removed).sum())
    point = table.loc[table["point_weight"].idxmin()]
    same = (
        f"Of the {n_removed} observations that outlier removal took out, {among} are among the {n_removed} of lowest "
        "weight here. "
        if n_removed
        else "Outlier removal took none out. "
    )
    return (
        "Weights under the robust noise model with all observations in: 1 as noisy as the levels say, towards 0 where "
        f"an error comes from the tail. The lowest of views: {lowest}. {same}The lowest of points: "
        f"{int(point['point'])} in observation {int(point['observation'])} ({point['point_weight']:.2f})."
    )


FIGURES: Final = (
    FigureEntry(
        "weights",
        "Weights of the robust noise model",
        "bars of each view's weight above a matrix of each point's, observations across",
        ("weights",),
        lambda r: weights(r.results.table("weights", WEIGHTS)),
        lambda r: weights_caption(r.results.table("weights", WEIGHTS)),
        without("noise_models"),
    ),
)
