"""The pose from each set of observations under the adjustment and under the platform's own noise model."""

from typing import Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from linepose.arrays import Floats
from linepose.config.platform import Platform
from linepose.estimation.noise_models import noise_model
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from linepose.output.adjusted import estimates, is_adjusted, set_in_words, without_adjustment
from linepose.output.figures.entry import FigureEntry
from linepose.output.figures.style import GREY, WIDE_IN, blank_figure, styled
from linepose.pipeline.table_checks import usable_rows

_NAMES: Final = ("$r_x$ (m)", "$r_y$ (m)", "$r_z$ (m)", *(rf"$\theta e_{axis}$ (rad)" for axis in "xyz"))
_SPREAD: Final = 0.5  # of a row, over which the models are laid out
_ROW_IN, _ROOM_IN = 0.3, 0.9


@styled
def estimates_figure(table: pd.DataFrame, hand_pose: Floats, true_pose: Floats | None = None) -> Figure:
    """A panel a number of the pose, a row a set of observations, estimates with bars of two sigmas side by side.

    `table` has `noise_model`, `set` and the pose with its sigmas; the hand-measured pose (6,) and the true one are
    lines.
    """
    rows = usable_rows(table, ["noise_model", "set", *POSE_COLUMNS, *SIGMA_COLUMNS], "adjustment.parquet")
    sets, models = list(rows["set"].unique()), list(rows["noise_model"].unique())
    figure = blank_figure(WIDE_IN, 2 * (_ROOM_IN + _ROW_IN * len(sets)))
    panels = figure.subplots(2, 3, sharey=True).ravel()
    for index, panel in enumerate(panels):
        panel.axvline(hand_pose[index], color=GREY, linestyle="--", linewidth=0.9, label="by hand")
        if true_pose is not None:
            panel.axvline(true_pose[index], color="black", linewidth=0.9, label="truth")
        for place, model in enumerate(models):
            part = rows[rows["noise_model"] == model]
            height = np.array([sets.index(name) for name in part["set"]])
            panel.errorbar(
                part[POSE_COLUMNS[index]],
                height + _SPREAD * ((place + 0.5) / len(models) - 0.5),
                xerr=2 * part[SIGMA_COLUMNS[index]],
                fmt=noise_model(model).marker,
                color=noise_model(model).colour,
                markersize=3,
                elinewidth=1.0,
                label=model,
            )
        panel.set_xlabel(_NAMES[index])
        panel.locator_params(axis="x", nbins=2)
        panel.grid(visible=False, axis="y")
        panel.set_yticks(range(len(sets)), [set_in_words(name).replace(" ", "\n") for name in sets])
        panel.set_ylim(len(sets) - 0.4, -0.6)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=4)
    return figure


def estimates_caption(table: pd.DataFrame) -> str:
    """How far the estimates of each model move from set to set, in sigmas."""
    told = []
    for model, part in table.groupby("noise_model", sort=False):
        if len(part) < 2:
            continue
        spread = np.ptp(part[list(POSE_COLUMNS[:3])].to_numpy(), axis=0)
        most = int(np.argmax(spread))
        name = ("forwards", "sideways", "in height")[most]
        told.append(f"{1e3 * spread[most]:.0f} mm {name} under {model}")
    moved = f"From set to set the camera moves by up to {' and '.join(told)}. " if told else ""
    return (
        f"The pose from each set of observations under each noise model, with bars of two sigmas. {moved}Estimates "
        "that move by more than their bars when observations are exchanged have sigmas that are too small."
    )


def _without(platform: Platform) -> str:
    if is_adjusted(platform):
        return "There is one estimate: the adjustment of all observations is the platform's own."
    return without_adjustment(platform)


FIGURES: Final = (
    FigureEntry(
        "estimates",
        "Estimates side by side",
        "each number of the pose from every set of observations under each noise model, with bars of two sigmas",
        ("adjustment", "pose"),
        lambda r: estimates_figure(estimates(r), r.pose_of("hand_measured"), r.true_pose),
        lambda r: estimates_caption(estimates(r)),
        _without,
    ),
)
