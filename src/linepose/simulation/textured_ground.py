"""Ground as it is seen from the air: heights as a sum of waves, and a texture of several grains without any repeat."""

from dataclasses import dataclass
from typing import Final

import numba
import numpy as np

from linepose.arrays import Floats
from linepose.simulation.flight_section import TexturedGroundSection
from linepose.simulation.scene import smooth_noise

_WAVES: Final = 6
_OCTAVES: Final = 5  # each grain twice as long as the one before
_MEAN: Final = 0.35  # reflectance


@dataclass(frozen=True)
class TexturedGround:
    """Waves (W, 4): amplitude (m), north and east parts of the wave number (rad/m), phase; and what colours it."""

    waves: Floats
    grain_m: float
    contrast: float
    rows_m: float
    seed: int

    def down_m(self, north_east_m: Floats) -> Floats:
        """Down of the ground (...) at places (..., 2)."""
        return -np.asarray(
            np.sum(
                self.waves[:, 0] * np.sin(north_east_m @ self.waves[:, 1:3].T + self.waves[:, 3]),
                axis=-1,
            )
        )


def textured_ground(section: TexturedGroundSection, seed: int) -> TexturedGround:
    """The ground that a seed draws."""
    random = np.random.default_rng([seed, 4])
    number = 2 * np.pi / (section.relief_wavelength_m * random.uniform(0.4, 1.0, _WAVES))
    direction = random.uniform(0, 2 * np.pi, _WAVES)
    amplitude = section.relief_m * np.sqrt(2 / _WAVES) * np.ones(_WAVES)
    phase = random.uniform(0, 2 * np.pi, _WAVES)
    waves = np.column_stack([amplitude, number * np.cos(direction), number * np.sin(direction), phase])
    return TexturedGround(waves, section.grain_m, section.contrast, section.rows_m or 0.0, seed)


@numba.njit(cache=True)
def down_at(north: float, east: float, waves: Floats) -> float:
    """Down of the ground (m)."""
    down = 0.0
    for k in range(len(waves)):
        down -= waves[k, 0] * np.sin(waves[k, 1] * north + waves[k, 2] * east + waves[k, 3])
    return down


@numba.njit(cache=True)
def reflectance_at(north: float, east: float, grain_m: float, contrast: float, rows_m: float, seed: int) -> float:
    """Reflectance of the ground (0 to 1): of plants in rows, or of grains of several sizes."""
    if rows_m > 0.0:
        return _MEAN * (1.0 + contrast * np.cos(2 * np.pi * east / rows_m) * np.cos(2 * np.pi * north / rows_m))
    value, size = 0.0, grain_m
    for octave in range(_OCTAVES):
        value += smooth_noise(north / size, east / size, seed + octave) - 0.5
        size *= 2.0
    return _MEAN * max(0.0, 1.0 + contrast * value)
