"""What the data say of each number of the pose: its sigma beside the hand measurement's."""

from typing import Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from linepose.estimation.identifiability import WORDS
from linepose.experiments.prior import IDENTIFIABILITY
from linepose.output.figures.entry import FigureEntry
from linepose.output.figures.style import BLUE, RED, WIDE_IN, blank_figure, styled
from linepose.pipeline.table_checks import usable_rows


@styled
def identifiability(table: pd.DataFrame) -> Figure:
    """Sigma over that of the hand measurement of each number of the pose as bars; `table` as in `IDENTIFIABILITY`."""
    rows = usable_rows(table, ["parameter", "prior_sigma", "posterior_sigma", "weakest_direction"], "identifiability")
    figure = blank_figure(WIDE_IN, 2.4)
    bars = figure.subplots()
    ratio = (rows["posterior_sigma"] / rows["prior_sigma"]).to_numpy()
    weakest = np.abs(rows["weakest_direction"].to_numpy())
    place = np.arange(len(rows))
    bars.barh(place, ratio, 0.7, color=np.where(weakest > 0.5 * weakest.max(), RED, BLUE))
    bars.axvline(1.0, color="black", linewidth=0.8)
    bars.set_yticks(place, [WORDS.get(name, name) for name in rows["parameter"]])
    bars.invert_yaxis()
    bars.set_xlim(0, max(1.05, 1.05 * float(ratio.max())))
    bars.set_xlabel("Sigma / sigma of the hand measurement")
    bars.grid(visible=False, axis="y")
    return figure


def identifiability_caption(table: pd.DataFrame) -> str:
    """What is known least, in words."""
    return (
        "How much better than the hand measurement each number of the pose is known; rotations are turns about the "
        f"body's axes. Red: what the direction that is known least is made of, {table['weakest_in_words'].iloc[0]}."
    )


FIGURES: Final = (
    FigureEntry(
        "identifiability",
        "What the data say of each number",
        "bars of each number's sigma over that of the hand measurement",
        ("identifiability",),
        lambda r: identifiability(r.results.table("identifiability", IDENTIFIABILITY)),
        lambda r: identifiability_caption(r.results.table("identifiability", IDENTIFIABILITY)),
    ),
)
