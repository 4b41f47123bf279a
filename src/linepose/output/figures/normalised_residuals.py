"""Whether the errors are as the adjusted levels say: normalised residuals against a normal distribution."""

from typing import Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from scipy.stats import beta, norm

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.output.adjusted import without_adjustment
from linepose.output.figures.entry import FigureEntry
from linepose.output.figures.style import BLACK, BLUE, GREY, WIDE_IN, blank_figure, styled
from linepose.pipeline.adjusted_schemas import MEASUREMENTS, NORMALISED_COLUMNS
from linepose.pipeline.table_checks import usable_rows

_TITLES: Final = ("along the scan line", "across it")
_SHARE: Final = 0.95  # of what chance gives, between the edges of the band
_TAIL: Final = 3.0  # beyond which a normal number lies once in 370


@styled
def normalised_residuals(measurements: pd.DataFrame) -> Figure:
    """Sorted residuals against what as many normal numbers would be, along and across the scan line.

    The band holds each of them with 95 % if the levels are right. `measurements` as in `MEASUREMENTS`.
    """
    figure = blank_figure(WIDE_IN, 2.9)
    panels = figure.subplots(1, 2, sharey=True)
    for panel, column, title in zip(panels, NORMALISED_COLUMNS, _TITLES, strict=True):
        values = _known(measurements, column)
        middle, low, high = expected(len(values))
        panel.fill_between(middle, low, high, color=GREY, alpha=0.4, linewidth=0, label="95 % by chance")
        panel.plot(middle, middle, color=BLACK, linewidth=0.7, label="normal")
        panel.plot(middle, values, ".", color=BLUE, markersize=3, label="one measurement")
        panel.set_title(title, loc="left")
        panel.set_xlabel("Expected (sigmas)")
    panels[0].set_ylabel("Normalised residual (sigmas)")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside upper center", ncols=3)
    return figure


def normalised_residuals_caption(measurements: pd.DataFrame) -> str:
    """The spread of the residuals, where one is expected, and how many lie far out."""
    values = [_known(measurements, column) for column in NORMALISED_COLUMNS]
    far = sum(int((np.abs(one) > _TAIL).sum()) for one in values)
    by_chance = 2 * norm.sf(_TAIL) * sum(len(one) for one in values)
    return (
        "What is left of each measurement, in units of what the adjusted levels expect, sorted, against as many "
        f"normal numbers. Their standard deviation is {values[0].std():.2f} along the line and {values[1].std():.2f} "
        f"across it, expected 1. {far} lie beyond {_TAIL:g} sigmas, expected {by_chance:.1f}. Points on the line, "
        "inside the band: the model of the errors fits. Ends that turn away from it: a few measurements err more than "
        "the rest. Points flatter than the line: errors are smaller than the levels say."
    )


def expected(count: int) -> tuple[Floats, Floats, Floats]:
    """Of so many sorted normal numbers: the median of each, and what holds it with 95 %; (count,) each."""
    rank = np.arange(1, count + 1)
    shares = (0.5, (1 - _SHARE) / 2, (1 + _SHARE) / 2)
    middle, low, high = (np.asarray(norm.ppf(beta.ppf(share, rank, count + 1 - rank))) for share in shares)
    return middle, low, high


def _known(measurements: pd.DataFrame, column: str) -> Floats:
    values = usable_rows(measurements, ["observation"], "adjusted_measurements.parquet")[column].to_numpy(dtype=float)
    known = np.sort(values[np.isfinite(values)])
    if not known.size:
        raise InputError("adjusted_measurements.parquet", f"no {column}", "a residual", "use more observations")
    return known


FIGURES: Final = (
    FigureEntry(
        "normalised_residuals",
        "Normalised residuals",
        "sorted normalised residuals along and across the scan line against normal quantiles, with a band of chance",
        ("adjusted_measurements",),
        lambda r: normalised_residuals(r.results.table("adjusted_measurements", MEASUREMENTS)),
        lambda r: normalised_residuals_caption(r.results.table("adjusted_measurements", MEASUREMENTS)),
        without_adjustment,
    ),
)
