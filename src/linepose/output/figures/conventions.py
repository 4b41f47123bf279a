"""The frames and signs that the whole project uses, for the documentation."""

from typing import Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import FancyArrowPatch, Polygon

from linepose.arrays import Floats
from linepose.output.figures.style import BLACK, BLUE, GREEN, GREY, RED, blank_figure, styled

_WIDTH_IN: Final = 7.2
_HEIGHT_IN: Final = 4.6
_HEADING_DEG: Final = 35.0
_TILT_DEG: Final = 15.0
_DOCUMENT_DPI: Final = 140
_SIDE: Final = np.array([[-1.0, -0.25], [-1.0, 0.2], [0.5, 0.2], [1.0, 0.0], [1.0, -0.25]])
_PLAN: Final = np.array([[-1.0, -0.45], [-1.0, 0.45], [0.6, 0.45], [1.0, 0.0], [0.6, -0.45]])
_REAR: Final = np.array([[-0.6, -0.25], [-0.6, 0.25], [0.6, 0.25], [0.6, -0.25]])
_REACH: Final = 1.75


@styled
def conventions() -> Figure:
    """Four panels: heading from above, roll from behind, pitch from the right, and the camera with its scan line."""
    figure = blank_figure(_WIDTH_IN, _HEIGHT_IN)
    panels = figure.subplots(2, 2).ravel()
    _heading(panels[0])
    _roll(panels[1])
    _pitch(panels[2])
    _camera(panels[3])
    for panel in panels:
        panel.set_aspect("equal")
        panel.set_anchor("W")
        panel.set_axis_off()
    return figure


def _heading(panel: Axes) -> None:
    _title(panel, "From above: yaw clockwise from north")
    turn = _turn(90 - _HEADING_DEG)
    panel.add_patch(Polygon(_PLAN @ turn.T, closed=True, facecolor="#EEEEEE", edgecolor=BLACK, linewidth=0.8))
    _arrow(panel, (0, 0), (0, 1.45), GREY, "north")
    _arrow(panel, (0, 0), (1.45, 0), GREY, "east")
    _arrow(panel, (0, 0), turn @ (1.5, 0), RED, "x forward")
    _arrow(panel, (0, 0), turn @ (0, -1.3), GREEN, "y right")
    _arc(panel, 1.15, 90, 90 - _HEADING_DEG, "+yaw")
    _into_page(panel, (-1.3, -1.2), "down, z: away from you")
    panel.set(xlim=(-_REACH, _REACH + 0.3), ylim=(-1.5, _REACH))


def _roll(panel: Axes) -> None:
    _title(panel, "From behind: positive roll, right side down")
    turn = _turn(-_TILT_DEG)
    panel.add_patch(Polygon(_REAR @ turn.T, closed=True, facecolor="#EEEEEE", edgecolor=BLACK, linewidth=0.8))
    panel.plot([-_REACH, _REACH], [0, 0], color=GREY, linewidth=0.6, linestyle=":")
    _arrow(panel, (0, 0), turn @ (1.4, 0), GREEN, "y right")
    _arrow(panel, (0, 0), turn @ (0, -1.1), BLUE, "z down")
    _arc(panel, 1.05, 0, -_TILT_DEG, "+roll", label_turn_deg=5)
    _into_page(panel, (-1.65, -0.8), "x: away from you")
    panel.set(xlim=(-_REACH, _REACH + 0.3), ylim=(-1.35, 1.0))


def _pitch(panel: Axes) -> None:
    _title(panel, "From the right: positive pitch, nose up")
    turn = _turn(_TILT_DEG)
    panel.add_patch(Polygon(_SIDE @ turn.T, closed=True, facecolor="#EEEEEE", edgecolor=BLACK, linewidth=0.8))
    panel.plot([-_REACH, _REACH], [0, 0], color=GREY, linewidth=0.6, linestyle=":")
    _arrow(panel, (0, 0), turn @ (1.5, 0), RED, "x forward")
    _arrow(panel, (0, 0), turn @ (0, -1.1), BLUE, "z down")
    _arc(panel, 1.25, 0, _TILT_DEG, "+pitch", label_turn_deg=0)
    panel.plot(-1.5, -1.1, "o", color=BLACK, markersize=5, markerfacecolor="white")
    panel.plot(-1.5, -1.1, ".", color=BLACK, markersize=2)
    panel.annotate("y: towards you", (-1.38, -1.1), va="center", fontsize=7)
    panel.set(xlim=(-_REACH, _REACH + 0.3), ylim=(-1.35, 1.0))


def _camera(panel: Axes) -> None:
    _title(panel, "The camera: x along the scan line, z the optical axis")
    across = np.array([1.0, 0.0])
    for end in (-1.0, 1.0):
        panel.plot([0, 1.3 * end], [0, 1.3], color=GREY, linewidth=0.7)
    panel.plot([-1, 1], [1, 1], color=BLACK, linewidth=1.2)
    ticks = np.linspace(-1, 1, 17)
    panel.plot([ticks, ticks], [np.full(17, 0.97), np.full(17, 1.03)], color=BLACK, linewidth=0.6)
    panel.annotate("u = 0", (-1, 1), (-1.1, 0.86), ha="right", fontsize=7)
    panel.annotate("u = n - 1", (1, 1), (1.1, 0.86), ha="left", fontsize=7)
    panel.annotate(r"$u_0$", (0, 1), (-0.06, 1.1), ha="right", fontsize=8)
    panel.annotate(r"$x = (u - u_0)\,/\,f_\mathrm{px}$", (0.1, 1.12), fontsize=7)
    panel.annotate(r"$z = 1$", (0.1, 0.84), fontsize=7)
    _arrow(panel, (0, 0), (0, 1.45), BLUE, "z")
    _arrow(panel, (0, 0), 0.75 * across, RED, "x")
    panel.plot(0, 0, "o", color=BLACK, markersize=3)
    _into_page(panel, (-1.6, -0.3), "y: away from you")
    panel.set(xlim=(-_REACH, _REACH + 0.3), ylim=(-0.45, 1.7))


def _title(panel: Axes, text: str) -> None:
    panel.set_title(text, loc="left")


def _turn(angle_deg: float) -> Floats:
    cosine, sine = np.cos(np.deg2rad(angle_deg)), np.sin(np.deg2rad(angle_deg))
    return np.array([[cosine, -sine], [sine, cosine]])


def _arrow(panel: Axes, start: tuple[float, float], end: Floats | tuple[float, float], colour: str, name: str) -> None:
    end = np.asarray(end, dtype=float)
    panel.add_patch(
        FancyArrowPatch(start, tuple(end), arrowstyle="-|>", mutation_scale=8, color=colour, linewidth=1.2, shrinkA=0)
    )
    beyond = end * (1 + 0.08 / np.linalg.norm(end))
    side = "left" if end[0] > 0.1 else "center"
    panel.annotate(name, tuple(beyond), ha=side, va="bottom" if end[1] >= 0 else "top", color=colour, fontsize=7)


def _arc(panel: Axes, radius: float, start_deg: float, end_deg: float, name: str, label_turn_deg: float = 0.0) -> None:
    angle = np.deg2rad(np.linspace(start_deg, end_deg, 30))
    path = radius * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    panel.plot(*path.T, color=BLACK, linewidth=0.9)
    panel.add_patch(
        FancyArrowPatch(
            tuple(path[-2]), tuple(path[-1]), arrowstyle="-|>", mutation_scale=7, color=BLACK, shrinkA=0, shrinkB=0
        )
    )
    middle = np.deg2rad((start_deg + end_deg) / 2 + label_turn_deg)
    place = 1.12 * radius * np.array([np.cos(middle), np.sin(middle)])
    panel.annotate(name, tuple(place), ha="left", va="center", fontsize=7)


def _into_page(panel: Axes, place: tuple[float, float], name: str) -> None:
    panel.plot(*place, "o", color=BLACK, markersize=5, markerfacecolor="white")
    panel.plot(*place, "x", color=BLACK, markersize=3, markeredgewidth=0.8)
    panel.annotate(name, (place[0] + 0.12, place[1]), va="center", fontsize=7)


if __name__ == "__main__":
    conventions().savefig("docs/images/conventions.png", dpi=_DOCUMENT_DPI, metadata={"Software": None})
