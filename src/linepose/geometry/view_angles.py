"""View angles of a line's pixels, as makers of cameras measure them."""

from functools import lru_cache
from typing import Annotated, Final

import numpy as np
from pydantic import Field, model_validator

from linepose.arrays import Floats
from linepose.geometry.lens import interpolated, monotone_slopes
from linepose.settings import Settings, SettingsError

_Angle = Annotated[float, Field(gt=-89.0, lt=89.0)]
FEWEST: Final = 4


class ViewAngles(Settings):
    """A table of angles: pixel i is seen along the ray (tan across, tan along, 1) in the camera's axes."""

    pixel: tuple[float, ...] = Field(min_length=FEWEST, description="Pixels, from 0 at the first one's centre (px).")
    across_deg: tuple[_Angle, ...] = Field(
        description="Angle of each along the scan line, rising with the pixel (deg)."
    )
    along_deg: tuple[_Angle, ...] = Field(
        (), description="Angle of each across the scan line, to the camera's y (deg); none where the line is straight."
    )

    @model_validator(mode="after")
    def _is_a_table(self) -> "ViewAngles":
        n_angles = {name: len(getattr(self, name)) for name in ("across_deg", "along_deg")}
        for name, count in n_angles.items():
            if count != len(self.pixel) and (count or name == "across_deg"):
                expected = f"{len(self.pixel)}, as many angles as pixels"
                raise SettingsError(f"{count} values", expected, "give one for each pixel", name)
        if (fallen := np.flatnonzero(np.diff(self.pixel) <= 0)).size:
            found = f"{self.pixel[fallen[0] + 1]:g} after {self.pixel[fallen[0]]:g}"
            raise SettingsError(found, "pixels that rise from row to row", "sort the rows", "pixel")
        steps = np.diff(self.across_deg)
        if (fallen := np.flatnonzero(steps <= 0)).size:
            at = fallen[0]
            found = f"{self.across_deg[at + 1]:g} after {self.across_deg[at]:g}, at pixel {self.pixel[at + 1]:g}"
            remedy = "turn all signs" if np.all(steps < 0) else "correct it"
            raise SettingsError(found, "across_deg that rises from pixel to pixel", remedy, "across_deg")
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


@lru_cache(maxsize=8)
def knots(table: ViewAngles) -> tuple[Floats, Floats, Floats, Floats, Floats]:
    """x, s with its slope, and y with its slope, as `Lens` takes them; (T,) each."""
    x = table.x
    s = (np.asarray(table.pixel) - table.principal_point_px) / table.focal_length_px
    y = np.tan(np.deg2rad(table.along_deg)) if table.along_deg else np.zeros_like(x)
    return x, s, monotone_slopes(x, s), y, monotone_slopes(x, y)
