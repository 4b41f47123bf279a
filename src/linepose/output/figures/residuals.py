"""What is left over at the optimum, by observation and by point."""

from collections.abc import Callable
from typing import Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from linepose.estimation.noise_models import noise_model
from linepose.output.figures.entry import FigureEntry
from linepose.output.figures.style import BLACK, BLUE, GREY, SKY, WIDE_IN, blank_figure, styled
from linepose.pipeline.calibration import Calibration
from linepose.pipeline.residual_tables import RESIDUALS, intraclass_correlation
from linepose.pipeline.table_checks import stage_rows, usable_rows

_COLUMNS = ("stage", "observation", "point", "error_px", "error_u_px", "error_v_px", "sigma_px")
_SPREAD = 0.5  # of a slot, over which the dots of one group are laid out
_NAMES = {"observation": "Observation", "point": "Point"}


@styled
def residuals(table: pd.DataFrame, by: str) -> Figure:
    """Errors along and across the scan line of the accepted observations, grouped by `observation` or `point`.

    Dots are single points, bars the group's mean, the band one mean sigma. `table` as in `RESIDUALS`.
    """
    rows = _inliers(table)
    groups = np.sort(rows[by].unique())
    slot = np.searchsorted(groups, rows[by])
    rank = rows.groupby(by).cumcount().to_numpy()
    count = rows.groupby(by)[by].transform("size").to_numpy()
    place = slot + _SPREAD * ((rank + 0.5) / count - 0.5)
    sigma = rows.groupby(by)["sigma_px"].mean().to_numpy()
    figure = blank_figure(WIDE_IN, 3.8)
    panels = figure.subplots(2, 1, sharex=True)
    for panel, column, where in ((panels[0], "error_u_px", "along"), (panels[1], "error_v_px", "across")):
        mean = rows.groupby(by)[column].mean().to_numpy()
        panel.bar(np.arange(len(groups)), 2 * sigma, 0.8, -sigma, color=SKY, alpha=0.35, linewidth=0)
        panel.scatter(place, rows[column], s=5, color=GREY, linewidths=0)
        panel.hlines(mean, np.arange(len(groups)) - 0.35, np.arange(len(groups)) + 0.35, color=BLUE, linewidth=1.6)
        panel.axhline(0.0, color=BLACK, linewidth=0.6)
        panel.set_ylabel(f"Error {where} the line (px)")
        panel.grid(visible=False, axis="x")
        panel.use_sticky_edges = False
        panel.margins(x=0.01, y=0.05)
    panels[1].set_xticks(np.arange(len(groups)), groups)
    panels[1].set_xlabel(_NAMES[by])
    handles = [
        Line2D([], [], color=GREY, marker="o", markersize=2.5, linestyle="none", label="one point"),
        Line2D([], [], color=BLUE, linewidth=1.6, label="mean"),
        Patch(color=SKY, alpha=0.35, label="± 1 sigma expected"),
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=3)
    return figure


def residuals_caption(table: pd.DataFrame, by: str, independent: bool = True) -> str:
    """How large the errors are beside their sigmas, and what they have in common.

    `independent`: whether the noise model takes the points of a view to err independently.
    """
    rows = _inliers(table)
    rms = float(np.sqrt((rows["error_px"] ** 2).mean()))
    expected = float(np.sqrt((rows["sigma_px"] ** 2).mean()))
    size = f"RMS error {rms:.1f} px, where sigmas of {expected:.1f} px in its direction were expected. "
    if by == "observation":
        common = max(intraclass_correlation(rows, column) for column in ("error_u_px", "error_v_px"))
        beside = "where the published noise model takes them as independent" if independent else "which is allowed for"
        told = (
            ""
            if np.isnan(common)
            else f"Up to {100 * max(common, 0):.0f} % of the variance is common to all points of a view, {beside}."
        )
        return f"Observed minus reprojected position by observation. {size}{told}".strip()
    means = rows.groupby(by)[["error_u_px", "error_v_px"]].mean().abs().max(axis=1)
    return (
        "Observed minus reprojected position by point. " + size + f"The largest mean is {means.max():.1f} px, at point "
        f"{means.idxmax()}: a point that stands out would be mislabelled or badly printed."
    )


def _inliers(table: pd.DataFrame) -> pd.DataFrame:
    return stage_rows(usable_rows(table, _COLUMNS, "residuals.parquet"), "inliers", _COLUMNS, "residuals.parquet")


def _residuals(by: str) -> Callable[[Calibration], Figure]:
    return lambda r: residuals(r.results.table("residuals", RESIDUALS), by)


def _residuals_caption(by: str) -> Callable[[Calibration], str]:
    return lambda r: residuals_caption(
        r.results.table("residuals", RESIDUALS), by, noise_model(r.noise_model).removes_outliers
    )


FIGURES: Final = (
    FigureEntry(
        "residuals_by_observation",
        "Residuals by observation",
        "errors along and across the scan line by observation, with their sigmas",
        ("residuals",),
        _residuals("observation"),
        _residuals_caption("observation"),
    ),
    FigureEntry(
        "residuals_by_point",
        "Residuals by point",
        "errors along and across the scan line by point of the pattern, with their sigmas",
        ("residuals",),
        _residuals("point"),
        _residuals_caption("point"),
    ),
)
