"""The mean error of every observation at each stage of the outlier removal."""

from typing import Final

import numpy as np
import pandas as pd
from matplotlib.colors import LogNorm
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle
from matplotlib.ticker import FormatStrFormatter, LogLocator

from linepose.estimation.outliers import OUTLIERS, removal_order
from linepose.output.figures.entry import FigureEntry, without_removal
from linepose.output.figures.style import RED, WIDE_IN, blank_figure, styled
from linepose.pipeline.table_checks import accepted_rows, usable_rows

_COLUMNS = ("n_observations", "observation", "error_px", "removed", "accepted")
_LEAST_PX = 0.1


@styled
def outlier_matrix(outliers: pd.DataFrame) -> Figure:
    """Cells coloured by mean reprojection error, crossed where removed next, then white; the accepted row framed.

    `outliers` as in `OUTLIERS`.
    """
    table = usable_rows(outliers, _COLUMNS, "outliers.parquet")
    errors = table.pivot_table(index="n_observations", columns="observation", values="error_px").sort_index(
        ascending=False
    )
    sizes, numbers = errors.index.to_numpy(), errors.columns.to_numpy()
    figure = blank_figure(WIDE_IN, 1.4 + 0.15 * len(sizes))
    axes = figure.add_subplot()
    axes.grid(visible=False)
    edges = np.arange(len(numbers) + 1) - 0.5, np.arange(len(sizes) + 1) - 0.5
    scale = LogNorm(max(table["error_px"].min(), _LEAST_PX), max(table["error_px"].max(), 2 * _LEAST_PX))
    mesh = axes.pcolormesh(
        *edges, np.ma.masked_invalid(errors.to_numpy()), norm=scale, edgecolors="white", linewidth=0.8
    )
    removed = table[table["removed"]]
    axes.plot(
        np.searchsorted(numbers, removed["observation"]),
        [int(np.flatnonzero(sizes == size)[0]) for size in removed["n_observations"]],
        linestyle="none",
        marker="x",
        markersize=4,
        markeredgewidth=1.2,
        color=RED,
        label="removed next",
    )
    accepted = int(np.flatnonzero(sizes == accepted_rows(table)["n_observations"].iloc[0])[0])
    frame = Rectangle((-0.5, accepted - 0.5), len(numbers), 1, fill=False, edgecolor=RED, linewidth=1.8)
    frame.set(label="accepted", clip_on=False, zorder=3)
    axes.add_patch(frame)
    step = 1 + len(numbers) // 26
    axes.set_xticks(np.arange(0, len(numbers), step), numbers[::step])
    axes.set_yticks(np.arange(len(sizes)), sizes)
    axes.tick_params(length=0)
    axes.set(xlabel="Observation", ylabel="Observations used")
    axes.set_xlim(-0.5, len(numbers) - 0.5)
    axes.set_ylim(len(sizes) - 0.5, -0.5)
    bar = figure.colorbar(
        mesh, ax=axes, label="Mean reprojection error (px)", location="bottom", pad=0.02, aspect=40, shrink=0.7
    )
    bar.ax.xaxis.set_major_locator(LogLocator(10, (1, 2, 5)))
    bar.ax.xaxis.set_major_formatter(FormatStrFormatter("%g"))
    bar.ax.minorticks_off()
    figure.legend(*axes.get_legend_handles_labels(), loc="outside upper center", ncols=2)
    return figure


def outlier_matrix_caption(outliers: pd.DataFrame, threshold_px: float) -> str:
    """What was removed, in which order, and what remains."""
    accepted = accepted_rows(outliers)
    order = removal_order(outliers)
    first = outliers[outliers["n_observations"] == outliers["n_observations"].max()]
    removed = f"Removed in this order: {', '.join(map(str, order))}." if order else "None was removed."
    return (
        f"Mean reprojection error of each observation (column) at each stage (row) of the outlier removal. {removed} "
        f"The framed row is the first in which every error is below {threshold_px:g} px: {len(accepted)} of "
        f"{len(first)} observations remain, the worst at {accepted['error_px'].max():.1f} px."
    )


FIGURES: Final = (
    FigureEntry(
        "outliers",
        "Outlier removal",
        "matrix of mean errors, observations across, stages of the removal down, the accepted row framed",
        ("outliers",),
        lambda r: outlier_matrix(r.results.table("outliers", OUTLIERS)),
        lambda r: outlier_matrix_caption(r.results.table("outliers", OUTLIERS), r.threshold_px),
        without_removal("The adjustment removes no observation: see the figure on weights."),
    ),
)
