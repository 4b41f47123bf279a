"""The sampled posterior of every pair of pose parameters."""

from collections.abc import Mapping
from typing import Final

import corner
import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.geometry.pose import N_PARAMETERS, POSE_COLUMNS
from linepose.output.figures.entry import FigureEntry
from linepose.output.figures.style import POSE_MARKS, WIDE_IN, pose_handles, styled
from linepose.pipeline.table_checks import usable_chain

LABELS = ("$r_x$ (m)", "$r_y$ (m)", "$r_z$ (m)", r"$\theta e_x$ (rad)", r"$\theta e_y$ (rad)", r"$\theta e_z$ (rad)")
_TICK_MARGIN = 0.15
_SHADE = "#777777"


@styled
def corner_plot(samples: pd.DataFrame, marked: Mapping[str, ArrayLike]) -> Figure:
    """Histograms and contours of the samples, with poses (6,) marked by name: optimum, hand measured, truth.

    `samples` as in `SAMPLES`; contours hold 39, 68 and 95 % of the samples, dashes 16, 50 and 84 %.
    """
    chain = usable_chain(samples)
    poses = {name: np.asarray(pose, dtype=float) for name, pose in marked.items()}
    figure = Figure(figsize=(WIDE_IN, WIDE_IN))
    corner.corner(
        chain,
        fig=figure,
        range=_ranges(chain, poses),
        bins=30,
        smooth=0.8,
        levels=(0.39, 0.68, 0.95),
        quantiles=(0.16, 0.5, 0.84),
        color=_SHADE,
        plot_datapoints=False,
        fill_contours=True,
        contour_kwargs={"linewidths": 0.6},
        hist_kwargs={"linewidth": 0.8},
    )
    for name, pose in poses.items():
        colour, marker = POSE_MARKS[name]
        corner.overplot_lines(figure, pose, color=colour, linewidth=0.7)
        corner.overplot_points(figure, pose[None], color=colour, marker=marker, markersize=3.0)
    for line in (line for axes in figure.axes for line in axes.lines if line.get_linestyle() == "--"):
        line.set_linewidth(0.6)
    _label(figure)
    contours = Line2D([], [], color=_SHADE, label="39, 68, 95 % of the samples")
    quantiles = Line2D([], [], color=_SHADE, linestyle="--", linewidth=0.8, label="16, 50, 84 %")
    figure.legend(handles=[*pose_handles(poses), contours, quantiles], loc="upper right", bbox_to_anchor=(0.99, 0.98))
    return figure


def _ranges(chain: Floats, poses: Mapping[str, Floats]) -> list[tuple[float, float]]:
    marks = np.array([*poses.values(), np.median(chain, axis=0)])
    low = np.minimum(np.quantile(chain, 0.001, axis=0), marks.min(axis=0))
    high = np.maximum(np.quantile(chain, 0.999, axis=0), marks.max(axis=0))
    margin = 0.08 * (high - low)
    return list(zip((low - margin).tolist(), (high + margin).tolist(), strict=True))


def _label(figure: Figure) -> None:
    axes = np.array(figure.axes).reshape(N_PARAMETERS, N_PARAMETERS)
    for row in range(N_PARAMETERS):
        for column in range(row + 1):
            one = axes[row, column]
            one.grid(visible=False)
            one.tick_params(length=2, pad=1)
            one.set_xticks(two_ticks(*one.get_xlim()))
            for text in one.get_xticklabels():
                text.set(rotation=45, ha="right", rotation_mode="anchor")
            if row > column:
                one.set_yticks(two_ticks(*one.get_ylim()))
            for text in one.get_yticklabels():
                text.set(rotation=0)
            if row == N_PARAMETERS - 1:
                one.set_xlabel(LABELS[column])
                one.xaxis.set_label_coords(0.5, -0.66)
            if column == 0 and row:
                one.set_ylabel(LABELS[row])
                one.yaxis.set_label_coords(-0.66, 0.5)
    figure.subplots_adjust(left=0.155, bottom=0.14, right=0.985, top=0.985, wspace=0.07, hspace=0.07)


def two_ticks(low: float, high: float) -> list[float]:
    """Two round numbers as far apart as they go, clear of the panel's ends, where the next panel's labels are."""
    margin = _TICK_MARGIN * (high - low)
    inner = [
        tick
        for tick in MaxNLocator(6, steps=[1, 2, 5, 10]).tick_values(low, high)
        if low + margin <= tick <= high - margin
    ]
    return [float(tick) for tick in dict.fromkeys((inner[0], inner[-1]))] if inner else [(low + high) / 2]


def corner_plot_caption(samples: pd.DataFrame) -> str:
    """How many samples, and the strongest correlation among the parameters."""
    chain = usable_chain(samples)
    correlation = np.corrcoef(chain.T) - np.eye(N_PARAMETERS)
    i, j = np.unravel_index(int(np.abs(correlation).argmax()), correlation.shape)
    first, second = (POSE_COLUMNS[k].rsplit("_", 1)[0] for k in sorted((i, j)))
    return (
        f"Posterior of the pose from {len(chain):,} samples: each parameter on the diagonal, each pair below it. "
        f"The most correlated pair is {first} and {second} ({correlation[i, j]:+.2f}): the observations tell their "
        "combination better than either alone."
    )


FIGURES: Final = (
    FigureEntry(
        "corner",
        "Posterior of the pose",
        "histograms and contours of every pair of pose parameters with the optimum and the hand measurement marked",
        (
            "mcmc/inliers",
            "pose",
        ),
        lambda r: corner_plot(r.samples, r.marked_poses()),
        lambda r: corner_plot_caption(r.samples),
    ),
)
