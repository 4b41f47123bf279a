"""What each observation and each of its measurements counts in the adjustment."""

from typing import Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from linepose.adjustment.thresholds import CAUSES, CLOCK, DOUBTFUL_WEIGHT, JUMP, LABEL, UNCLEAR
from linepose.output.adjusted import without_adjustment
from linepose.output.figures.entry import FigureEntry
from linepose.output.figures.style import BLACK, BLUE, GREY, ORANGE, PURPLE, RED, WIDE_IN, blank_figure, styled
from linepose.pipeline.adjusted_schemas import MEASUREMENTS, VIEWS
from linepose.pipeline.table_checks import usable_rows

FAULTS: Final = {"": (BLUE, "as good as the rest")} | {
    fault: (colour, CAUSES[fault]) for fault, colour in ((CLOCK, ORANGE), (LABEL, PURPLE), (JUMP, RED), (UNCLEAR, GREY))
}
_MOST_LABELS: Final = 20
_ALIKE: Final = 0.005  # between weights that say nothing


@styled
def weights(views: pd.DataFrame, measurements: pd.DataFrame) -> Figure:
    """Bars of each observation's weight above, a matrix of its measurements' below, observations across.

    Colours say what the errors of an observation of little weight look like. `views` as in `VIEWS`, `measurements` as
    in `MEASUREMENTS`.
    """
    known = _known(views)
    single = usable_rows(measurements, ["observation", "point", "weight"], "adjusted_measurements.parquet")
    matrix = single.pivot_table("weight", "point", "observation").reindex(columns=known["observation"])
    figure = blank_figure(WIDE_IN, 3.9)
    bars, cells = figure.subplots(2, 1, sharex=True, height_ratios=[1, 1.4])
    place = np.arange(len(known))
    bars.bar(place, known["weight"], 0.8, color=[FAULTS[fault][0] for fault in known["fault"]])
    bars.axhline(1.0, color=BLACK, linewidth=0.6)
    bars.axhline(DOUBTFUL_WEIGHT, color=BLACK, linewidth=0.6, linestyle="--")
    bars.set_ylabel("Weight of the\nobservation")
    bars.grid(visible=False, axis="x")
    image = cells.pcolormesh(
        np.arange(len(known) + 1) - 0.5,
        np.arange(len(matrix) + 1) - 0.5,
        np.ma.masked_invalid(matrix.to_numpy()),
        vmin=0.0,
        vmax=max(1.0, float(single["weight"].max())),
    )
    step = 1 + len(matrix) // 12
    cells.set_yticks(np.arange(0, len(matrix), step), matrix.index[::step])
    shown = slice(None, None, 1 + len(place) // _MOST_LABELS)
    cells.set_xticks(place[shown], known["observation"].iloc[shown])
    cells.set(xlabel="Observation", ylabel="Point")
    cells.tick_params(length=0)
    cells.grid(visible=False)
    figure.colorbar(image, ax=cells, label="Weight of the measurement", location="bottom", shrink=0.7, aspect=40)
    present = [fault for fault in FAULTS if (known["fault"] == fault).any()]
    handles = [Patch(color=FAULTS[fault][0], label=FAULTS[fault][1]) for fault in present]
    figure.legend(handles=handles, loc="outside upper center", ncols=4)
    return figure


def weights_caption(views: pd.DataFrame, measurements: pd.DataFrame) -> str:
    """Which observations are far off and what their errors look like, and which measurement counts least."""
    known = _known(views)
    doubtful = known[known["fault"] != ""].sort_values("weight")
    named = ", ".join(f"{row['observation']} ({FAULTS[row['fault']][1]})" for _, row in doubtful.iterrows())
    told = f"Far off: {named}." if named else "None is far off."
    if np.ptp(np.concatenate([known["weight"], measurements["weight"]])) < _ALIKE:
        return "What each observation (bars) and each of its measurements (cells) counts: all alike, none is far off."
    least = {name: measurements[name][measurements["weight"].idxmin()] for name in ("observation", "point", "weight")}
    lightest = known.loc[known["weight"].idxmin()]
    return (
        "What each observation (bars) and each of its measurements (cells) counts: 1 is as good as the levels say, "
        f"below {DOUBTFUL_WEIGHT:g} (dashes) far off. {told} The lightest observation is {lightest['observation']} "
        f"({lightest['weight']:.2f}), the lightest measurement point {least['point']} of observation "
        f"{int(least['observation'])} ({least['weight']:.2f}). None is removed."
    )


def _known(views: pd.DataFrame) -> pd.DataFrame:
    rows = usable_rows(views, ["observation", "fault"], "adjusted_views.parquet")
    known = rows[np.isfinite(rows["weight"].to_numpy(dtype=float))]
    return usable_rows(known, ["weight"], "adjusted_views.parquet, observations with a weight")


FIGURES: Final = (
    FigureEntry(
        "weights",
        "Weights of observations and measurements",
        "bars of each observation's weight above a matrix of its measurements' weights, observations across",
        ("adjusted_views", "adjusted_measurements"),
        lambda r: weights(
            r.results.table("adjusted_views", VIEWS), r.results.table("adjusted_measurements", MEASUREMENTS)
        ),
        lambda r: weights_caption(
            r.results.table("adjusted_views", VIEWS), r.results.table("adjusted_measurements", MEASUREMENTS)
        ),
        without_adjustment,
    ),
)
