"""Figures 13 and 14: the observed points projected onto the pattern's plane under one pose and another."""

from typing import Final

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Ellipse

from linepose.arrays import Floats
from linepose.experiments.mapping import MAPPING, MAPPING_SUMMARY, PROJECTED_COLUMNS, PROJECTED_COVARIANCE_COLUMNS
from linepose.experiments.mapping import SECTION as MAPPING_SECTION
from linepose.geometry.plane import fit_plane
from linepose.output.figures.entry import FigureEntry, without
from linepose.output.figures.plane_view import PlaneView, plane_view
from linepose.output.figures.style import BLACK, GREEN, GREY, HALF_PAGE_IN, RED, blank_figure, few_ticks, styled
from linepose.pipeline.calibration import Calibration
from linepose.pipeline.residual_tables import ESTIMATED_POINTS
from linepose.pipeline.table_checks import usable_rows
from linepose.survey.observations import OBSERVATIONS, POSITION_COLUMNS, POSITION_COVARIANCE_INDICES

_PANEL_ASPECT = 0.75
_MARGIN_SHARE = 0.08


@styled
def mapping(
    mapped: pd.DataFrame,
    estimated: pd.DataFrame,
    observations: pd.DataFrame,
    example: int,
    true_points_m: Floats | None = None,
) -> Figure:
    """Above all projections before (grey) and after (red) and the estimates; below one observation, 1-sigma ellipses.

    `mapped` as in `MAPPING`, `estimated` as in `ESTIMATED_POINTS`, `observations` as
    in `OBSERVATIONS` says where the viewer stands; true points (M, 3) in map coordinates are circled where known.
    """
    view, points = _view(estimated, observations)
    before, after = (_poses(mapped, name) for name in ("hand_measured", "calibrated"))
    figure = blank_figure(HALF_PAGE_IN, 2 * HALF_PAGE_IN * _PANEL_ASPECT + 0.5)
    upper, lower = figure.subplots(2, 1)
    for table, colour, size, label in (
        (before, GREY, 3, "before: hand measured"),
        (after, RED, 3, "after: calibrated"),
    ):
        flat = view.flat(table[list(PROJECTED_COLUMNS)])
        upper.scatter(flat[:, 0], flat[:, 1], s=size, color=colour, linewidths=0, label=label)
    upper.plot(*points.T, "+", color=GREEN, markersize=7, markeredgewidth=1.3, label="estimated points")
    for panel in (upper, lower):
        _circle_truth(panel, view, true_points_m)
    upper.set_title("all observations", loc="left")
    one = after[after["observation"] == example]
    for centre, covariance in zip(view.flat(one[list(PROJECTED_COLUMNS)]), _covariances(one, view), strict=True):
        lower.add_patch(_ellipse(centre, covariance))
    lower.plot(*view.flat(one[list(PROJECTED_COLUMNS)]).T, ".", color=RED, markersize=4)
    lower.plot(*points.T, "+", color=GREEN, markersize=7, markeredgewidth=1.3)
    lower.set_title(f"observation {example}, 1-sigma ellipses", loc="left")
    extents = [view.flat(table[list(PROJECTED_COLUMNS)]) for table in (before, after)]
    _finish(upper, view, np.concatenate([*extents, points]))
    _finish(lower, view, np.concatenate([points, *_reach(one, view)]))
    handles, _ = upper.get_legend_handles_labels()
    handles.append(Line2D([], [], color=RED, linewidth=0.8, label="1 sigma"))
    figure.legend(handles=handles, loc="outside upper center", ncols=2)
    return figure


@styled
def angle_error(
    mapped: pd.DataFrame,
    estimated: pd.DataFrame,
    observations: pd.DataFrame,
    angle_deg: float,
    true_points_m: Floats | None = None,
) -> Figure:
    """All projections under the calibrated pose (red) and under the same turned by an angle about each axis (grey).

    Tables as in `mapping`.
    """
    view, points = _view(estimated, observations)
    turned, after = (_poses(mapped, name) for name in ("perturbed", "calibrated"))
    figure = blank_figure(HALF_PAGE_IN, HALF_PAGE_IN * _PANEL_ASPECT + 0.5)
    axes = figure.add_subplot()
    flat = [view.flat(table[list(PROJECTED_COLUMNS)]) for table in (turned, after)]
    axes.scatter(
        flat[0][:, 0], flat[0][:, 1], s=3, color=GREY, linewidths=0, label=f"turned by {angle_deg:g}° about each axis"
    )
    axes.scatter(flat[1][:, 0], flat[1][:, 1], s=3, color=RED, linewidths=0, label="calibrated")
    axes.plot(
        *points.T, "+", color=GREEN, markersize=7, markeredgewidth=1.3, linestyle="none", label="estimated points"
    )
    _circle_truth(axes, view, true_points_m)
    _finish(axes, view, np.concatenate([*flat, points]))
    figure.legend(loc="outside upper center", ncols=2)
    return figure


def mapping_caption(summary: pd.DataFrame, example: int) -> str:
    """How far the projections of one point scatter before and after, in mm."""
    before, after = (_spread_mm(summary, pose, "all") for pose in ("hand_measured", "calibrated"))
    accepted = _spread_mm(summary, "calibrated", "accepted")
    return (
        "The pattern's points, projected to its plane from every observation with the hand-measured (grey) and with "
        f"the calibrated pose (red). The projections of one point scatter by {before:.0f} mm before and {after:.0f} mm "
        f"after (RMS over all observations; {accepted:.0f} mm over the accepted ones). Below, observation {example} "
        "alone with the 1-sigma ellipses that follow from pose, navigation and pixel errors. Zero is the points' "
        "centre."
    )


def angle_error_caption(summary: pd.DataFrame, angle_deg: float) -> str:
    """What a small turn of the camera does to the map, in mm."""
    turned, after = (_spread_mm(summary, pose, "accepted") for pose in ("perturbed", "calibrated"))
    return (
        f"What an error of {angle_deg:g}° about each axis does: the projections of one point from the accepted "
        f"observations scatter by {turned:.0f} mm instead of {after:.0f} mm (RMS)."
    )


def _spread_mm(summary: pd.DataFrame, pose: str, observations: str) -> float:
    rows = usable_rows(summary, ["pose", "observations", "spread_mm"], "mapping_summary.parquet")
    rows = rows[(rows["pose"] == pose) & (rows["observations"] == observations)]
    return float(usable_rows(rows, ["spread_mm"], f"mapping_summary.parquet, pose {pose}")["spread_mm"].iloc[0])


def _view(estimated: pd.DataFrame, observations: pd.DataFrame) -> tuple[PlaneView, Floats]:
    points = usable_rows(estimated, ["stage", *POSITION_COLUMNS], "estimated_points.parquet")
    points_m = points.loc[points["stage"] == "inliers", list(POSITION_COLUMNS)].to_numpy()
    bodies = usable_rows(observations, POSITION_COLUMNS, "observations.parquet")[list(POSITION_COLUMNS)]
    view = plane_view(fit_plane(points_m), bodies.to_numpy().mean(axis=0))
    return view, view.flat(points_m)


def _poses(mapped: pd.DataFrame, pose: str) -> pd.DataFrame:
    columns = ["pose", "observation", *PROJECTED_COLUMNS, *PROJECTED_COVARIANCE_COLUMNS]
    rows = usable_rows(mapped.dropna(), columns, "mapping.parquet")  # a ray that misses the plane has no projection
    return usable_rows(rows[rows["pose"] == pose], columns, f"mapping.parquet, pose {pose}")


def _circle_truth(axes: Axes, view: PlaneView, true_points_m: Floats | None) -> None:
    if true_points_m is not None:
        axes.plot(
            *view.flat(true_points_m).T,
            "o",
            color=BLACK,
            markersize=8,
            markeredgewidth=0.7,
            fillstyle="none",
            label="true points",
        )


def _covariances(rows: pd.DataFrame, view: PlaneView) -> Floats:
    covariance = np.zeros((len(rows), 3, 3))
    for name, (i, j) in zip(PROJECTED_COVARIANCE_COLUMNS, POSITION_COVARIANCE_INDICES, strict=True):
        covariance[:, i, j] = covariance[:, j, i] = rows[name]
    return view.flat_covariance(covariance)


def _ellipse(centre: Floats, covariance: Floats) -> Ellipse:
    variance, axes = np.linalg.eigh(covariance)
    width, height = 2 * np.sqrt(np.maximum(variance, 0.0))
    angle = float(np.degrees(np.arctan2(axes[1, 0], axes[0, 0])))
    return Ellipse((centre[0], centre[1]), width, height, angle=angle, fill=False, edgecolor=RED, linewidth=0.8)


def _reach(rows: pd.DataFrame, view: PlaneView) -> tuple[Floats, Floats]:
    sigma = np.sqrt(np.diagonal(_covariances(rows, view), axis1=1, axis2=2))
    flat = view.flat(rows[list(PROJECTED_COLUMNS)])
    return flat - sigma, flat + sigma


def _finish(axes: Axes, view: PlaneView, shown: Floats) -> None:
    axes.update_datalim(shown)
    axes.margins(_MARGIN_SHARE)
    axes.autoscale_view()
    axes.set_aspect("equal", adjustable="datalim")
    axes.set(xlabel=view.labels[0], ylabel=view.labels[1])
    few_ticks(axes)


def _angle_deg(r: Calibration) -> float:
    settings = MAPPING_SECTION.of(r.platform_file)
    return settings.perturbation_deg if settings else 0.0


def _angle_error(r: Calibration) -> Figure:
    points = r.results.table("estimated_points", ESTIMATED_POINTS)
    mapped = r.results.table("mapping", MAPPING)
    observations = r.results.table("observations", OBSERVATIONS)
    return angle_error(mapped, points, observations, _angle_deg(r), r.true_points_m)


def _mapping(r: Calibration) -> Figure:
    points = r.results.table("estimated_points", ESTIMATED_POINTS)
    mapped = r.results.table("mapping", MAPPING)
    observations = r.results.table("observations", OBSERVATIONS)
    return mapping(mapped, points, observations, r.inliers[0], r.true_points_m)


FIGURES: Final = (
    FigureEntry(
        "mapping",
        "Mapping before and after",
        "the pattern's points projected to its plane before and after the calibration",
        (
            "mapping_summary",
            "outliers",
            "estimated_points",
            "mapping",
            "observations",
        ),
        _mapping,
        lambda r: mapping_caption(r.results.table("mapping_summary", MAPPING_SUMMARY), r.inliers[0]),
        without("mapping"),
    ),
    FigureEntry(
        "angle_error",
        "Effect of an angle error",
        "the pattern's points projected with the calibrated pose and with one turned by a small angle",
        (
            "mapping_summary",
            "estimated_points",
            "mapping",
            "observations",
        ),
        _angle_error,
        lambda r: angle_error_caption(r.results.table("mapping_summary", MAPPING_SUMMARY), _angle_deg(r)),
        without("mapping"),
    ),
)
