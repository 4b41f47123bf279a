"""Figure 12: the sampled poses on a sketch of the platform."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle
from numpy.typing import ArrayLike

from linepose.config.outline import OutlineSection, OutlineViewSection
from linepose.figures.checks import some_rows, usable_rows
from linepose.figures.style import BLACK, BLUE, ESTIMATE, HAND_MEASURED, TRUTH, WIDE_IN, blank_figure, few_ticks, styled
from linepose.pose import POSE_COLUMNS
from linepose.rotations import Floats, matrix_from_rotation_vector

_MARKS = {"optimum": (ESTIMATE, "s"), "hand measured": (HAND_MEASURED, "D"), "truth": (TRUTH, "o")}
_SHOWN_AXES = 200
_AXIS_LENGTH_M = 1.5
_BINS = 40
_DENSITY = LinearSegmentedColormap.from_list("density", [(0, 0.45, 0.7, 0.0), (0, 0.45, 0.7, 1.0)])


@styled
def platform_sketch(samples: pd.DataFrame, outline: OutlineSection, marked: Mapping[str, ArrayLike]) -> Figure:
    """From the side and from the front: where the camera is (2D histogram), where it looks (lines), the marked poses.

    `samples` as in `result_schemas.SAMPLES`; `marked` has poses (6,) by name: optimum, hand measured, truth.
    """
    chain = usable_rows(samples, POSE_COLUMNS, "samples")[list(POSE_COLUMNS)].to_numpy()
    thin = some_rows(chain, _SHOWN_AXES)
    figure = blank_figure(WIDE_IN, 2.6)
    panels = figure.subplots(1, 2)
    for panel, axis, view, label, title in (
        (panels[0], 0, outline.side, "Forward (m)", "side"),
        (panels[1], 1, outline.front, "Right (m)", "front"),
    ):
        _draw_outline(panel, view)
        panel.add_collection(LineCollection(list(_optical_axes(thin, axis)), colors=BLUE, alpha=0.05, linewidths=1.0))
        panel.hist2d(chain[:, axis], -chain[:, 2], bins=_BINS, cmap=_DENSITY, zorder=3)
        for name, pose in marked.items():
            one = np.asarray(pose, dtype=float)
            colour, marker = _MARKS[name]
            panel.add_collection(LineCollection(list(_optical_axes(one[None], axis)), colors=colour, linewidths=1.0))
            panel.plot(one[axis], -one[2], marker=marker, color=colour, markersize=3, zorder=4)
        panel.set_aspect("equal", adjustable="datalim")
        panel.autoscale_view()
        panel.set(xlabel=label, ylabel="Up (m)")
        panel.set_title(title, loc="left")
        few_ticks(panel)
    panels[1].invert_xaxis()
    handles = [Line2D([], [], color=_MARKS[name][0], marker=_MARKS[name][1], label=name) for name in marked]
    handles += [Line2D([], [], color=BLUE, alpha=0.35, linewidth=3, label="sampled poses, optical axes")]
    figure.legend(handles=handles, loc="outside upper center", ncols=4, columnspacing=1.0)
    return figure


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
    sigma_mm = 1e3 * samples[list(POSE_COLUMNS[:3])].std().to_numpy()
    return (
        "The sampled camera positions (shaded) and optical axes (lines) on the platform, seen from the side and from "
        f"the front. The positions scatter by {sigma_mm[0]:.0f} mm forward, {sigma_mm[1]:.0f} mm to the right and "
        f"{sigma_mm[2]:.0f} mm down. The outline is a sketch for orientation, not to the millimetre."
    )
