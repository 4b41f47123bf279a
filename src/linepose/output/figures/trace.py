"""The chain itself: where its walkers are at each step, and for how long they remember."""

from collections.abc import Mapping
from typing import Any, Final

import emcee
import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.estimation.diagnostics import MINIMUM_STEPS_PER_TIME
from linepose.geometry.pose import POSE_COLUMNS
from linepose.output.figures.corner_plot import LABELS
from linepose.output.figures.entry import FigureEntry, without_removal
from linepose.output.figures.style import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    HALF_PAGE_IN,
    ORANGE,
    POSE_MARKS,
    PURPLE,
    RED,
    SKY,
    blank_figure,
    styled,
)
from linepose.pipeline.calibration import Calibration
from linepose.pipeline.stages import DIAGNOSTICS, samples_from_table
from linepose.pipeline.table_checks import stage_rows, usable_rows

_COLOURS = (BLUE, RED, GREEN, SKY, ORANGE, PURPLE)
_SHOWN_WALKERS = 5
_NO_CHAIN: Final = "The samples of an adjustment are independent draws: there is no chain to look at."
_LINES: Final[Any] = {
    "optimum": {"color": BLACK, "linewidth": 0.8, "linestyle": "--"},
    "truth": {"color": POSE_MARKS["truth"][0], "linewidth": 0.8},
}


@styled
def trace(samples: pd.DataFrame, marked: Mapping[str, ArrayLike]) -> Figure:
    """Each parameter over the kept steps: a few walkers, and the median and 68 % of all of them.

    `samples` as in `SAMPLES`; `marked` has poses (6,) by name: optimum, truth.
    """
    chain = _chain(samples)
    figure = blank_figure(HALF_PAGE_IN, 5.6)
    panels = figure.subplots(len(POSE_COLUMNS), 1, sharex=True)
    steps = np.arange(len(chain))
    shown = np.linspace(0, chain.shape[1] - 1, _SHOWN_WALKERS).astype(int)
    for i, (panel, label) in enumerate(zip(panels, LABELS, strict=True)):
        low, middle, high = np.quantile(chain[:, :, i], (0.16, 0.5, 0.84), axis=1)
        panel.plot(steps, chain[:, shown, i], color=GREY, linewidth=0.4)
        panel.fill_between(steps, low, high, color=SKY, alpha=0.5, linewidth=0)
        panel.plot(steps, middle, color=BLUE)
        for name, pose in marked.items():
            panel.axhline(float(np.asarray(pose)[i]), **_LINES[name])
        panel.set_ylabel(label)
        panel.margins(x=0)
    panels[-1].set_xlabel("Step kept")
    figure.align_ylabels()
    handles = [
        Line2D([], [], color=BLUE, label="median"),
        Patch(color=SKY, alpha=0.5, label="68 % of the walkers"),
        Line2D([], [], color=GREY, linewidth=0.8, label="one walker"),
    ]
    handles += [Line2D([], [], label=name, **_LINES[name]) for name in marked]
    figure.legend(handles=handles, loc="outside upper center", ncols=2)
    return figure


@styled
def autocorrelation(samples: pd.DataFrame) -> Figure:
    """How alike a walker's positions are that lie a number of steps apart, averaged over the walkers.

    `samples` as in `SAMPLES`.
    """
    chain = _chain(samples)
    figure = blank_figure(HALF_PAGE_IN, 2.8)
    axes = figure.add_subplot()
    for i, (label, colour) in enumerate(zip(LABELS, _COLOURS, strict=True)):
        function = autocorrelation_function(chain[:, :, i])
        axes.plot(function, color=colour, label=label.split(" (")[0], linewidth=1.0, linestyle="-" if i < 3 else "--")
    axes.axhline(0.0, color=BLACK, linewidth=0.6)
    axes.set(xlabel="Lag (steps)", ylabel="Autocorrelation (no unit)")
    axes.margins(x=0)
    figure.legend(loc="outside upper center", ncols=6, columnspacing=0.8, handlelength=1.2)
    return figure


def autocorrelation_function(series: Floats) -> Floats:
    """Autocorrelation of one parameter (S, W) at each lag (S,), averaged over the walkers; 1 at lag 0."""
    return np.asarray(np.mean([emcee.autocorr.function_1d(walker) for walker in series.T], axis=0))


def trace_caption(diagnostics: pd.DataFrame) -> str:
    """Steps' worth of the chain: acceptance, effective samples, and R-hat."""
    columns = ["acceptance_fraction", "split_r_hat", "effective_sample_size"]
    rows = stage_rows(diagnostics, "inliers", columns, "diagnostics.parquet")
    return (
        "The pose parameters over the kept steps of the chain. A chain that has settled shows a level band. "
        f"Acceptance {100 * rows['acceptance_fraction'].iloc[0]:.0f} %, worst split R-hat "
        f"{rows['split_r_hat'].max():.2f}, at least {rows['effective_sample_size'].min():,.0f} independent samples."
    )


def autocorrelation_caption(diagnostics: pd.DataFrame, n_steps: int) -> str:
    """The autocorrelation time against the chain's length."""
    time = stage_rows(diagnostics, "inliers", ["autocorrelation_time"], "diagnostics.parquet")[
        "autocorrelation_time"
    ].max()
    return (
        f"How long a walker remembers: the longest autocorrelation time is estimated at {time:.0f} steps. The chain "
        f"has {n_steps} steps, {n_steps / time:.0f} times as many; {MINIMUM_STEPS_PER_TIME} times is the rule for a "
        "trustworthy estimate."
    )


def _chain(samples: pd.DataFrame) -> Floats:
    usable_rows(samples, ["walker", "step", *POSE_COLUMNS], "samples")
    return samples_from_table(samples, POSE_COLUMNS)


def _diagnostics_caption(r: Calibration) -> str:
    n_steps = int(r.samples["step"].max()) + 1
    return autocorrelation_caption(r.results.table("diagnostics", DIAGNOSTICS), n_steps)


def _trace(r: Calibration) -> Figure:
    marked = {name: pose for name, pose in r.marked_poses().items() if name != "hand measured"}
    return trace(r.samples, marked)


FIGURES: Final = (
    FigureEntry(
        "trace",
        "Trace of the chain",
        "each pose parameter over the steps of the chain",
        (
            "diagnostics",
            "mcmc/inliers",
            "pose",
        ),
        _trace,
        lambda r: trace_caption(r.results.table("diagnostics", DIAGNOSTICS)),
        without_removal(_NO_CHAIN),
    ),
    FigureEntry(
        "autocorrelation",
        "Autocorrelation of the chain",
        "autocorrelation of each pose parameter against the lag in steps",
        (
            "mcmc/inliers",
            "diagnostics",
        ),
        lambda r: autocorrelation(r.samples),
        _diagnostics_caption,
        without_removal(_NO_CHAIN),
    ),
)
