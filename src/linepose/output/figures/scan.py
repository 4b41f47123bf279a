"""Figures 6 and 7: the stacked scan lines of a few observations, whole and close up at the pattern's points."""

from collections.abc import Sequence
from typing import Any, Final

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patheffects import withStroke

from linepose.arrays import Floats
from linepose.config.platform import Platform
from linepose.errors import InputError
from linepose.inputs.scans.scan_files import Intensity
from linepose.output.figures.entry import FigureEntry
from linepose.output.figures.scan_example import ScanExample, scan_examples
from linepose.output.figures.style import RED, WIDE_IN, blank_figure, few_ticks, styled

_CONTRAST: Final = (0.005, 0.995)  # quantiles shown as black and white
_MARGIN_SHARE: Final = 0.06  # of the sheet's extent
_AROUND_SHARE: Final = 0.25  # the same where the scan is shown whole
_MOSAICS: Final[dict[int, list[Any]]] = {1: [[0]], 2: [[0, 1]], 3: [[0, 2], [1, 2]]}  # a slow one is taller
_TALLEST_IN: Final = 7.0
_BESIDE_IN: Final = 0.56  # for a panel's ticks and labels
_ABOVE_IN: Final = 0.72
_CLOSE_UP_IN: Final = 3.9


@styled
def stacked_scan(examples: Sequence[ScanExample]) -> Figure:
    """Whole scan lines, stacked at one scale, the sheet's edge drawn around the pattern."""
    parts = [(one, _extent(one.outline()[:, 1], len(one.intensity), _AROUND_SHARE)) for one in examples]
    mosaic = _MOSAICS[len(parts)]
    heights = [last - first for _, (first, last) in parts]
    px_in = (WIDE_IN / len(mosaic[0]) - _BESIDE_IN) / parts[0][0].intensity.shape[1]
    columns = [
        sum(heights[place] * px_in + _ABOVE_IN for place in dict.fromkeys(column)) for column in np.transpose(mosaic)
    ]
    figure = blank_figure(WIDE_IN, min(max(columns), _TALLEST_IN))
    panels = figure.subplot_mosaic(mosaic, height_ratios=[heights[row[0]] * px_in + _ABOVE_IN for row in mosaic])
    for place, (one, (first, last)) in enumerate(parts):
        axes = panels[place]
        _show(axes, one.intensity, (first, last), (0, one.intensity.shape[1]))
        axes.set_aspect("equal", anchor="N")
        axes.set_title(one.title)
        axes.plot(*one.outline().T, color=RED, linewidth=0.8)
        axes.set(xlabel="Pixel u (px)", ylabel="Scan line (count)")
    return figure


@styled
def points_in_scan(examples: Sequence[ScanExample]) -> Figure:
    """The pattern's part of scans, each point crossed and numbered; each panel stretched to the same height."""
    figure = blank_figure(WIDE_IN, _CLOSE_UP_IN)
    for axes, one in zip(figure.subplots(1, len(examples), squeeze=False)[0], examples, strict=True):
        n_lines, n_pixels = one.intensity.shape
        outline = one.outline()
        lines, pixels = (_extent(outline[:, axis], size, _MARGIN_SHARE) for axis, size in ((1, n_lines), (0, n_pixels)))
        _show(axes, one.intensity, lines, pixels)
        axes.set_title(one.title)
        u, line = one.points["u_px"].to_numpy(), one.points["line"].to_numpy()
        axes.plot(u, line, "+", color=RED, markersize=5)
        for number, x, y in zip(one.points["point"], u, line, strict=True):
            text = axes.annotate(f"{number}", (x, y), (2.5, 2.5), textcoords="offset points", color=RED, fontsize=8)
            text.set_path_effects([withStroke(linewidth=1.5, foreground="white")])
        axes.set_xlabel("Pixel u (px)")
    figure.axes[0].set_ylabel("Scan line (count)")
    return figure


def stacked_scan_caption(examples: Sequence[ScanExample]) -> str:
    """Which observations, and what to see in them."""
    return (
        f"Scan lines as the camera recorded them, one below the other, all at one scale: {_names(examples)}. "
        "A pass the other way mirrors the pattern, a slow one stretches it. The frame is the sheet's edge as its "
        "points have it."
    )


def labelled_points_caption(examples: Sequence[ScanExample]) -> str:
    """That these points are used."""
    return f"The points that the pose is estimated from, with their numbers: {_names(examples)}."


def detected_points_caption(examples: Sequence[ScanExample]) -> str:
    """That these points were found without labels."""
    return f"Points found without any label, with their numbers: {_names(examples)}."


def _names(examples: Sequence[ScanExample]) -> str:
    names = [one.title.replace("\n", " (").lower() + f", {len(one.points)} points)" for one in examples]
    return ", ".join(names)


def _extent(places: Floats, size: int, margin_share: float) -> tuple[int, int]:
    """First and last but one of the lines or pixels around some places, within the scan."""
    low, high = float(places.min()), float(places.max())
    margin = margin_share * (high - low) + 2.0
    return max(int(low - margin), 0), min(int(high + margin) + 2, size)


def _show(axes: Axes, intensity: Intensity, lines: tuple[int, int], pixels: tuple[int, int]) -> None:
    part = intensity[slice(*lines), slice(*pixels)]
    if 0 in part.shape or not np.all(np.isfinite(part)):
        raise InputError("scan", f"intensities of shape {part.shape}", "finite lines of pixels", "restore it")
    dark, bright = np.quantile(part, _CONTRAST)
    extent = (pixels[0] - 0.5, pixels[1] - 0.5, lines[1] - 0.5, lines[0] - 0.5)
    axes.imshow(part, cmap="gray", vmin=dark, vmax=bright, aspect="auto", extent=extent, interpolation="antialiased")
    axes.grid(visible=False)
    few_ticks(axes)


def _without_scans(platform: Platform) -> str:
    kind = platform.source.kind
    told = "This platform has no scans: its points were labelled before they came here."
    if kind != "labelled_views" and platform.target.artwork() is None:
        return "This platform has no pattern: its points were labelled by name."
    return told if kind == "labelled_views" else ""


def _without_truth(platform: Platform) -> str:
    told = "Detection is tried beside the labels only where the truth is known: in simulated platforms."
    return "" if platform.simulation else told


FIGURES: Final = (
    FigureEntry(
        "stacked_scan",
        "Stacked scan",
        "grey images of a few observations' scan lines with the pattern's sheet framed",
        ("points",),
        lambda r: stacked_scan(scan_examples(r, "points")),
        lambda r: stacked_scan_caption(scan_examples(r, "points")),
        _without_scans,
    ),
    FigureEntry(
        "labelled_points",
        "Points found in the scan",
        "close-ups of the pattern in scans, each point crossed and numbered",
        ("points",),
        lambda r: points_in_scan(scan_examples(r, "points")),
        lambda r: labelled_points_caption(scan_examples(r, "points")),
        _without_scans,
    ),
    FigureEntry(
        "detected_points",
        "Points detected without labels",
        "close-ups of the pattern in scans, each detected point crossed and numbered",
        ("detected_points",),
        lambda r: points_in_scan(scan_examples(r, "detected_points")),
        lambda r: detected_points_caption(scan_examples(r, "detected_points")),
        _without_truth,
    ),
)
