"""What the data say of each parameter: prior against posterior, and the levels that the noise model infers."""

from typing import Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, NullFormatter, NullLocator

from linepose.estimation.identifiability import WORDS
from linepose.estimation.noise_models import SHARED
from linepose.experiments.noise_models import IDENTIFIABILITY, NOISE_MODELS
from linepose.likelihood.shared import SharedPriors
from linepose.output.figures.entry import FigureEntry, without
from linepose.output.figures.style import BLUE, GREY, RED, SKY, WIDE_IN, blank_figure, styled
from linepose.pipeline.table_checks import usable_rows

_LEVELS: Final = ("shared_level", "white_level", "pixel_level")
_NAMES: Final = ("a, shared by a view", "b, of a line alone", "g, of the pixel")


@styled
def identifiability(table: pd.DataFrame, estimates: pd.DataFrame) -> Figure:
    """Posterior over prior sigma of each parameter as bars, and the intervals of the levels beside their prior.

    `table` as in `IDENTIFIABILITY`, `estimates` as in `NOISE_MODELS`.
    """
    rows = usable_rows(table, ["parameter", "prior_sigma", "posterior_sigma", "weakest_direction"], "identifiability")
    figure = blank_figure(WIDE_IN, 3.2)
    bars, levels = figure.subplots(1, 2, width_ratios=[1.35, 1])
    ratio = (rows["posterior_sigma"] / rows["prior_sigma"]).to_numpy()
    weakest = np.abs(rows["weakest_direction"].to_numpy())
    place = np.arange(len(rows))
    bars.barh(place, ratio, 0.7, color=np.where(weakest > 0.5 * weakest.max(), RED, BLUE))
    bars.axvline(1.0, color="black", linewidth=0.8)
    bars.set_yticks(place, [WORDS.get(name, name) for name in rows["parameter"]])
    bars.invert_yaxis()
    bars.set_xlim(0, max(1.05, 1.05 * float(ratio.max())))
    bars.set_xlabel("Posterior sigma / prior sigma")
    bars.grid(visible=False, axis="y")
    prior, row = SharedPriors(), shared_inliers(estimates)
    for index, level in enumerate(_LEVELS):
        low, high = prior.level_median * np.exp(prior.level_log_sigma * np.array([-1.0, 1.0]))
        levels.plot([low, high], [index, index], color=SKY, linewidth=7, alpha=0.35, solid_capstyle="butt")
        levels.plot([row[f"{level}_low"], row[f"{level}_high"]], [index, index], color=BLUE, linewidth=2.4)
        levels.plot([row[level]], [index], "o", color=BLUE, markersize=5)
    levels.axvline(1.0, color=GREY, linestyle="--", linewidth=0.9)
    levels.set_xscale("log")
    levels.xaxis.set_major_locator(FixedLocator([0.01, 0.1, 1.0, 10.0]))
    levels.xaxis.set_minor_locator(NullLocator())
    levels.xaxis.set_minor_formatter(NullFormatter())
    levels.set_xticks([0.01, 0.1, 1.0, 10.0], ["0.01", "0.1", "1", "10"])
    levels.set_yticks(range(3), _NAMES)
    levels.set_ylim(2.6, -0.6)
    levels.set_xlabel("Level (as stated: 1)", x=1.0, ha="right")
    levels.grid(visible=False, axis="y")
    return figure


def identifiability_caption(table: pd.DataFrame, estimates: pd.DataFrame) -> str:
    """The weakest direction in words, and the levels."""
    row = shared_inliers(estimates)
    told = ", ".join(f"{name[0]} = {row[level]:.2g}" for level, name in zip(_LEVELS, _NAMES, strict=True))
    return (
        "Left: how far the accepted observations narrow each parameter of the shared noise model; of the pose beside "
        "the hand measurement, which took no part. Red: what the weakest direction is made of, "
        f"{table['weakest_in_words'].iloc[0]}. Right: the inferred levels (median and 68 %) on their priors (light, "
        f"68 %): {told}, where 1 would be the stated sigmas."
    )


def shared_inliers(estimates: pd.DataFrame) -> pd.Series:
    """The shared model's row of the accepted observations."""
    rows = estimates[(estimates["noise_model"] == SHARED.name) & (estimates["set"] == "inliers")]
    return usable_rows(rows, list(_LEVELS), f"noise_models.parquet, {SHARED.name}, inliers").iloc[0]


FIGURES: Final = (
    FigureEntry(
        "identifiability",
        "What the data say of each parameter",
        "bars of posterior over prior sigma of each parameter, and intervals of the inferred levels on their priors",
        (
            "identifiability",
            "noise_models",
        ),
        lambda r: identifiability(
            r.results.table("identifiability", IDENTIFIABILITY), r.results.table("noise_models", NOISE_MODELS)
        ),
        lambda r: identifiability_caption(
            r.results.table("identifiability", IDENTIFIABILITY), r.results.table("noise_models", NOISE_MODELS)
        ),
        without("noise_models"),
    ),
)
