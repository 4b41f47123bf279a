"""Whether disjoint observations agree as the sigmas promise, under the published and the shared noise model."""

from typing import Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from scipy.stats import chi

from linepose.errors import InputError
from linepose.figures.checks import usable_rows
from linepose.figures.noise_models import COLOURS
from linepose.figures.style import BLACK, WIDE_IN, blank_figure, styled
from linepose.pose import N_PARAMETERS

_STYLES: Final = ("-", "--", "-.", ":")
_MARKERS: Final = ("D", "v", "X", "P")
_MOST: Final = 12.0  # sigmas shown: nothing beyond is a matter of degree


@styled
def consistency(table: pd.DataFrame) -> Figure:
    """Share of the pairs nearer than a distance, over the distance in sigmas, beside what right sigmas would give.

    Lines are random halves, marks single pairs at their distance's probability. `table` as in
    `experiment_schemas.CONSISTENCY`.
    """
    rows = _known(table)
    figure = blank_figure(WIDE_IN, 3.4)
    axes = figure.add_subplot()
    shown = np.linspace(0, _MOST, 300)
    axes.plot(shown, chi.cdf(shown, N_PARAMETERS), color=BLACK, linewidth=2.0, label="if the sigmas are right")
    halves, single = 0, 0
    for name, part in rows.groupby("comparison", sort=False):
        one = int(part["split"].max()) == 0
        for model, distances in part.groupby("noise_model", sort=False)["mahalanobis"]:
            label, colour = f"{model}, {name}", COLOURS[str(model)]
            if one:
                place = min(float(distances.iloc[0]), 0.985 * _MOST)
                axes.plot(
                    [place],
                    [chi.cdf(place, N_PARAMETERS)],
                    _MARKERS[single % 4],
                    color=colour,
                    markersize=6,
                    label=label,
                )
            else:
                ordered = np.sort(distances.to_numpy())
                share = np.arange(1, len(ordered) + 1) / len(ordered)
                style = _STYLES[halves % 4]
                axes.step(ordered, share, where="post", color=colour, linestyle=style, label=label)
        single, halves = single + one, halves + (not one)
    axes.set(
        xlabel="Distance of the two poses (sigmas)", ylabel="Share of pairs below", xlim=(0, _MOST), ylim=(0, 1.02)
    )
    figure.legend(loc="outside upper center", ncols=2)
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
