"""A point's place in the raw scan: where its part of the print fits the light best.

The print is blurred as the scan is, laid around the point by the local map from board to scan, and shifted until the
light, up to its level and contrast, is that of the scan. This serves corners and dots alike, at any stretch and slant.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy import ndimage

from linepose.arrays import Floats
from linepose.inputs.scans.scan_files import Intensity
from linepose.survey.targets.artwork import Artwork
from linepose.survey.targets.base import GridSection

_REACH: Final = 0.45  # of the spacing: what of the print around a point is matched
_CELLS: Final = 48  # of the picture of the print, along a spacing
_FINER: Final = 5  # times, the picture that a cell is the mean of, so that edges lie where they are printed
_BLURS: Final = (0.3, 0.6, 1.0)  # sigmas in pixels, of which the best is taken
_MOST_LINES: Final = 120  # of a point's window; of more, every second, third, ...
_TURNS: Final = 12
_FEW: Final = 12  # points by which the blur is chosen
_CONVERGED: Final = 3e-4  # of the reach
_FEWEST_PIXELS: Final = 9
_LEAST_ALIKE: Final = 0.7  # correlation of print and light


@dataclass(frozen=True)
class _Print:
    """Light (H, W) of a print, its slopes by x and y (per m), the first cell's centre (2,), and a cell's side (m)."""

    light: Floats
    slope_x: Floats
    slope_y: Floats
    first_m: Floats
    cell_m: float

    def at(self, board_m: Floats) -> tuple[Floats, Floats, Floats]:
        """Light and slopes (n,) at board points (n, 2)."""
        place = ((board_m - self.first_m) / self.cell_m).T[::-1]
        light, slope_x, slope_y = (
            ndimage.map_coordinates(one, place, order=1, mode="nearest")
            for one in (self.light, self.slope_x, self.slope_y)
        )
        return light, slope_x, slope_y


def match_print(
    intensity: Intensity, target: GridSection, board_m: Floats, position: Floats, jacobian: Floats
) -> Floats:
    """Places (n, 2) of u and line of board points (n, 2) near positions (n, 2); NaN where the print does not fit.

    The jacobian (n, 2, 2) is the change of the position with the board point.
    """
    artwork = target.artwork()
    assert artwork is not None
    reach_m = _REACH * target.spacing
    pixel_m = 1 / np.median(np.linalg.norm(jacobian[:, 0], axis=-1))

    def matched(blur: float, chosen: NDArray[np.int64]) -> Floats:
        printed = _blurred(artwork, target.spacing / _CELLS, blur * pixel_m)
        points = zip(board_m[chosen], position[chosen], jacobian[chosen], strict=True)
        return np.array([_shifted(intensity, printed, reach_m, artwork, *one) for one in points])

    few = np.unique(np.linspace(0, len(board_m) - 1, _FEW).astype(int))
    alike = [float(np.nan_to_num(matched(blur, few)[:, 2]).sum()) for blur in _BLURS]
    return matched(_BLURS[int(np.argmax(alike))], np.arange(len(board_m)))[:, :2]


def _blurred(artwork: Artwork, cell_m: float, sigma_m: float) -> _Print:
    fine_m = cell_m / _FINER
    fine = artwork.picture(fine_m).astype(np.float32)
    first = (_FINER - np.array(fine.shape[::-1])) / 2 * fine_m
    fine = np.pad(fine, [(0, -n % _FINER) for n in fine.shape], mode="edge")
    n_rows, n_columns = (n // _FINER for n in fine.shape)
    light = fine.reshape(n_rows, _FINER, n_columns, _FINER).mean(axis=(1, 3))
    light = ndimage.gaussian_filter(light, sigma_m / cell_m, mode="nearest")
    slope_y, slope_x = np.gradient(light, cell_m)
    return _Print(light, slope_x, slope_y, first, cell_m)


def _shifted(
    intensity: Intensity,
    printed: _Print,
    reach_m: float,
    artwork: Artwork,
    board_m: Floats,
    position: Floats,
    jacobian: Floats,
) -> tuple[float, float, float]:
    """Place of one point and the correlation there; NaN where the print does not fit."""
    nothing = (np.nan, np.nan, np.nan)
    half = np.abs(jacobian).sum(axis=1) * reach_m
    low = np.maximum(np.ceil(position - half), 0).astype(int)
    high = np.minimum(np.floor(position + half), np.array(intensity.shape[::-1]) - 1).astype(int)
    if np.any(high <= low):
        return nothing
    step = int(np.ceil((high[1] - low[1] + 1) / _MOST_LINES))
    line, u = np.meshgrid(np.arange(low[1], high[1] + 1, step), np.arange(low[0], high[0] + 1), indexing="ij")
    pixel = np.stack([u.ravel(), line.ravel()], axis=-1)
    light = intensity[pixel[:, 1], pixel[:, 0]].astype(float)
    to_board = np.linalg.inv(jacobian)
    field = np.array([artwork.width_m, artwork.height_m]) / 2
    shift = np.zeros(2)
    for _ in range(_TURNS):
        offset = (pixel - position - shift) @ to_board.T
        near = np.all(np.abs(offset) <= reach_m, axis=1) & np.all(np.abs(board_m + offset) <= field, axis=1)
        if near.sum() < _FEWEST_PIXELS:
            return nothing
        expected, slope_x, slope_y = printed.at(board_m + offset[near])
        seen = light[near]
        level = np.stack([np.ones_like(expected), expected, *offset[near].T], axis=-1)
        values = np.linalg.lstsq(level, seen, rcond=None)[0]
        if values[1] <= 0:
            return nothing
        slopes = -values[1] * np.stack([slope_x, slope_y], axis=-1) @ to_board
        change = np.linalg.lstsq(np.hstack([slopes, level]), seen - level @ values, rcond=None)[0][:2]
        shift = shift + change
        if np.linalg.norm(to_board @ shift) > reach_m:
            return nothing
        if np.linalg.norm(to_board @ change) < _CONVERGED * reach_m:
            break
    alike = float(np.corrcoef(expected, seen)[0, 1]) if np.ptp(seen) > 0 and np.ptp(expected) > 0 else 0.0
    u_px, at = position + shift
    return (float(u_px), float(at), alike) if alike > _LEAST_ALIKE else nothing
