"""Pictures of the board under known distortions, drawn independently of the simulator's ray caster."""

from dataclasses import dataclass

import numpy as np
import pytest
from scipy import ndimage

from linepose.survey import pattern

SAMPLES = 3  # per pixel, each way
DARK, BRIGHT, GROUND = 0.05, 0.80, 0.25


@dataclass(frozen=True)
class Picture:
    """Intensity (L, P) and the true position (15, 2) of each point as u and line."""

    intensity: np.ndarray
    truth: np.ndarray


def reflectance(x, y, covered, with_mark):
    """The print at board points, NaN beside the sheet and where a target is covered."""
    column, row = np.clip(np.rint(x / 0.1511), -2, 2), np.clip(np.rint(y / 0.1669), -1, 1)
    nearest = np.hypot(x - 0.1511 * column, y - 0.1669 * row)
    id_ = 5 * (row + 1) + np.where(row == 0, 2 - column, column + 2)
    white = (nearest < 0.005) | ((nearest > 0.0375) & (nearest < 0.060))
    if with_mark:
        mark = pattern.CORNER_MARK_CENTRE_M
        white |= (abs(x - mark[0]) < 0.02) & (abs(y - mark[1]) < 0.02)
    white |= (abs(x) > 0.4105) | (abs(y) > 0.287)
    value = np.where(white, BRIGHT, DARK)
    outside = (abs(x) > 0.4205) | (abs(y) > 0.297) | (np.isin(id_, covered) & (nearest < 0.060))
    return np.where(outside, np.nan, value)


def draw(matrix, offset, shape=(400, 300), bend=0.0, covered=(), with_mark=True, noise=0.004, seed=0):
    """A picture where board point b lies at `u, l = matrix b + offset`, and u then moves by `bend (l - offset)^2`."""
    rng = np.random.default_rng(seed)
    matrix, offset = np.asarray(matrix, dtype=float), np.asarray(offset, dtype=float)
    fine = (np.arange(SAMPLES) + 0.5) / SAMPLES - 0.5
    line = (np.arange(shape[0])[:, None] + fine).ravel()[:, None]
    u = (np.arange(shape[1])[:, None] + fine).ravel()[None, :] - bend * (line - offset[1]) ** 2
    inverse = np.linalg.inv(matrix)
    x = inverse[0, 0] * (u - offset[0]) + inverse[0, 1] * (line - offset[1])
    y = inverse[1, 0] * (u - offset[0]) + inverse[1, 1] * (line - offset[1])
    texture = GROUND * (1 + 0.5 * ndimage.gaussian_filter(rng.standard_normal(shape), 4) / 0.07)
    value = reflectance(x, y, list(covered), with_mark)
    ground = np.kron(texture, np.ones((SAMPLES, SAMPLES)))
    value = np.where(np.isnan(value), ground, value)
    pixels = value.reshape(shape[0], SAMPLES, shape[1], SAMPLES).mean(axis=(1, 3))
    pixels = ndimage.uniform_filter(pixels, 2.0) + noise * rng.standard_normal(shape)
    truth = pattern.board_points()[:, :2] @ matrix.T + offset
    truth[:, 0] += bend * (truth[:, 1] - offset[1]) ** 2
    return Picture((4000 * pixels).astype(np.float32), truth + 0.5)  # a filter of even size shifts by half a pixel


@pytest.fixture(scope="session")
def drawn():
    return draw
