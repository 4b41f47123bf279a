"""The sampled poses on a sketch of the platform."""

from collections.abc import Mapping
from typing import Final

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle, Rectangle
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.config.outline import OutlineSection, OutlineViewSection
from linepose.config.platform import Platform
from linepose.geometry.rotations import matrix_from_rotation_vector
from linepose.output.figures.entry import FigureEntry
from linepose.output.figures.style import (
    BLACK,
    BLUE,
    ON_A_CLOUD,
    POSE_MARKS,
    WIDE_IN,
    blank_figure,
    few_ticks,
    pose_handles,
    styled,
)
from linepose.output.figures.thinning import some_rows
from linepose.pipeline.calibration import Calibration
from linepose.pipeline.table_checks import usable_chain

_SHOWN_AXES: Final = 200
_AXIS_LENGTH_M: Final = 1.5
_BINS: Final = 40
_CLOSE_SIGMAS: Final = 3.5  # half the width of the close-up
_DENSITY: Final = LinearSegmentedColormap.from_list("density", [(0, 0, 0, 0), (0.35, 0.35, 0.35, 0.8), (0, 0, 0, 1)])


@styled
def platform_sketch(samples: pd.DataFrame, outline: OutlineSection, marked: Mapping[str, ArrayLike]) -> Figure:
    """From the side and from the front, whole and close up: the camera's position as a 2D histogram, its optical axes.

    `samples` as in `SAMPLES`; `marked` has poses (6,) by name: optimum, hand measured, truth.
    """
    chain = usable_chain(samples)
    poses = {name: np.asarray(pose, dtype=float) for name, pose in marked.items()}
    figure = blank_figure(WIDE_IN, 4.4)
    panels = figure.subplots(2, 2)
    half_m = _CLOSE_SIGMAS * float(chain[:, :3].std(axis=0).max())
    for column, (axis, view, label, title) in enumerate(
        ((0, outline.side, "Forward (m)", "side"), (1, outline.front, "Right (m)", "front"))
    ):
        centre = (float(chain[:, axis].mean()), -float(chain[:, 2].mean()))
        whole, close = panels[:, column]
        for panel in (whole, close):
            _draw_outline(panel, view)
            _draw_poses(panel, chain, poses, axis)
            panel.set(xlabel=label, ylabel="Up (m)")
            few_ticks(panel, 4)
        whole.add_patch(_frame(centre, half_m))
        whole.set_aspect("equal", adjustable="datalim")
        whole.autoscale_view()
        whole.set_title(title, loc="left")
        close.set(xlim=(centre[0] - half_m, centre[0] + half_m), ylim=(centre[1] - half_m, centre[1] + half_m))
        close.set_aspect("equal")
        close.set_title(f"{title}, close-up", loc="left")
    for panel in panels[:, 1]:
        panel.invert_xaxis()
    handles = pose_handles(poses)
    handles.append(Line2D([], [], color=BLUE, alpha=0.35, linewidth=3, label="sampled optical axes"))
    handles.append(Line2D([], [], color=BLACK, marker="s", linestyle="none", label="sampled positions"))
    figure.legend(handles=handles, loc="outside upper center", ncols=3, columnspacing=1.0)
    return figure


def _draw_poses(panel: Axes, chain: Floats, poses: Mapping[str, Floats], axis: int) -> None:
    lines = list(_optical_axes(some_rows(chain, _SHOWN_AXES), axis))
    panel.add_collection(LineCollection(lines, colors=BLUE, alpha=0.05, linewidths=1.0))
    panel.hist2d(chain[:, axis], -chain[:, 2], bins=_BINS, cmap=_DENSITY, zorder=3)
    for name, one in poses.items():
        colour, marker = POSE_MARKS[name]
        panel.add_collection(LineCollection(list(_optical_axes(one[None], axis)), colors=colour, linewidths=1.0))
        panel.plot(one[axis], -one[2], marker=marker, color=colour, zorder=4, **ON_A_CLOUD)


def _frame(centre: tuple[float, float], half_m: float) -> Rectangle:
    """Where the close-up is."""
    corner = (centre[0] - half_m, centre[1] - half_m)
    return Rectangle(corner, 2 * half_m, 2 * half_m, fill=False, edgecolor=BLACK, linewidth=0.5, linestyle=":")


def _optical_axes(poses: Floats, axis: int) -> Floats:
    """Lines (K, 2, 2) from the camera along its optical axis, in a view that shows this body axis and up."""
    rotation = matrix_from_rotation_vector(np.array(poses[:, 3:]))
    ends = np.stack([poses[:, :3], poses[:, :3] + _AXIS_LENGTH_M * rotation[:, :, 2]], axis=1)
    return ends[:, :, [axis, 2]] * np.array([1.0, -1.0])


def _draw_outline(panel: Axes, view: OutlineViewSection) -> None:
    for line in view.lines:
        corners = np.array(line)
        panel.plot(corners[:, 0], -corners[:, 1], color=BLACK, linewidth=0.8)
    for across, down, radius in view.circles:
        panel.add_patch(Circle((across, -down), radius, fill=False, edgecolor=BLACK, linewidth=0.8))


def platform_sketch_caption(samples: pd.DataFrame) -> str:
    """How large the cloud of camera positions is, and that the outline is a sketch."""
    sigma_mm = 1e3 * usable_chain(samples)[:, :3].std(axis=0, ddof=1)
    return (
        "The sampled camera positions (shaded by density) and optical axes (lines) on the platform, seen from the side "
        "and from the front; below, the dotted squares close up. The positions scatter by "
        f"{sigma_mm[0]:.0f} mm forward, {sigma_mm[1]:.0f} mm to the right and {sigma_mm[2]:.0f} mm down. The outline "
        "is a sketch for orientation, not to the millimetre."
    )


def _sketch(r: Calibration) -> Figure:
    assert r.platform_file.outline is not None
    return platform_sketch(r.samples, r.platform_file.outline, r.marked_poses())


def _without_outline(platform: Platform) -> str:
    return "" if platform.outline else "The platform's file has no outline to draw on: add one under `outline`."


FIGURES: Final = (
    FigureEntry(
        "platform_sketch",
        "Poses on the platform",
        "sampled camera positions and optical axes over a sketch of the platform from the side and the front",
        (
            "mcmc/inliers",
            "pose",
        ),
        _sketch,
        lambda r: platform_sketch_caption(r.samples),
        _without_outline,
    ),
)
