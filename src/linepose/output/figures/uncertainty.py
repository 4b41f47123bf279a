"""One standard deviation of each pose parameter against the number of observations."""

from typing import Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from linepose.experiments.uncertainty import UNCERTAINTY
from linepose.geometry.pose import SIGMA_COLUMNS
from linepose.output.figures.entry import FigureEntry, without_removal
from linepose.output.figures.style import BLACK, BLUE, GREEN, HALF_PAGE_IN, RED, blank_figure, styled
from linepose.pipeline.table_checks import stage_rows, usable_rows

_COLOURS = (BLUE, RED, GREEN)
_MARKERS = ("o", "s", "^")
_NAMES = (("$r_x$", "$r_y$", "$r_z$"), (r"$\theta e_x$", r"$\theta e_y$", r"$\theta e_z$"))


@styled
def uncertainty(table: pd.DataFrame) -> Figure:
    """Sampled sigmas as marked lines, the curvature's as dashes; position above, rotation below.

    `table` as in `UNCERTAINTY`.
    """
    rows = usable_rows(table, ["stage", "method", "n_observations", *SIGMA_COLUMNS], "uncertainty.parquet")
    figure = blank_figure(HALF_PAGE_IN, 3.9)
    panels = figure.subplots(2, 1, sharex=True)
    for panel, columns, names, unit, scale in (
        (panels[0], SIGMA_COLUMNS[:3], _NAMES[0], "position (mm)", 1e3),
        (panels[1], SIGMA_COLUMNS[3:], _NAMES[1], "rotation (°)", float(np.degrees(1.0))),
    ):
        for column, name, colour, marker in zip(columns, names, _COLOURS, _MARKERS, strict=True):
            for method, style in (("mcmc", f"-{marker}"), ("laplace", "--")):
                part = rows[rows["method"] == method].sort_values("n_observations")
                label = name if method == "mcmc" else None
                panel.plot(
                    part["n_observations"], scale * part[column], style, color=colour, label=label, linewidth=0.9
                )
        panel.set_ylabel(f"Sigma of {unit}")
        panel.set_ylim(bottom=0)
        panel.legend(ncols=3, loc="lower right", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.1)
    panels[1].set_xlabel("Observations used")
    panels[1].xaxis.set_major_locator(MaxNLocator(integer=True))
    accepted = int(stage_rows(rows, "inliers", SIGMA_COLUMNS, "uncertainty.parquet")["n_observations"].iloc[0])
    for panel in panels:
        panel.axvline(accepted, color=BLACK, linewidth=0.6, linestyle=":")
    handles = [
        Line2D([], [], color=BLACK, marker="o", linewidth=0.9, label="sampled"),
        Line2D([], [], color=BLACK, linestyle="--", linewidth=0.9, label="curvature"),
        Line2D([], [], color=BLACK, linestyle=":", linewidth=0.6, label="accepted"),
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=3)
    return figure


def uncertainty_caption(table: pd.DataFrame) -> str:
    """The largest sigmas of all observations and of the accepted ones."""
    sampled = table[table["method"] == "mcmc"]
    sigmas = [
        stage_rows(sampled, stage, SIGMA_COLUMNS, "uncertainty.parquet")[list(SIGMA_COLUMNS)].iloc[0]
        for stage in ("all", "inliers")
    ]
    told = [f"{1e3 * sigma.iloc[:3].max():.0f} mm and {np.degrees(sigma.iloc[3:].max()):.2f}°" for sigma in sigmas]
    return (
        "One standard deviation of each pose parameter at each stage of the outlier removal, from the samples and from "
        f"the likelihood's curvature. The largest: {told[0]} with all observations, {told[1]} with the accepted ones. "
        "Fewer observations give larger sigmas; that the outliers were wrong does not show in them."
    )


FIGURES: Final = (
    FigureEntry(
        "uncertainty",
        "Uncertainty against observations",
        "lines of the sigma of each pose parameter against the number of observations",
        ("uncertainty",),
        lambda r: uncertainty(r.results.table("uncertainty", UNCERTAINTY)),
        lambda r: uncertainty_caption(r.results.table("uncertainty", UNCERTAINTY)),
        without_removal("The adjustment removes no observation: its sigmas are those of all of them."),
    ),
)
