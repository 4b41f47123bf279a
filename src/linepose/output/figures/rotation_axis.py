"""The sampled rotations as an axis on the sphere and an angle about it."""

from collections.abc import Mapping
from typing import Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import Axes3D
from numpy.typing import ArrayLike
from scipy.stats import gaussian_kde

from linepose.arrays import Floats
from linepose.output.figures.entry import FigureEntry
from linepose.output.figures.style import (
    BLACK,
    GREY,
    ON_A_CLOUD,
    POSE_MARKS,
    WIDE_IN,
    blank_figure,
    few_ticks,
    pose_handles,
    styled,
)
from linepose.output.figures.thinning import some_rows
from linepose.pipeline.table_checks import usable_chain

_MOST_DOTS: Final = 3000
_VIEWED_FROM_DEG: Final = (15.0, 25.0)  # above and beside the mean axis
_STEEPEST_DEG: Final = 35.0  # view on the sphere, so that its vertical axis is not foreshortened to a dot
_STEEP: Final = 0.95  # down part of an axis, above which no direction on the sphere is upwards
_Z_DOWN: Final = np.diag([1.0, -1.0, -1.0])  # the body frame as matplotlib, whose z is up, has to draw it


@styled
def rotation_axis(samples: pd.DataFrame, marked: Mapping[str, ArrayLike]) -> Figure:
    """The axes on the sphere and close up around their mean, coloured by density, and the angles' histogram.

    `samples` as in `SAMPLES`; `marked` has poses (6,) by name: optimum, hand measured, truth.
    """
    axis, angle_deg = axis_and_angle(usable_chain(samples)[:, 3:])
    marks = {name: axis_and_angle(np.asarray(pose, dtype=float)[3:]) for name, pose in marked.items()}
    pole = axis.mean(axis=0) / np.linalg.norm(axis.mean(axis=0))
    tangent, labels = tangent_plane(pole)
    dots = some_rows(axis, _MOST_DOTS)
    near = np.degrees(dots @ tangent.T)
    density = gaussian_kde(near.T)(near.T)
    order = np.argsort(density)
    dots, near, colours = dots[order], near[order], density[order]

    figure = blank_figure(WIDE_IN, 4.2)
    grid = figure.add_gridspec(2, 2, height_ratios=(1.35, 1), width_ratios=(1, 1.15))
    sphere = figure.add_subplot(grid[0, 0], projection="3d", computed_zorder=False)
    assert isinstance(sphere, Axes3D)
    _draw_sphere(sphere, pole)
    sphere.scatter(*(dots @ _Z_DOWN).T, c=colours, s=2, linewidths=0, depthshade=False, rasterized=True, zorder=4)
    for name, (one, _) in marks.items():
        line = np.stack([np.zeros(3), one]) @ _Z_DOWN
        sphere.plot(*line.T, color=POSE_MARKS[name][0], linewidth=1.0, zorder=3)
    sphere.set_title("axis in the body frame", loc="left")

    close = figure.add_subplot(grid[0, 1])
    cloud = close.scatter(near[:, 0], near[:, 1], c=colours, s=3, linewidths=0, rasterized=True)
    for name, (one, _) in marks.items():
        colour, marker = POSE_MARKS[name]
        close.plot(*np.degrees(tangent @ one), color=colour, marker=marker, linestyle="none", **ON_A_CLOUD)
    close.set_aspect("equal", adjustable="datalim")
    close.set(xlabel=labels[0], ylabel=labels[1])
    close.set_title("close-up at the mean axis", loc="left")
    few_ticks(close)
    figure.colorbar(cloud, ax=close, label="Density (1/°²)", pad=0.02)

    histogram = figure.add_subplot(grid[1, :])
    histogram.hist(angle_deg, bins=60, color=GREY, density=True)
    for name, (_, one_deg) in marks.items():
        histogram.axvline(float(one_deg), color=POSE_MARKS[name][0], linewidth=1.4)
    histogram.set(xlabel="Angle about the axis (°)", ylabel="Density (1/°)")
    figure.legend(handles=pose_handles(marks), loc="outside upper center", ncols=3)
    return figure


def axis_and_angle(rotation_vector_rad: ArrayLike) -> tuple[Floats, Floats]:
    """Unit axes (..., 3) and angles (...) in degrees of rotation vectors (..., 3)."""
    vector = np.asarray(rotation_vector_rad, dtype=float)
    angle = np.linalg.norm(vector, axis=-1)
    return vector / np.maximum(angle, 1e-12)[..., None], np.asarray(np.degrees(angle))


def tangent_plane(pole: Floats) -> tuple[Floats, tuple[str, str]]:
    """Two unit vectors (2, 3) that touch the sphere at an axis, to the right and up as seen from outside; labels."""
    steep = abs(pole[2]) > _STEEP
    towards = np.array([1.0, 0.0, 0.0]) if steep else np.array([0.0, 0.0, -1.0])
    upwards = towards - (towards @ pole) * pole
    upwards /= np.linalg.norm(upwards)
    labels = ("To the right (°)", "Forwards (°)" if steep else "Upwards (°)")
    return np.stack([np.cross(upwards, pole), upwards]), labels


def _draw_sphere(axes: Axes3D, pole: Floats) -> None:
    drawn = pole @ _Z_DOWN
    elevation = float(np.clip(np.degrees(np.arcsin(drawn[2])) + _VIEWED_FROM_DEG[0], -_STEEPEST_DEG, _STEEPEST_DEG))
    azimuth = float(np.degrees(np.arctan2(drawn[1], drawn[0]))) + _VIEWED_FROM_DEG[1]
    axes.view_init(elev=elevation, azim=azimuth)
    e, a = np.radians(elevation), np.radians(azimuth)
    viewer = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    around, along = np.linspace(0, 2 * np.pi, 73), np.linspace(-np.pi / 2, np.pi / 2, 37)
    parallels = [_on_sphere(around, np.full_like(around, latitude)) for latitude in np.radians(np.arange(-60, 61, 30))]
    meridians = [_on_sphere(np.full_like(along, longitude), along) for longitude in np.radians(np.arange(0, 360, 30))]
    for line in (*parallels, *meridians):
        front = np.where((line @ viewer > 0)[:, None], line, np.nan)
        axes.plot(*line.T, color=GREY, linewidth=0.2, alpha=0.4, zorder=1)
        axes.plot(*front.T, color=GREY, linewidth=0.5, zorder=1)
    across = np.array([-np.sin(a), np.cos(a), 0.0])
    rim = np.outer(np.cos(around), across) + np.outer(np.sin(around), np.cross(viewer, across))
    axes.plot(*rim.T, color=GREY, linewidth=0.8, zorder=1)
    for direction, name in zip(_Z_DOWN, ("x", "y", "z"), strict=True):
        axes.plot(*np.stack([np.zeros(3), direction]).T, color=BLACK, linewidth=0.8, zorder=2)
        axes.text(*(1.13 * direction), name, fontsize=8, ha="center", va="center", zorder=5)
    axes.set_proj_type("ortho")
    axes.set_box_aspect((1, 1, 1), zoom=1.65)
    axes.set_axis_off()
    axes.set_anchor("N")


def _on_sphere(longitude: Floats, latitude: Floats) -> Floats:
    flat = np.cos(latitude)
    return np.stack([flat * np.cos(longitude), flat * np.sin(longitude), np.sin(latitude)], axis=-1)


def rotation_axis_caption(samples: pd.DataFrame, hand_measured: ArrayLike) -> str:
    """The mean angle with its sigma, how far the axis scatters, and the hand measurement's difference."""
    axis, angle_deg = axis_and_angle(usable_chain(samples)[:, 3:])
    hand_axis, hand_deg = axis_and_angle(np.asarray(hand_measured, dtype=float)[3:])
    pole = axis.mean(axis=0) / np.linalg.norm(axis.mean(axis=0))
    scatter = np.degrees(np.sqrt(np.mean(np.sum((axis - pole) ** 2, axis=1))))
    off = np.degrees(np.arccos(np.clip(pole @ hand_axis, -1, 1)))
    return (
        "The sampled rotation from camera to body as an axis (coloured by density) and an angle of "
        f"{angle_deg.mean():.2f}° ± {angle_deg.std():.2f}°. The axes scatter by {scatter:.2f}° (RMS). The hand-measured"
        f" rotation, red, has its axis {off:.1f}° off and an angle of {float(hand_deg):.1f}°."
    )


FIGURES: Final = (
    FigureEntry(
        "rotation_axis",
        "Rotation axis and angle",
        "sampled rotation axes on a sphere and close up, and a histogram of the angle",
        (
            "mcmc/inliers",
            "pose",
        ),
        lambda r: rotation_axis(r.samples, r.marked_poses()),
        lambda r: rotation_axis_caption(r.samples, r.pose_of("hand_measured")),
    ),
)
