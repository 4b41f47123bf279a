"""View angles of a line's pixels, as makers of cameras measure them."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Final

import numpy as np
from pydantic import Field, model_validator

from linepose.arrays import Floats
from linepose.geometry.lens import interpolated, monotone_slopes
from linepose.settings import Settings, SettingsError

FEWEST: Final = 4
STEEPEST_DEG: Final = 89.0


@dataclass(frozen=True)
class TableFault:
    """What is wrong with a table: the row counted from 0 and the column, None of the table as a whole."""

    row: int | None
    column: str | None
    found: str
    expected: str
    remedy: str


class ViewAngles(Settings):
    """A table of angles: pixel i is seen along the ray (tan across, tan along, 1) in the camera's axes."""

    pixel: tuple[float, ...] = Field(description="Pixels, from 0 at the first one's centre (px).")
    across_deg: tuple[float, ...] = Field(description="Angle of each along the scan line, rising with the pixel (deg).")
    along_deg: tuple[float, ...] = Field(
        (), description="Angle of each across the scan line, to the camera's y (deg); none where the line is straight."
    )

    @model_validator(mode="after")
    def _is_a_table(self) -> "ViewAngles":
        for name, count in {"across_deg": len(self.across_deg), "along_deg": len(self.along_deg)}.items():
            if count != len(self.pixel) and (count or name == "across_deg"):
                expected = f"{len(self.pixel)}, as many angles as pixels"
                raise SettingsError(f"{count} values", expected, "give one for each pixel", name)
        fault = fault_of_rows(self.pixel, self.across_deg, self.along_deg)
        if fault is not None:
            found = fault.found if fault.row is None else f"{fault.found} in row {fault.row + 1}"
            raise SettingsError(found, fault.expected, fault.remedy, fault.column or "")
        return self

    @property
    def x(self) -> Floats:
        """Normalised x (T,) of the pixels."""
        return np.tan(np.deg2rad(self.across_deg))

    @property
    def focal_length_px(self) -> float:
        """Pixels a unit of normalised x, from the first pixel of the table to the last."""
        return float((self.pixel[-1] - self.pixel[0]) / (self.x[-1] - self.x[0]))

    @property
    def principal_point_px(self) -> float:
        """The pixel that is seen straight ahead; the table's middle where none is."""
        if not self.across_deg[0] < 0 < self.across_deg[-1]:
            return (self.pixel[0] + self.pixel[-1]) / 2
        pixel = np.asarray(self.pixel)
        return float(interpolated(np.zeros(1), self.x, pixel, monotone_slopes(self.x, pixel))[0][0])

    def mirrored(self, n_pixels: int) -> "ViewAngles":
        """The table of a line of pixels counted from the other end, the camera turned half about its axis."""
        turned = [tuple(-one for one in values[::-1]) for values in (self.across_deg, self.along_deg)]
        return ViewAngles(
            pixel=tuple(n_pixels - 1 - one for one in self.pixel[::-1]), across_deg=turned[0], along_deg=turned[1]
        )


def fault_of_rows(
    pixel: Sequence[float], across_deg: Sequence[float], along_deg: Sequence[float] = ()
) -> TableFault | None:
    """The first thing that is wrong with the rows of a table; None where nothing is."""
    if len(pixel) < FEWEST:
        return TableFault(None, None, f"{len(pixel)} rows", f"{FEWEST} rows or more", "give the angles of more pixels")
    for column, angles in (("across_deg", across_deg), ("along_deg", along_deg)):
        steep = np.flatnonzero(~(np.abs(angles) < STEEPEST_DEG))
        if steep.size:
            expected = f"angles between {-STEEPEST_DEG:g} and {STEEPEST_DEG:g} deg"
            remedy = "give degrees off the camera's axis (1 mrad is 0.0573 deg)"
            return TableFault(int(steep[0]), column, f"{angles[steep[0]]:g}", expected, remedy)
    fallen = np.flatnonzero(np.diff(pixel) <= 0)
    if fallen.size:
        row = int(fallen[0]) + 1
        again = pixel[row] in pixel[:row]
        found = f"pixel {pixel[row]:g} {'again' if again else f'after {pixel[row - 1]:g}'}"
        remedy = "remove one of its rows" if again else "sort the rows by pixel"
        return TableFault(row, "pixel", found, "pixels that rise from row to row", remedy)
    fallen = np.flatnonzero(np.diff(across_deg) <= 0)
    if fallen.size:
        row = int(fallen[0]) + 1
        found = f"{across_deg[row]:g} after {across_deg[row - 1]:g}"
        remedy = "turn all signs" if len(fallen) == len(pixel) - 1 else "correct the row"
        return TableFault(row, "across_deg", found, "angles that rise with the pixel", remedy)
    return None


def fault_of_width(pixel: Sequence[float], n_pixels: int, key: str = "camera.n_pixels") -> TableFault | None:
    """What is wrong with a table whose pixels are not those of a line; None of one that reaches to its ends.

    Beyond each end there may be one row. `key` is what says the number of pixels.
    """
    whole = pixel[0] <= 0 and pixel[-1] >= n_pixels - 1
    longer = (pixel[1] <= 0 and pixel[0] < -0.5) or (pixel[-2] >= n_pixels - 1 and pixel[-1] > n_pixels - 0.5)
    if whole and not longer:
        return None
    width = round(pixel[-1] - pixel[0] + 1)
    found = f"{width} pixels ({pixel[0]:g} to {pixel[-1]:g})"
    expected = f"{n_pixels} pixels (0 to {n_pixels - 1}), as {key} says"
    if (pixel[0], pixel[-1]) == (1, n_pixels):
        return TableFault(None, None, found, expected, "count pixels from 0: subtract 1 from each")
    return TableFault(None, None, found, expected, "correct the number of pixels, or give this camera's table")


@lru_cache(maxsize=8)
def knots(table: ViewAngles) -> tuple[Floats, Floats, Floats, Floats, Floats]:
    """x, s with its slope, and y with its slope, as `Lens` takes them; (T,) each."""
    x = table.x
    s = (np.asarray(table.pixel) - table.principal_point_px) / table.focal_length_px
    y = np.tan(np.deg2rad(table.along_deg)) if table.along_deg else np.zeros_like(x)
    return x, s, monotone_slopes(x, s), y, monotone_slopes(x, y)
