"""Figures 6 and 7: the stacked scan lines of one observation, whole and close up at the pattern's points."""

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke
from numpy.typing import NDArray

from linepose.errors import InputError
from linepose.figures.checks import usable_rows
from linepose.figures.style import HALF_PAGE_IN, RED, blank_figure, few_ticks, styled

Intensity = NDArray[np.float32]

_COLUMNS = ("point", "u_px", "line")
_CONTRAST = (0.005, 0.995)  # quantiles shown as black and white
_MARGIN_SHARE = 0.32  # of the points' extent: their rings and the sheet's edge
_TALLEST = 1.8


@styled
def stacked_scan(intensity: Intensity, points: pd.DataFrame) -> Figure:
    """All scan lines (L, P) stacked, the points' part framed; `points` has point, u_px and line."""
    u, line = _places(intensity, points)
    n_lines, n_pixels = intensity.shape
    figure = blank_figure(HALF_PAGE_IN, 0.6 + HALF_PAGE_IN * min(max(n_lines / n_pixels, 0.6), _TALLEST))
    axes = figure.add_subplot()
    _show(axes, intensity, 0, 0)
    across, along = _around(u, intensity.shape[1]), _around(line, intensity.shape[0])
    axes.plot(
        [across[0], across[1], across[1], across[0], across[0]],
        [along[0], along[0], along[1], along[1], along[0]],
        color=RED,
        label="pattern",
    )
    axes.legend(loc="upper right")
    return figure


@styled
def labelled_points(intensity: Intensity, points: pd.DataFrame) -> Figure:
    """The pattern's part of the scan lines (L, P), each point crossed and numbered; `points` has point, u_px, line."""
    u, line = _places(intensity, points)
    across, along = _around(u, intensity.shape[1]), _around(line, intensity.shape[0])
    first, left = int(np.ceil(along[0])), int(np.ceil(across[0]))
    part = intensity[first : int(along[1]) + 1, left : int(across[1]) + 1]
    figure = blank_figure(HALF_PAGE_IN, 0.6 + HALF_PAGE_IN * min(max(part.shape[0] / part.shape[1], 0.6), _TALLEST))
    axes = figure.add_subplot()
    _show(axes, part, first, left)
    axes.plot(u, line, "+", color=RED, markersize=5)
    for number, x, y in zip(points["point"], u, line, strict=True):
        text = axes.annotate(f"{number}", (x, y), (5, 5), textcoords="offset points", color=RED, fontsize=8)
        text.set_path_effects([withStroke(linewidth=2.0, foreground="white")])
    return figure


def stacked_scan_caption(intensity: Intensity, observation: int) -> str:
    """Which observation, and how many lines of how many pixels."""
    return (
        f"Observation {observation} as the camera recorded it: {intensity.shape[0]} lines of {intensity.shape[1]} "
        "pixels, one below the other. The frame is around the pattern's points; the next figure shows it close up."
    )


def labelled_points_caption(points: pd.DataFrame, observation: int) -> str:
    """How many points were found."""
    return f"The pattern in observation {observation}: {len(points)} points where they were found, with their numbers."


def _places(intensity: Intensity, points: pd.DataFrame) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    rows = usable_rows(points, _COLUMNS, "points of the scan")
    if intensity.ndim != 2 or 0 in intensity.shape or not np.all(np.isfinite(intensity)):
        raise InputError("scan", f"intensities of shape {intensity.shape}", "finite lines of pixels", "restore it")
    return rows["u_px"].to_numpy(dtype=float), rows["line"].to_numpy(dtype=float)


def _around(places: NDArray[np.float64], most: int) -> tuple[float, float]:
    """First and last place of the pattern among so many pixels or lines."""
    low, high = float(places.min()), float(places.max())
    margin = _MARGIN_SHARE * max(high - low, 10.0) + 5.0
    return max(low - margin, -0.5), min(high + margin, most - 0.5)


def _show(axes: Axes, part: Intensity, first: int, left: int) -> None:
    dark, bright = np.quantile(part, _CONTRAST)
    n_lines, n_pixels = part.shape
    extent = (left - 0.5, left + n_pixels - 0.5, first + n_lines - 0.5, first - 0.5)
    axes.imshow(part, cmap="gray", vmin=dark, vmax=bright, aspect="auto", extent=extent, interpolation="antialiased")
    axes.grid(visible=False)
    axes.set(xlabel="Pixel u (px)", ylabel="Scan line (count)")
    few_ticks(axes)
