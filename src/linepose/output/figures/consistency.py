"""Whether disjoint observations agree as the sigmas promise, under the published and the shared noise model."""

from typing import Any, Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from scipy.stats import chi

from linepose.errors import InputError
from linepose.estimation.noise_models import noise_model
from linepose.experiments.consistency import CONSISTENCY, CONSISTENCY_SUMMARY
from linepose.geometry.pose import N_PARAMETERS
from linepose.output.figures.entry import FigureEntry, without
from linepose.output.figures.style import BLACK, GREY, WIDE_IN, blank_figure, styled
from linepose.pipeline.table_checks import usable_rows

_STYLES: Final = ("-", "--", "-.", ":")
_MARKERS: Final = ("D", "v", "X", "P")
_MOST: Final = 8.0  # sigmas shown: nothing beyond is a matter of degree


@styled
def consistency(table: pd.DataFrame) -> Figure:
    """Share of the pairs nearer than a distance, over the distance in sigmas, beside what right sigmas would give.

    Lines are random halves, marks single pairs at their distance's probability. `table` as in
    `CONSISTENCY`.
    """
    rows = _known(table)
    figure = blank_figure(WIDE_IN, 4.2)
    axes = figure.add_subplot()
    shown = np.linspace(0, _MOST, 300)
    axes.plot(shown, chi.cdf(shown, N_PARAMETERS), color=BLACK, linewidth=2.0)
    handles = [Line2D([], [], color=BLACK, linewidth=2.0, label="right sigmas")]
    handles += [
        Line2D([], [], color=noise_model(name).colour, linewidth=2.4, label=name)
        for name in rows["noise_model"].unique()
    ]
    halves, single = 0, 0
    for name, part in rows.groupby("comparison", sort=False):
        one = int(part["split"].max()) == 0
        style: dict[str, Any] = (
            {"marker": _MARKERS[single % 4], "linestyle": "none"} if one else {"linestyle": _STYLES[halves % 4]}
        )
        handles.append(Line2D([], [], color=GREY, label=str(name), **style))
        for model, distances in part.groupby("noise_model", sort=False)["mahalanobis"]:
            ordered = np.sort(np.minimum(distances.to_numpy(), 0.985 * _MOST))
            share = chi.cdf(ordered, N_PARAMETERS) if one else np.arange(1, len(ordered) + 1) / len(ordered)
            axes.plot(ordered, share, color=noise_model(str(model)).colour, drawstyle="steps-post", **style)
        single, halves = single + one, halves + (not one)
    axes.set(
        xlabel="Distance of the two poses (sigmas)", ylabel="Share of pairs below", xlim=(0, _MOST), ylim=(0, 1.02)
    )
    figure.legend(handles=handles, loc="outside upper left", ncols=1)
    return figure


def consistency_caption(summary: pd.DataFrame) -> str:
    """What each model's sigmas would have to be multiplied by; `summary` as in `CONSISTENCY_SUMMARY`."""
    told = []
    for name, part in summary.groupby("comparison", sort=False):
        factors = ", ".join(f"{row['sigma_factor']:.2f} {row['noise_model']}" for _, row in part.iterrows())
        told.append(f"{name}: {factors}")
    return (
        "Distances between poses from disjoint observations. What the sigmas would have to be multiplied by for the "
        f"median to be right: {'; '.join(told)}. Random halves of one set of observations are not independent of each "
        "other, and a distance beyond the axis is drawn at its end."
    )


def _known(table: pd.DataFrame) -> pd.DataFrame:
    rows = usable_rows(table, ["noise_model", "comparison", "split"], "consistency.parquet")
    known = rows[np.isfinite(rows["mahalanobis"].to_numpy(dtype=float))]
    if known.empty:
        raise InputError("consistency.parquet", "no distance", "poses with sigmas", "use more observations")
    return known


FIGURES: Final = (
    FigureEntry(
        "consistency",
        "Agreement of disjoint observations",
        "cumulative distribution of the distance in sigmas between poses from disjoint observations, by noise model",
        (
            "consistency",
            "consistency_summary",
        ),
        lambda r: consistency(r.results.table("consistency", CONSISTENCY)),
        lambda r: consistency_caption(r.results.table("consistency_summary", CONSISTENCY_SUMMARY)),
        without("noise_models"),
    ),
)
