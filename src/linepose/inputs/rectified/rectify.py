"""A scan as a map of a surface. For each cell the line is sought on which the camera saw it, then the pixel.

Cells of a slow pass are means of all the lines that they hold; no more memory is taken than the map and its way back.
"""

from dataclasses import dataclass
from typing import Final

import numba
import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import ndimage

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.geometry import lens, rotations
from linepose.geometry.camera import Camera, normalised_from_pixel, pixel_directions, pixel_from_normalised
from linepose.inputs.rectified.surface import Surface
from linepose.inputs.scans.scan_files import Intensity

_SEED_CELLS: Final = 16  # cells along a side of the coarse grid in which the search for a cell's line begins
_SEED_PIXELS: Final = 33
_MOST_CELLS: Final = 40_000_000
_MOST_STEPS: Final = 60
_TABLE: Final = 4096
_Place = tuple[float, float, float]
_NO_BEND: Final = np.empty(0)


@dataclass(frozen=True)
class LinePoses:
    """Camera at each line of a scan: centres (L, 3) in the world, matrices (L, 3, 3) camera to world."""

    centre_m: Floats
    matrix: Floats

    def at(self, line: Floats) -> "LinePoses":
        """Camera poses at fractional lines (n,), linear between two lines."""
        first = np.clip(np.floor(line).astype(int), 0, len(self.centre_m) - 2)
        share = line - first
        centre, matrix = (
            one[first] + share.reshape(-1, *[1] * (one.ndim - 1)) * (one[first + 1] - one[first])
            for one in (self.centre_m, self.matrix)
        )
        return LinePoses(centre, matrix)


@dataclass(frozen=True)
class Rectified:
    """A map (H, W) of a surface: its cells' light, and raw pixel and line of each, NaN where the scan saw nothing.

    Cell (row, column) lies at `first_m + cell_m (column, row)` along the surface's axes.
    """

    intensity: NDArray[np.float32]
    u_px: NDArray[np.float32]
    line: NDArray[np.float64]
    surface: Surface
    first_m: Floats
    cell_m: float

    def world(self, place: ArrayLike) -> Floats:
        """World points (..., 3) of places (..., 2), column and row."""
        return self.surface.to_world(self.first_m + self.cell_m * np.asarray(place, dtype=float))

    def in_scan(self, place: ArrayLike) -> Floats:
        """Raw pixels and lines (n, 2) of places (n, 2), column and row, between cells too; NaN where none was seen."""
        at = np.asarray(place, dtype=float)[:, ::-1].T
        return np.stack(
            [
                ndimage.map_coordinates(one, at, output=float, order=1, cval=np.nan, prefilter=False)
                for one in (self.u_px, self.line)
            ],
            axis=-1,
        )

    def on_map(self, position: Floats, poses: LinePoses, camera: Camera) -> Floats:
        """Places (n, 2), column and row, of raw pixels and lines (n, 2); NaN where the camera sees no surface."""
        rays = pixel_directions(camera, position[:, 0])
        seen = [
            _on_surface(poses.at(line[None]), ray[None], self.surface)[0, 0]
            for line, ray in zip(position[:, 1], rays, strict=True)
        ]
        return (np.array(seen) - self.first_m) / self.cell_m


def line_poses(position_m: Floats, euler_rad: Floats, pose: Floats) -> LinePoses:
    """Camera poses from the body's positions (L, 3) and angles (L, 3) and the camera's pose in it (6,)."""
    body = rotations.matrix_from_euler(euler_rad)
    return LinePoses(position_m + body @ pose[:3], body @ rotations.matrix_from_rotation_vector(pose[3:]))


def rectify(
    intensity: Intensity, poses: LinePoses, camera: Camera, surface: Surface, cell_m: float | None = None
) -> Rectified:
    """The map of a scan (L, P) on a surface; a cell is by default what a pixel sees of it.

    Raises InputError where the camera does not look at the surface, or the map would have too many cells.
    """
    n_lines = len(intensity)
    if n_lines < 2:
        raise InputError("rectified scan", f"{n_lines} lines", "two or more", "take a longer scan")
    seed_px = np.linspace(0, camera.n_pixels - 1, _SEED_PIXELS)
    seen = _on_surface(poses, pixel_directions(camera, seed_px), surface)  # (L, S, 2)
    usable = np.isfinite(seen).all(axis=-1)
    if not usable.any():
        raise InputError("rectified scan", "no ray that meets the surface", "a surface in view", "correct its distance")
    if cell_m is None:
        apart = np.linalg.norm(np.diff(seen, axis=1), axis=-1)
        cell_m = float(np.nanmedian(apart)) * (_SEED_PIXELS - 1) / (camera.n_pixels - 1)
    first, last = seen[usable].min(axis=0), seen[usable].max(axis=0)
    extent = np.ceil((last - first) / cell_m) + 1
    if not extent[0] * extent[1] <= _MOST_CELLS:
        found, expected = f"a map of {extent[0]:.0f} x {extent[1]:.0f} cells", f"at most {_MOST_CELLS} cells"
        raise InputError("rectified scan", found, expected, "take larger cells, or correct the surface's distance")
    size = extent.astype(int)
    seeds = np.full(size[::-1] // _SEED_CELLS + 1, -1, dtype=np.int64)
    line = np.broadcast_to(np.arange(n_lines)[:, None], usable.shape)[usable]
    column, row = ((seen[usable] - first) / (cell_m * _SEED_CELLS)).astype(int).T
    seeds[row, column] = line
    ends = normalised_from_pixel(camera, [-1.0, float(camera.n_pixels)])
    ends = np.where(np.isfinite(ends), ends, normalised_from_pixel(camera, [0.0, camera.n_pixels - 1.0]))
    x_table = np.linspace(float(ends[0]), float(ends[1]), _TABLE)
    corner = surface.to_world(first)
    light, u_px, at = _mapped(
        np.ascontiguousarray(intensity, dtype=np.float32),
        poses.centre_m,
        poses.matrix,
        corner,
        surface.axes * cell_m,
        (int(size[1]), int(size[0])),
        _filled(seeds),
        (float(x_table[0]), float(x_table[1] - x_table[0])),
        pixel_from_normalised(camera, x_table),
        _NO_BEND if camera.lens.is_straight else lens.across(x_table, camera.lens),
    )
    return Rectified(light, u_px, at, surface, first, cell_m)


def _on_surface(poses: LinePoses, rays: Floats, surface: Surface) -> Floats:
    """Where rays (S, 3) of every line meet the surface; (L, S, 2), NaN behind the camera."""
    normal = np.cross(*surface.axes)
    direction = rays @ np.swapaxes(poses.matrix, -1, -2)
    with np.errstate(divide="ignore", invalid="ignore"):
        depth = ((surface.origin_m - poses.centre_m) @ normal)[:, None] / (direction @ normal)
    depth = np.where(np.isfinite(depth) & (depth > 0), depth, np.nan)
    return surface.from_world(poses.centre_m[:, None] + depth[..., None] * direction)


def _filled(seeds: NDArray[np.int64]) -> NDArray[np.int64]:
    """The grid with each empty cell beside a filled one filled from it: neighbours of what the scan saw."""
    filled = seeds.copy()
    for shift in ((0, 1), (0, -1), (1, 0), (-1, 0)):
        moved = np.roll(seeds, shift, axis=(0, 1))
        filled = np.where(filled < 0, moved, filled)
    return filled


@numba.njit(cache=True)
def _bend_at(x: float, table: tuple[float, float], bend: Floats) -> float:
    """Where the line lies across a straight one at normalised x, by a table from a first x in steps; 0 where empty."""
    if len(bend) == 0:
        return 0.0
    place = min(max((x - table[0]) / table[1], 0.0), len(bend) - 1.0)
    whole = min(int(place), len(bend) - 2)
    return float(bend[whole] + (place - whole) * (bend[whole + 1] - bend[whole]))


@numba.njit(cache=True)
def _off_line(
    line: float, point: _Place, centre: Floats, matrix: Floats, table: tuple[float, float], bend: Floats
) -> tuple[float, float]:
    """Normalised y off the line, and x, of a world point in the camera of a fractional line; infinite y behind it."""
    first = min(max(int(np.floor(line)), 0), len(centre) - 2)
    share = line - first
    across, along, ahead = 0.0, 0.0, 0.0
    for k in range(3):
        d = point[k] - centre[first, k] - share * (centre[first + 1, k] - centre[first, k])
        across += d * (matrix[first, k, 0] + share * (matrix[first + 1, k, 0] - matrix[first, k, 0]))
        along += d * (matrix[first, k, 1] + share * (matrix[first + 1, k, 1] - matrix[first, k, 1]))
        ahead += d * (matrix[first, k, 2] + share * (matrix[first + 1, k, 2] - matrix[first, k, 2]))
    if ahead <= 0.0:
        return np.inf, 0.0
    return along / ahead - _bend_at(across / ahead, table, bend), across / ahead


@numba.njit(cache=True)
def _line_of(
    start: float,
    point: _Place,
    centre: Floats,
    matrix: Floats,
    table: tuple[float, float],
    bend: Floats,
    n_steps: int,
) -> tuple[float, float]:
    """The fractional line on which a world point is seen, by secants from a start, and its x there; NaN if none."""
    last = len(centre) - 1.0
    line = min(max(start, 0.0), last - 1.0)
    before = line + 1.0
    value_before = _off_line(before, point, centre, matrix, table, bend)[0]
    for _ in range(n_steps):
        value, across = _off_line(line, point, centre, matrix, table, bend)
        slope = (value - value_before) / (line - before) if line != before else 0.0
        if not np.isfinite(slope) or slope == 0.0:
            return np.nan, 0.0
        step = -value / slope
        if abs(step) < 1e-3:
            line += step
            inside = -0.5 <= line <= last + 0.5
            return (line, across) if inside else (np.nan, 0.0)
        before, value_before = line, value
        line = min(max(line + step, -1.0), last + 1.0)
        if line == before:
            return np.nan, 0.0
    return np.nan, 0.0


@numba.njit(cache=True)
def _light_at(intensity: NDArray[np.float32], line: float, u: float, n_around: int) -> float:
    """Mean light of some lines around a fractional one, linear between two pixels and two lines."""
    n_lines, n_pixels = intensity.shape
    left = min(max(int(np.floor(u)), 0), n_pixels - 2)
    share = min(max(u - left, 0.0), 1.0)
    total, weight = 0.0, 0.0
    half = 0.5 * n_around
    for one in range(max(int(np.floor(line - half)), 0), min(int(np.ceil(line + half)), n_lines - 1) + 1):
        part = min(1.0, half + 0.5 - abs(one - line)) if n_around > 1 else 1.0 - abs(one - line)
        if part > 0.0:
            total += part * ((1.0 - share) * intensity[one, left] + share * intensity[one, left + 1])
            weight += part
    return total / weight if weight > 0.0 else np.nan


@numba.njit(cache=True)
def _mapped(
    intensity: NDArray[np.float32],
    centre: Floats,
    matrix: Floats,
    corner: Floats,
    step: Floats,
    size: tuple[int, int],
    seeds: NDArray[np.int64],
    table: tuple[float, float],
    pixel: Floats,
    bend: Floats,
) -> tuple[NDArray[np.float32], NDArray[np.float32], Floats]:
    """Light, pixel and line of every cell of a map of `size`, from its corner by the steps of a cell (2, 3)."""
    (n_rows, n_columns), few = size, _MOST_STEPS // 6
    light = np.full((n_rows, n_columns), np.nan, dtype=np.float32)
    u_px = np.full((n_rows, n_columns), np.nan, dtype=np.float32)
    at = np.full((n_rows, n_columns), np.nan)
    for row in range(n_rows):
        before = np.nan
        for column in range(n_columns):
            seed = seeds[row // _SEED_CELLS, column // _SEED_CELLS]
            if seed < 0:
                before = np.nan
                continue
            point = (
                corner[0] + column * step[0, 0] + row * step[1, 0],
                corner[1] + column * step[0, 1] + row * step[1, 1],
                corner[2] + column * step[0, 2] + row * step[1, 2],
            )
            line, across = np.nan, 0.0
            if np.isfinite(before):
                line, across = _line_of(before, point, centre, matrix, table, bend, few)
            if not np.isfinite(line):
                line, across = _line_of(float(seed), point, centre, matrix, table, bend, _MOST_STEPS)
            place = (across - table[0]) / table[1]
            if not np.isfinite(line) or place < 0.0 or place >= len(pixel) - 1:
                before = np.nan
                continue
            whole = int(place)
            u = pixel[whole] + (place - whole) * (pixel[whole + 1] - pixel[whole])
            apart = abs(line - before) if np.isfinite(before) else 1.0
            if row > 0 and np.isfinite(at[row - 1, column]):
                apart = max(apart, abs(line - at[row - 1, column]))
            before = line
            if u < -0.5 or u > intensity.shape[1] - 0.5:
                continue
            u_px[row, column], at[row, column] = u, line
            light[row, column] = _light_at(intensity, line, u, max(1, int(np.rint(apart))))
    return light, u_px, at
