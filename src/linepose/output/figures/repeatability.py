"""Whether disjoint halves of the observations agree: the distribution of their distance over random splits."""

from typing import Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from scipy.stats import chi

from linepose.arrays import Floats
from linepose.config.platform import Platform
from linepose.errors import InputError
from linepose.experiments.repeatability import REPEATABILITY
from linepose.experiments.splits import SPLITS, known_distances, sigma_factor
from linepose.geometry.pose import N_PARAMETERS
from linepose.output.adjusted import has_own_halves, is_adjusted
from linepose.output.figures.entry import FigureEntry
from linepose.output.figures.style import BLACK, BLUE, GREY, HALF_PAGE_IN, RED, blank_figure, styled
from linepose.pipeline.calibration import Calibration
from linepose.pipeline.table_checks import usable_rows


@styled
def repeatability(splits: pd.DataFrame, pair: pd.DataFrame | None = None) -> Figure:
    """Histogram of the distance in sigmas between the poses of two halves, beside what right sigmas would give.

    `splits` as in `SPLITS`; `pair` as in `REPEATABILITY` adds the distance of two named subsets.
    """
    distance = _distances(splits)
    named = _named_distance(pair)
    most = 1.05 * max(float(distance.max()), 5.0, named or 0.0)
    figure = blank_figure(HALF_PAGE_IN, 2.7)
    axes = figure.add_subplot()
    axes.hist(
        distance,
        bins=np.linspace(0, most, 31).tolist(),
        density=True,
        color=GREY,
        label=f"{len(distance)} random splits",
    )
    shown = np.linspace(0, most, 200)
    axes.plot(shown, chi.pdf(shown, N_PARAMETERS), color=BLUE, label="if the sigmas are right")
    axes.axvline(float(np.median(distance)), color=BLACK, linestyle="--", linewidth=0.9, label="median of the splits")
    if named is not None:
        axes.axvline(named, color=RED, linewidth=1.4, label="the two named subsets")
    axes.set(xlabel="Distance of the two poses (sigmas)", ylabel="Density (1/sigma)")
    axes.set_xlim(0, most)
    figure.legend(loc="outside upper center", ncols=2)
    return figure


def repeatability_caption(splits: pd.DataFrame, pair: pd.DataFrame | None = None) -> str:
    """The median distance, what it says of the sigmas, and the distance of two named subsets."""
    distance, factor = _distances(splits), sigma_factor(splits)
    left = len(splits) - len(distance)
    open_ones = f" {left} splits left a direction of the pose open and are not shown." if left else ""
    named = _named_distance(pair)
    subsets = "" if named is None else f" The two named subsets are {named:.2f} apart."
    return (
        "Distance between the poses from two disjoint halves of the accepted observations, in sigmas, over random "
        f"splits. The median is {np.median(distance):.2f}, where right sigmas give {chi.median(N_PARAMETERS):.2f}: the "
        f"sigmas are {'too small' if factor > 1 else 'too large'} by a factor of "
        f"{max(factor, 1 / factor):.2f}.{open_ones}{subsets}"
    )


def _named_distance(pair: pd.DataFrame | None) -> float | None:
    """Distance of the two named subsets; none where there are none, or where one of them leaves its pose open."""
    if pair is None:
        return None
    known = usable_rows(pair, ["subset"], "repeatability.parquet")["mahalanobis"].dropna()
    return None if known.empty else float(known.iloc[0])


def _distances(splits: pd.DataFrame) -> Floats:
    usable_rows(splits, ["split"], "splits.parquet")
    if "mahalanobis" not in splits:
        raise InputError("splits.parquet", "no column mahalanobis", "the distance of each split", "run its stage again")
    return known_distances(splits)


def _named_pair(r: Calibration) -> pd.DataFrame | None:
    return r.results.table("repeatability", REPEATABILITY) if r.results.has("repeatability") else None


def _without_splits(platform: Platform) -> str:
    if is_adjusted(platform) and has_own_halves(platform):
        return "The figure on random halves shows the same."
    told = "This experiment was not asked for: experiments.repeatability has no splits in the platform's file."
    return "" if has_own_halves(platform) else told


FIGURES: Final = (
    FigureEntry(
        "repeatability",
        "Repeatability",
        "histogram of the distance between poses from disjoint halves of the observations",
        (
            "splits",
            "repeatability",
        ),
        lambda r: repeatability(r.results.table("splits", SPLITS), _named_pair(r)),
        lambda r: repeatability_caption(r.results.table("splits", SPLITS), _named_pair(r)),
        _without_splits,
    ),
)
