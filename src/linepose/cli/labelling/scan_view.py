"""A scan as the labelling window shows it: as it was recorded, or rectified on the ground."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from linepose.cli.labelling.session import Place
from linepose.errors import InputError
from linepose.inputs.scans.scan_files import Intensity, read_intensity, read_scan
from linepose.inputs.source import ScansSection

if TYPE_CHECKING:
    from linepose.inputs.targets.rectified import HandView


@dataclass(frozen=True)
class ScanView:
    """Light of a scan (L, P), the picture (H, W) that is shown of it, and the way between their places.

    `to_scan` takes column and row of the picture to pixel and line, `to_picture` the other way; None where there is no
    such place. `axes` says what columns and rows are, which are alike long on a map, `note` what a person should know.
    """

    intensity: Intensity
    picture: NDArray[np.float32] | Intensity
    to_scan: Callable[[float, float], Place | None]
    to_picture: Callable[[float, float], Place | None]
    axes: tuple[str, str] = ("pixel", "scan line")
    is_map: bool = False
    note: str = ""


def as_recorded(path: Path) -> ScanView:
    """A scan file, line below line."""
    return _recorded(read_intensity(path))


def rectified(view: "HandView", source: ScansSection, range_m: float) -> Callable[[Path], ScanView]:
    """What shows a scan file rectified on level ground, this far along the optical axis, with the pose at hand.

    A scan that cannot be rectified is shown as it was recorded, with a note.
    """
    from linepose.inputs.scans.line_times import line_times_of

    line_times = line_times_of(source)

    def shown(path: Path) -> ScanView:
        from linepose.inputs.rectified.rectify import rectify
        from linepose.inputs.targets.rectified import lines_within_log
        from linepose.inputs.targets.surfaces import ground_at

        scan = read_scan(path, line_times, view.camera.n_pixels)
        try:
            lines, poses = lines_within_log(scan, view)
            found = rectify(scan.intensity[lines], poses, view.camera, ground_at(poses, range_m))
        except InputError as error:
            return _recorded(scan.intensity, f"shown as recorded: {error}")

        def to_scan(column: float, row: float) -> Place | None:
            u_px, line = found.in_scan([[column, row]])[0].tolist()
            return (u_px, line + lines.start) if np.isfinite(u_px + line) else None

        def to_picture(u_px: float, line: float) -> Place | None:
            column, row = found.on_map(np.array([[u_px, line - lines.start]]), poses, view.camera)[0].tolist()
            return (column, row) if np.isfinite(column + row) else None

        metres = f"{1000 * found.cell_m:.3g} mm each"
        axes = (f"across the ground, cells of {metres}", "along it")
        return ScanView(scan.intensity, np.ma.masked_invalid(found.intensity), to_scan, to_picture, axes, is_map=True)

    return shown


def _recorded(intensity: Intensity, note: str = "") -> ScanView:
    n_lines, n_pixels = intensity.shape

    def to_scan(u_px: float, line: float) -> Place | None:
        inside = -0.5 <= u_px <= n_pixels - 0.5 and -0.5 <= line <= n_lines - 0.5
        return (u_px, line) if inside else None

    return ScanView(intensity, intensity, to_scan, lambda u_px, line: (u_px, line), note=note)
