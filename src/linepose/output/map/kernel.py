"""Rays of all pixels of some lines to the ground, with the covariance of where they meet it; compiled.

A ray from c along w meets the ground of normal n at X = c + s w, `s = n . (G - c) / (n . w)` with G on the ground. To
first order `dX = P (dc + s dw) + w dh / (n . w)`, with `P = I - w n^T / (n . w)` and dh an error of the height.
"""

from typing import Any, Final

import numpy as np
from numba import njit

from linepose.arrays import Floats
from linepose.compiling.kernels import FUSED_ARITHMETIC, kernel_part

FOUND: Final = 0
MISSED: Final = 1  # the ray meets no ground
OUTSIDE: Final = 2  # it leaves the elevation model
IN_HOLE: Final = 3  # heights are missing where it would meet the ground
MET_TWICE: Final = 4  # it meets the ground again behind the first time, which counts
_MOST_STEPS: Final = 60
_MET_M: Final = 1e-8  # of the ground's height, within which a ray has met it
_MARGIN_M: Final = 1e-3  # beyond the lowest and the highest ground, so that a ray begins above it and ends below


@kernel_part
def _height(grid: Floats, corner: Floats, cell: Floats, north: float, east: float, out: Floats) -> int:
    """Height, and its slopes to north and to east, by bilinear interpolation into out (3,); the state."""
    row, column = (corner[0] - north) / cell[0], (east - corner[1]) / cell[1]
    n_rows, n_columns = grid.shape
    if not (row >= 0.0 and column >= 0.0 and row <= n_rows - 1 and column <= n_columns - 1):
        return OUTSIDE
    i, j = min(int(row), n_rows - 2), min(int(column), n_columns - 2)
    a, b = row - i, column - j
    nw, ne, sw, se = float(grid[i, j]), float(grid[i, j + 1]), float(grid[i + 1, j]), float(grid[i + 1, j + 1])
    out[0] = (1 - a) * ((1 - b) * nw + b * ne) + a * ((1 - b) * sw + b * se)
    out[1] = -((1 - b) * (sw - nw) + b * (se - ne)) / cell[0]
    out[2] = ((1 - a) * (ne - nw) + a * (se - sw)) / cell[1]
    return FOUND if out[0] == out[0] else IN_HOLE


@kernel_part
def _above(grid: Floats, corner: Floats, cell: Floats, c: Floats, w: Floats, s: float, out: Floats) -> int:
    """How far (m) the ray's point at s is above the ground, into out[0]; the state."""
    state = _height(grid, corner, cell, c[0] + s * w[0], c[1] + s * w[1], out)
    out[0] = -(c[2] + s * w[2]) - out[0]
    return state


@kernel_part
def _within(least: float, largest: float, c: float, w: float, first: float, last: float) -> tuple[float, float]:
    """The part of first to last along a ray at which c + s w is from least to largest; empty: first above last."""
    if w == 0.0:
        return (first, last) if least <= c <= largest else (1.0, 0.0)
    one, other = (least - c) / w, (largest - c) / w
    return max(first, min(one, other)), min(last, max(one, other))


@kernel_part
def _first_meeting(
    grid: Floats, corner: Floats, cell: Floats, extremes: Floats, c: Floats, w: Floats, out: Floats
) -> tuple[float, int]:
    """Where along the ray it first meets the grid's ground, and the state; slopes there in out[1:3]."""
    if not w[2] > 0.0:
        return 0.0, MISSED
    first, last = max(0.0, (-extremes[1] - _MARGIN_M - c[2]) / w[2]), (-extremes[0] + _MARGIN_M - c[2]) / w[2]
    if last <= 0.0:
        return 0.0, MISSED
    begins = first
    n_rows, n_columns = grid.shape
    first, last = _within(corner[0] - (n_rows - 1) * cell[0], corner[0], c[0], w[0], first, last)
    first, last = _within(corner[1], corner[1] + (n_columns - 1) * cell[1], c[1], w[1], first, last)
    if not first <= last:
        return 0.0, OUTSIDE
    along = np.sqrt(w[0] * w[0] + w[1] * w[1])
    steps = int((last - first) * along / (0.5 * min(cell[0], cell[1]))) + 2
    step = (last - first) / (steps - 1)
    found, meetings, lacking, before, known = 0.0, 0, FOUND, 0.0, False
    for k in range(steps):
        s = first + k * step
        state = _above(grid, corner, cell, c, w, s, out)
        if state != FOUND:
            if meetings == 0:
                lacking = state
            known = False
            continue
        now = out[0]
        if now <= 0.0 and meetings == 0:
            if k == 0:
                return 0.0, MISSED if first == begins else OUTSIDE  # it begins below the ground
            if known:
                found = _between(grid, corner, cell, c, w, s - step, s, out)
            elif lacking != FOUND:
                return 0.0, lacking
            meetings = 1
        elif known and before < 0.0 <= now:
            meetings += 1
        before, known = now, True
    if meetings == 0:
        return 0.0, lacking if lacking != FOUND else OUTSIDE
    state = _above(grid, corner, cell, c, w, found, out)
    if state != FOUND:
        return 0.0, state
    return found, MET_TWICE if meetings > 1 else FOUND


@kernel_part
def _between(
    grid: Floats, corner: Floats, cell: Floats, c: Floats, w: Floats, above: float, below: float, out: Floats
) -> float:
    """Where between a point above the ground and one below it the ray meets it.

    By false position, in which an end that stays counts half (Illinois): a few steps where the ground is smooth.
    """
    _above(grid, corner, cell, c, w, above, out)
    over = out[0]
    _above(grid, corner, cell, c, w, below, out)
    under, kept = out[0], 0
    for _ in range(_MOST_STEPS):
        place = above + (below - above) * over / (over - under)
        _above(grid, corner, cell, c, w, place, out)
        if not abs(out[0]) > _MET_M:  # or in a hole, as its state says
            return place
        if out[0] > 0.0:
            above, over = place, out[0]
            under *= 0.5 if kept == 1 else 1.0
            kept = 1
        else:
            below, under = place, out[0]
            over *= 0.5 if kept == 2 else 1.0
            kept = 2
    return 0.5 * (above + below)


@kernel_part
def _add_with_ray(m: Floats, s: float, c: Floats, by: Floats, wx: float, wy: float, wz: float, t: Floats) -> None:
    """Add to m (3, 3) what c (6,) makes, of centre and turn with a coordinate by which the ray moves as `by` (3,)."""
    t[0, 0] = s * (c[0] + c[4] * wz - c[5] * wy)  # of the ray's end with it
    t[0, 1] = s * (c[1] + c[5] * wx - c[3] * wz)
    t[0, 2] = s * (c[2] + c[3] * wy - c[4] * wx)
    for i in range(3):
        for j in range(3):
            m[i, j] += by[i] * t[0, j] + t[0, i] * by[j]


@kernel_part
def _covariance(
    n: Floats,
    w: Floats,
    s: float,
    c6: Floats,
    cx: Floats,
    cy: Floats,
    along: Floats,
    across: Floats,
    variances: Floats,
    bent: bool,
    m: Floats,
    t: Floats,
) -> None:
    """Covariance (3, 3) of where a ray meets the ground, in m; t (3, 3) is scratch.

    c6 (6, 6): of the centre and of a small turn, in world axes, and cx, cy (6,): of these with x and y; along, across
    (3,): the ray by x and y of the normalised plane; variances (4,): of those two, of the ground's height, and x with
    y.
    """
    wx, wy, wz = s * w[0], s * w[1], s * w[2]
    for i in range(3):  # a turn moves the end of the ray by B = -[s w]x
        r0, r1, r2 = c6[i, 3], c6[i, 4], c6[i, 5]
        t[i, 0], t[i, 1], t[i, 2] = r1 * wz - r2 * wy, r2 * wx - r0 * wz, r0 * wy - r1 * wx
    for i in range(3):
        for j in range(3):
            m[i, j] = (
                c6[i, j]
                + t[i, j]
                + t[j, i]
                + s * s * (variances[0] * along[i] * along[j] + variances[1] * across[i] * across[j])
            )
    for i in range(3):
        r0, r1, r2 = c6[3 + i, 3], c6[3 + i, 4], c6[3 + i, 5]
        t[i, 0], t[i, 1], t[i, 2] = r1 * wz - r2 * wy, r2 * wx - r0 * wz, r0 * wy - r1 * wx
    for j in range(3):
        m[0, j] += t[1, j] * wz - t[2, j] * wy
        m[1, j] += t[2, j] * wx - t[0, j] * wz
        m[2, j] += t[0, j] * wy - t[1, j] * wx
    _add_with_ray(m, s, cx, along, wx, wy, wz, t)
    if bent:
        _add_with_ray(m, s, cy, across, wx, wy, wz, t)
        both = s * s * variances[3]
        for i in range(3):
            for j in range(3):
                m[i, j] += both * (along[i] * across[j] + across[i] * along[j])
    slope = 1.0 / (n[0] * w[0] + n[1] * w[1] + n[2] * w[2])
    for j in range(3):  # P M P^T
        nm = (n[0] * m[0, j] + n[1] * m[1, j] + n[2] * m[2, j]) * slope
        for i in range(3):
            t[i, j] = m[i, j] - w[i] * nm
    for i in range(3):
        nt = (t[i, 0] * n[0] + t[i, 1] * n[1] + t[i, 2] * n[2]) * slope
        for j in range(3):
            m[i, j] = t[i, j] - nt * w[j] + slope * slope * variances[2] * w[i] * w[j]


@kernel_part
def _radius_95(a: float, b: float, c: float, radii: Floats) -> float:
    """Radius that holds 95 % of a normal error of variances a, b and covariance c; radii by the ratio of its axes."""
    half, apart = 0.5 * (a + b), np.sqrt(0.25 * (a - b) * (a - b) + c * c)
    largest, least = np.sqrt(half + apart), np.sqrt(max(half - apart, 0.0))
    if largest == 0.0:
        return 0.0
    place = least / largest * (len(radii) - 1)
    i = min(int(place), len(radii) - 2)
    return float(largest * (radii[i] + (place - i) * (radii[i + 1] - radii[i])))


@njit(cache=True, error_model="numpy", fastmath=FUSED_ARITHMETIC, nogil=True)
def on_the_ground(
    centre: Any,
    turn: Any,
    covariance: Any,
    with_intrinsics: Any,
    camera_turn: Any,
    x: Any,
    y: Any,
    by_intrinsics: Any,
    variances: Any,
    normal: Any,
    offset: float,
    grid: Any,
    corner: Any,
    cell: Any,
    extremes: Any,
    to_map: Any,
    radii: Any,
    igm: Any,
    sigma: Any,
    states: Any,
) -> None:
    """Fill igm (L, 3, P), sigma (L, 4, P) and states (L, P) of lines with P pixels; NaN where there is no ground.

    centre (L, 3), turn (L, 3, 3): camera's centre, and body to world. covariance (L, 6, 6): of the centre and of a
    small turn of the camera, in world axes; with_intrinsics (L, 6, I): of both with the intrinsics. camera_turn (3, 3):
    camera to body. x (P,): normalised, and y (P,), none where the line is straight; by_intrinsics (P, 2, I): their
    derivatives by the intrinsics. variances (P, 4): of x, of y, of the ground's height, and x with y. grid: heights, or
    one cell for the plane of normal (3,) and offset. to_map (3, 3): map axes by north, east, down. radii (R,): of 95 %
    by the ratio of the axes. igm: east, north, up (m) of the survey's own axes. extremes (2,): lowest and highest of
    the grid. sigma: of the three map axes, and the radius of 95 %.
    """
    is_grid = grid.size > 1
    bent, n_intrinsics = len(y) > 0, by_intrinsics.shape[2]
    n, w, out, cx, cy = normal.copy(), np.empty(3), np.empty(3), np.empty(6), np.empty(6)
    m, t, a = np.empty((3, 3)), np.empty((3, 3)), np.empty((3, 3))
    axes = np.empty((3, 3))
    for line in range(centre.shape[0]):
        c = centre[line]
        for i in range(3):
            for j in range(3):
                axes[j, i] = 0.0
                for k in range(3):
                    axes[j, i] += turn[line, i, k] * camera_turn[k, j]
        for pixel in range(x.shape[0]):
            for i in range(3):
                w[i] = axes[0, i] * x[pixel] + axes[2, i]
                if bent:
                    w[i] += axes[1, i] * y[pixel]
            if is_grid:
                s, state = _first_meeting(grid, corner, cell, extremes, c, w, out)
                n[0], n[1], n[2] = -out[1], -out[2], -1.0
            else:
                down = n[0] * w[0] + n[1] * w[1] + n[2] * w[2]
                s = (offset - n[0] * c[0] - n[1] * c[1] - n[2] * c[2]) / down
                state = FOUND if down < 0.0 and s > 0.0 and s < np.inf else MISSED
            states[line, pixel] = state
            if state != FOUND and state != MET_TWICE:
                igm[line, :, pixel] = np.nan
                sigma[line, :, pixel] = np.nan
                continue
            igm[line, 0, pixel], igm[line, 1, pixel] = c[1] + s * w[1], c[0] + s * w[0]
            igm[line, 2, pixel] = -(c[2] + s * w[2])
            for i in range(6):
                cx[i], cy[i] = 0.0, 0.0
                for k in range(n_intrinsics):
                    cx[i] += with_intrinsics[line, i, k] * by_intrinsics[pixel, 0, k]
                    if bent:
                        cy[i] += with_intrinsics[line, i, k] * by_intrinsics[pixel, 1, k]
            _covariance(n, w, s, covariance[line], cx, cy, axes[0], axes[1], variances[pixel], bent, m, t)
            for i in range(3):
                for j in range(3):
                    t[i, j] = to_map[i, 0] * m[0, j] + to_map[i, 1] * m[1, j] + to_map[i, 2] * m[2, j]
            for i in range(3):
                for j in range(3):
                    a[i, j] = t[i, 0] * to_map[j, 0] + t[i, 1] * to_map[j, 1] + t[i, 2] * to_map[j, 2]
                sigma[line, i, pixel] = np.sqrt(max(a[i, i], 0.0))
            sigma[line, 3, pixel] = _radius_95(a[0, 0], a[1, 1], a[0, 1], radii)
