"""Whether random halves of the observations agree as the sigmas promise, under each noise model that was tried."""

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from scipy.stats import chi

from linepose.config.platform import Platform
from linepose.errors import InputError
from linepose.estimation.noise_models import noise_model
from linepose.geometry.pose import N_PARAMETERS
from linepose.output.adjusted import (
    NO_HALVES,
    Halves,
    halves,
    has_halves_beside,
    has_own_halves,
    is_adjusted,
    set_in_words,
)
from linepose.output.figures.entry import FigureEntry
from linepose.output.figures.style import BLACK, GREY, WIDE_IN, blank_figure, styled

_STYLES: Final[tuple[Any, ...]] = ("-", "--", "-.", ":")
_MOST: Final = 8.0  # sigmas shown: nothing beyond is a matter of degree
_CHANCE_SIGMAS: Final = 1.96


@styled
def halves_figure(found: Sequence[Halves]) -> Figure:
    """Share of the splits whose halves lie nearer than a distance, over the distance in sigmas.

    The black curve is what right sigmas give, the band what holds as many independent splits with 95 % at each
    distance.
    """
    _some(found)
    figure = blank_figure(WIDE_IN, 3.6)
    axes = figure.add_subplot()
    shown = np.linspace(0, _MOST, 300)
    right = chi.cdf(shown, N_PARAMETERS)
    chance = _CHANCE_SIGMAS * np.sqrt(right * (1 - right) / len(found[0].distance))
    axes.fill_between(shown, np.maximum(right - chance, 0), np.minimum(right + chance, 1), color=GREY, alpha=0.3, lw=0)
    axes.plot(shown, right, color=BLACK, linewidth=1.6)
    sets = list(dict.fromkeys(one.set for one in found))
    handles: list[Line2D | Patch] = [Line2D([], [], color=BLACK, linewidth=1.6, label="right sigmas")]
    handles.append(Patch(color=GREY, alpha=0.3, label="95 % by chance"))
    for one in found:
        ordered = np.sort(np.minimum(one.distance, _MOST))
        share = np.arange(1, len(ordered) + 1) / len(ordered)
        style = _STYLES[sets.index(one.set) % len(_STYLES)]
        colour = noise_model(one.noise_model).colour
        axes.plot(ordered, share, color=colour, linestyle=style, drawstyle="steps-post")
        label = f"{one.noise_model}, {set_in_words(one.set)}"
        handles.append(Line2D([], [], color=colour, linestyle=style, label=label))
    axes.axhline(0.5, color=GREY, linewidth=0.6, linestyle=":")
    axes.set(xlabel="Distance of the two poses (sigmas)", ylabel="Share of the splits", xlim=(0, _MOST), ylim=(0, 1.02))
    figure.legend(handles=handles, loc="outside upper center", ncols=2)
    return figure


def halves_caption(found: Sequence[Halves]) -> str:
    """How many times as far apart as stated the halves lie, of each model and set."""
    _some(found)
    told = ", ".join(
        f"{one.factor:.2f} times ({one.noise_model}, {set_in_words(one.set)}, {len(one.distance)} splits)"
        for one in found
    )
    return (
        "Each split halves the observations at random, estimates both halves on their own and measures how far apart "
        f"the two poses are. Halves lie as far apart as stated by the median: {told}. A curve right of the black one "
        "says that sigmas are too small, left of it that they are too large. Splits of one survey share observations, "
        "so curves stray from the band more easily than independent ones would."
    )


def _some(found: Sequence[Halves]) -> None:
    if not found:
        raise InputError("splits", "none", "random halves", "set repeatability.n_splits in the platform's file")


def _without(platform: Platform) -> str:
    if not is_adjusted(platform) and not has_halves_beside(platform):
        return "Of the published noise model alone: see the figure on repeatability."
    return "" if has_own_halves(platform) or has_halves_beside(platform) else NO_HALVES


FIGURES: Final = (
    FigureEntry(
        "halves",
        "Random halves",
        "cumulative distribution of the distance in sigmas between poses from random halves, by noise model",
        ("adjusted_splits", "splits"),
        lambda r: halves_figure(halves(r)),
        lambda r: halves_caption(halves(r)),
        _without,
    ),
)
