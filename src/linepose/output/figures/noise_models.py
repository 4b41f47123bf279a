"""The pose under each noise model from each set of observations, with its sigmas."""

from typing import Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from linepose.arrays import Floats
from linepose.estimation.noise_models import noise_model
from linepose.experiments.noise_models import NOISE_MODELS
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from linepose.output.figures.entry import FigureEntry, without
from linepose.output.figures.style import GREY, WIDE_IN, blank_figure, styled
from linepose.pipeline.table_checks import usable_rows

_NAMES: Final = ("$r_x$ (m)", "$r_y$ (m)", "$r_z$ (m)", *(rf"$\theta e_{axis}$ (rad)" for axis in "xyz"))
_SPREAD: Final = 0.5  # of a row, over which the models are laid out
_ROW_IN, _ROOM_IN = 0.24, 0.9


@styled
def noise_models(table: pd.DataFrame, hand_pose: Floats, true_pose: Floats | None = None) -> Figure:
    """A panel a pose parameter, a row a set of observations, estimates with two sigmas side by side.

    `table` as in `NOISE_MODELS`; the hand-measured pose (6,) and the true one are lines.
    """
    rows = usable_rows(table, ["noise_model", "set", *POSE_COLUMNS, *SIGMA_COLUMNS], "noise_models.parquet")
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
        panel.locator_params(axis="x", nbins=3)
        panel.grid(visible=False, axis="y")
        panel.set_yticks(range(len(sets)), [name.replace("_", " ") for name in sets])
    panels[0].invert_yaxis()
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=3)
    return figure


def noise_models_caption(table: pd.DataFrame) -> str:
    """How far the estimates of each model lie apart over the sets."""
    told, n_sets = [], table["set"].nunique()
    for model, part in table.groupby("noise_model", sort=False):
        if len(part) < n_sets:
            continue
        spread = 1e3 * (part["r_y_m"].max() - part["r_y_m"].min())
        told.append(f"{spread:.0f} mm {model}")
    return (
        "The pose from each set of observations under each noise model, with two sampled sigmas. Over the sets the "
        f"sideways position r_y differs by {', '.join(told)}. Estimates that move by more than their bars when "
        "observations are exchanged have sigmas that are too small."
    )


FIGURES: Final = (
    FigureEntry(
        "noise_models",
        "Noise models side by side",
        "each pose parameter from every set of observations under each noise model, with bars of two sigmas",
        (
            "noise_models",
            "pose",
        ),
        lambda r: noise_models(r.results.table("noise_models", NOISE_MODELS), r.pose_of("hand_measured"), r.true_pose),
        lambda r: noise_models_caption(r.results.table("noise_models", NOISE_MODELS)),
        without("noise_models"),
    ),
)
