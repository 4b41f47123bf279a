"""The survey from above."""

from typing import Final

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patheffects import withStroke

from linepose.arrays import Floats
from linepose.output.figures.entry import FigureEntry
from linepose.output.figures.style import BLACK, GREEN, GREY, HALF_PAGE_IN, blank_figure, few_ticks, styled
from linepose.pipeline.residual_tables import ESTIMATED_POINTS
from linepose.pipeline.table_checks import usable_rows
from linepose.survey.body_angles import body_angles_rad
from linepose.survey.observations import POSITION_COLUMNS, Survey

# Shares of the survey's extent: from a mark to its label, and what a label keeps free around itself.
_LABEL_DISTANCE = 0.06
_LABEL_CLEARANCE = 0.065
_LABEL_TURNS = 200


@styled
def survey_plan(survey: Survey, accepted: list[int], estimated: pd.DataFrame) -> Figure:
    """Where each observation was made, numbered, coloured by tilt, rejected ones as squares; the points as crosses.

    `estimated` as in `ESTIMATED_POINTS`. A short line says which way the vehicle headed.
    """
    points = usable_rows(estimated, ["stage", *POSITION_COLUMNS], "estimated_points.parquet")
    points_m = points.loc[points["stage"] == "inliers", list(POSITION_COLUMNS)].to_numpy() - survey.origin_m
    centre = points_m.mean(axis=0)
    plan = (np.nanmean(survey.position_m, axis=1) - centre)[:, [1, 0]]
    tilt_deg, heading = tilt_and_heading(survey)
    kept = np.isin(survey.number, accepted)
    figure = blank_figure(HALF_PAGE_IN, HALF_PAGE_IN + 0.8)
    axes = figure.add_subplot()
    reach = float(np.ptp(plan, axis=0).max())
    tick = 0.07 * reach * np.stack([np.sin(heading), np.cos(heading)], axis=-1)
    axes.plot(*np.stack([plan, plan + tick], axis=0).transpose(2, 0, 1), color=BLACK, linewidth=0.8, zorder=2)
    for chosen, marker in ((kept, "o"), (~kept, "s")):
        dots = axes.scatter(
            plan[chosen, 0],
            plan[chosen, 1],
            c=tilt_deg[chosen],
            vmin=0.0,
            vmax=float(tilt_deg.max()),
            s=26,
            marker=marker,
            edgecolors=BLACK,
            linewidths=0.5,
            zorder=3,
        )
    labels = label_places(plan, np.concatenate([plan + tick, plan + tick / 2]))
    for number, place, label in zip(survey.number, plan, labels, strict=True):
        axes.plot(*np.stack([place, label]).T, color=GREY, linewidth=0.4, zorder=1)
        text = axes.annotate(f"{number}", label, ha="center", va="center", fontsize=7, zorder=4)
        text.set_path_effects([withStroke(linewidth=1.5, foreground="white")])
    crosses = axes.plot(*(points_m - centre)[:, [1, 0]].T, "+", color=GREEN, markersize=4, label="points")
    axes.set(xlabel="East of the pattern (m)", ylabel="North of the pattern (m)")
    _square(axes, np.concatenate([labels, plan, (points_m - centre)[:, [1, 0]]]))
    few_ticks(axes)
    figure.colorbar(
        dots, ax=axes, label="Norm of roll and pitch (°)", location="bottom", shrink=0.8, aspect=30, pad=0.02
    )
    shapes = [
        Line2D([], [], color=GREY, marker=marker, markeredgecolor=BLACK, linestyle="none", label=label)
        for marker, label in (("o", "accepted"), ("s", "rejected"))
    ]
    heading_line = Line2D([], [], color=BLACK, linewidth=0.8, label="heading")
    figure.legend(
        handles=[*shapes, heading_line, *crosses],
        loc="outside upper center",
        ncols=4,
        columnspacing=1.0,
        handletextpad=0.4,
    )
    return figure


def tilt_and_heading(survey: Survey) -> tuple[Floats, Floats]:
    """Norm of roll and pitch (deg) and heading (rad) of each observation; (N,) twice."""
    angles = body_angles_rad(survey)
    return np.degrees(np.hypot(angles[:, 0], angles[:, 1])), angles[:, 2]


def _square(axes: Axes, shown: Floats) -> None:
    """Equal limits both ways, in which everything shown (K, 2) has a margin."""
    middle, half = (shown.max(axis=0) + shown.min(axis=0)) / 2, 0.54 * float(np.ptp(shown, axis=0).max())
    axes.set(xlim=(middle[0] - half, middle[0] + half), ylim=(middle[1] - half, middle[1] + half))
    axes.set_aspect("equal")


def label_places(plan: Floats, occupied: Floats) -> Floats:
    """A place (N, 2) for the label of each mark (N, 2): near it, clear of all marks, labels and occupied places (K, 2).

    Labels repel each other and are drawn back to their marks, in turns.
    """
    reach = float(np.ptp(plan, axis=0).max()) or 1.0
    near, clear = _LABEL_DISTANCE * reach, _LABEL_CLEARANCE * reach
    outwards = plan - plan.mean(axis=0)
    outwards /= np.maximum(np.linalg.norm(outwards, axis=1, keepdims=True), 1e-9)
    places = plan + near * outwards
    for _ in range(_LABEL_TURNS):
        others = np.concatenate([places, plan, occupied])
        between = places[:, None] - others
        distance = np.linalg.norm(between, axis=-1)
        overlap = np.where(distance > 0, np.maximum(clear - distance, 0.0), 0.0)
        push = (overlap / np.maximum(distance, 1e-9))[..., None] * between
        home = plan + near * (places - plan) / np.maximum(np.linalg.norm(places - plan, axis=1, keepdims=True), 1e-9)
        places = places + 0.5 * push.sum(axis=1) + 0.1 * (home - places)
    return places


def survey_plan_caption(survey: Survey, accepted: list[int]) -> str:
    """How many observations, and how the body was tilted in the accepted ones."""
    tilt_deg, _ = tilt_and_heading(survey.select(accepted))
    return (
        f"The survey from above: {survey.n_observations} observations, {len(accepted)} accepted (discs). The line on "
        f"each points where the vehicle heads. The accepted ones are tilted by {tilt_deg.min():.1f}° to "
        f"{tilt_deg.max():.1f}° (norm of roll and pitch)."
    )


FIGURES: Final = (
    FigureEntry(
        "survey_plan",
        "Survey from above",
        "map of the observations around the pattern, numbered and coloured by tilt",
        (
            "estimated_points",
            "observations",
            "outliers",
        ),
        lambda r: survey_plan(r.survey(), r.inliers, r.results.table("estimated_points", ESTIMATED_POINTS)),
        lambda r: survey_plan_caption(r.survey(), r.inliers),
    ),
)
