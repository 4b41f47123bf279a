"""Figure 11: the sampled rotations as an axis on the sphere and an angle about it."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from mpl_toolkits.mplot3d import Axes3D
from numpy.typing import ArrayLike
from scipy.stats import gaussian_kde

from linepose.figures.checks import some_rows, usable_rows
from linepose.figures.style import BLACK, ESTIMATE, GREY, HAND_MEASURED, TRUTH, WIDE_IN, blank_figure, few_ticks, styled
from linepose.pose import POSE_COLUMNS
from linepose.rotations import Floats

_MARKS = {"optimum": (ESTIMATE, "s"), "hand measured": (HAND_MEASURED, "D"), "truth": (TRUTH, "o")}
_MOST_DOTS = 3000


@styled
def rotation_axis(samples: pd.DataFrame, marked: Mapping[str, ArrayLike]) -> Figure:
    """The axes on the sphere and close up around their mean, coloured by density, and the angles' histogram.

    `samples` as in `result_schemas.SAMPLES`; `marked` has poses (6,) by name: optimum, hand measured, truth.
    """
    chain = usable_rows(samples, POSE_COLUMNS, "samples")[list(POSE_COLUMNS[3:])].to_numpy()
    axis, angle_deg = axis_and_angle(chain)
    marks = {name: axis_and_angle(np.asarray(pose, dtype=float)[3:]) for name, pose in marked.items()}
    pole = axis.mean(axis=0) / np.linalg.norm(axis.mean(axis=0))
    tangent = _tangent(pole)
    dots = some_rows(axis, _MOST_DOTS)
    near = np.degrees(dots @ tangent.T)
    density = gaussian_kde(near.T)(near.T)
    order = np.argsort(density)
    dots, near, colours = dots[order], near[order], density[order]

    figure = blank_figure(WIDE_IN, 4.4)
    grid = figure.add_gridspec(2, 2, height_ratios=(1.35, 1))
    sphere = figure.add_subplot(grid[0, 0], projection="3d")
    assert isinstance(sphere, Axes3D)
    _draw_sphere(sphere, pole)
    sphere.scatter(*dots.T, c=colours, s=2, linewidths=0, depthshade=False, rasterized=True)
    for name, (one, _) in marks.items():
        colour, marker = _MARKS[name]
        sphere.scatter(*one[:, None], color=colour, marker=marker, s=14, depthshade=False)
    sphere.set_title("axis in the body frame", loc="left")

    close = figure.add_subplot(grid[0, 1])
    close.scatter(near[:, 0], near[:, 1], c=colours, s=3, linewidths=0, rasterized=True)
    for name, (one, _) in marks.items():
        colour, marker = _MARKS[name]
        close.plot(*np.degrees(tangent @ one), color=colour, marker=marker, linestyle="none")
    close.set_aspect("equal", adjustable="datalim")
    close.set(xlabel="Across the mean axis, first (°)", ylabel="Across the mean axis, second (°)")
    close.set_title("close-up at the mean axis", loc="left")
    few_ticks(close)

    histogram = figure.add_subplot(grid[1, :])
    histogram.hist(angle_deg, bins=60, color=GREY, density=True)
    for name, (_, one_deg) in marks.items():
        histogram.axvline(float(one_deg), color=_MARKS[name][0], linewidth=1.4)
    histogram.set(xlabel="Angle about the axis (°)", ylabel="Density (1/°)")
    handles = [Line2D([], [], color=_MARKS[name][0], marker=_MARKS[name][1], label=name) for name in marks]
    figure.legend(handles=handles, loc="outside upper right", ncols=3)
    return figure


def axis_and_angle(rotation_vector_rad: ArrayLike) -> tuple[Floats, Floats]:
    """Unit axes (..., 3) and angles (...) in degrees of rotation vectors (..., 3)."""
    vector = np.asarray(rotation_vector_rad, dtype=float)
    angle = np.linalg.norm(vector, axis=-1)
    return vector / np.maximum(angle, 1e-12)[..., None], np.asarray(np.degrees(angle))


def _tangent(pole: Floats) -> Floats:
    """Two unit vectors across the pole (2, 3)."""
    first = np.cross(pole, np.eye(3)[int(np.abs(pole).argmin())])
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(pole, first)])


def _draw_sphere(axes: Axes3D, pole: Floats) -> None:
    u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 25), np.linspace(0, np.pi, 13))
    axes.plot_wireframe(np.cos(u) * np.sin(v), np.sin(u) * np.sin(v), np.cos(v), color=GREY, linewidth=0.25, alpha=0.6)
    for direction, name in zip(np.eye(3), ("x", "y", "z"), strict=True):
        axes.plot(*np.stack([np.zeros(3), direction]).T, color=BLACK, linewidth=0.8)
        axes.text(*(1.15 * direction), name, fontsize=7, ha="center", va="center")
    axes.plot(*np.stack([np.zeros(3), pole]).T, color=ESTIMATE, linewidth=1.0)
    axes.view_init(
        elev=float(np.degrees(np.arcsin(pole[2]))) + 30, azim=float(np.degrees(np.arctan2(pole[1], pole[0]))) + 40
    )
    axes.set_box_aspect((1, 1, 1), zoom=1.45)
    axes.set_axis_off()


def rotation_axis_caption(samples: pd.DataFrame, hand_measured: ArrayLike) -> str:
    """The mean angle with its sigma, how far the axis scatters, and the hand measurement's difference."""
    axis, angle_deg = axis_and_angle(samples[list(POSE_COLUMNS[3:])].to_numpy())
    hand_axis, hand_deg = axis_and_angle(np.asarray(hand_measured, dtype=float)[3:])
    pole = axis.mean(axis=0) / np.linalg.norm(axis.mean(axis=0))
    scatter = np.degrees(np.sqrt(np.mean(np.sum((axis - pole) ** 2, axis=1))))
    off = np.degrees(np.arccos(np.clip(pole @ hand_axis, -1, 1)))
    return (
        "The sampled rotation from camera to body as an axis (coloured by density) and an angle of "
        f"{angle_deg.mean():.2f}° ± {angle_deg.std():.2f}°. The axes scatter by {scatter:.2f}° (RMS). The hand-measured"
        f" rotation, red, has its axis {off:.1f}° off and an angle of {float(hand_deg):.1f}°."
    )
