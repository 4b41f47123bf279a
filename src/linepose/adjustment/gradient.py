"""Gradient of the levels' density, analytic: one pass backwards costs about as much as two forwards.

With C the covariance of the measurements, A the columns, N = U^T U the normal equations and v = C^-1 (e - A x),

    d (chi^2 + log|N| + log|C|) = - v^T dC v - sum_j B_j^T dC B_j + tr(C^-1 dC),     B = C^-1 A U^-1.

chi^2 needs no derivative of the minimum (envelope theorem). v is one column more of B, so both are quadratic forms in
dC, which recursions along the lines add up; the trace is the filter's covariance recursion backwards.
"""

from typing import Final, NamedTuple

import numpy as np

from linepose.adjustment.levels import Levels
from linepose.adjustment.normal import Pass
from linepose.adjustment.process import Components, ErrorImage, ErrorStructure, Weights
from linepose.adjustment.whitening import N_STATE, Factor, unwhiten_columns
from linepose.arrays import Floats
from linepose.compiling.kernels import kernel

DRIFT, WHITE, CONSTANT, PIXEL, LATENESS, TIME, ATTITUDE = range(7)
_N: Final = 7


class Slopes(NamedTuple):
    """Derivatives of a function of C: by logarithms of every level (7,), of every view's variance of the constant (N,),
    of every measurement's variance of the noise (L,).
    """

    by_level: Floats
    by_view: Floats
    by_measurement: Floats


@kernel
def slopes_of_density(
    structure: ErrorStructure, image: ErrorImage, process: Components, levels: Levels, weights: Weights, done: Pass
) -> Slopes:
    """Derivatives of `chi^2 + log|C| + log|N|`."""
    columns = reduced_columns(done)
    dual = unwhiten_columns(done.factor, columns)
    one = determinant_part(structure, image, process, levels, weights, done.factor)
    other = quadratic_part(structure, image, process, levels, weights, dual)
    return Slopes(one.by_level - other.by_level, one.by_view - other.by_view, one.by_measurement - other.by_measurement)


@kernel
def reduced_columns(done: Pass) -> Floats:
    """Whitened columns (2 L, n) times `U^-1`, and as the last one the whitened residual at the minimum."""
    n = done.upper.shape[0]
    inverse = inverse_upper(done.upper)
    out = np.zeros((done.whitened.shape[0], n))
    for row in range(done.whitened.shape[0]):
        target, source = out[row], done.whitened[row]
        i = 0
        while i + 8 <= n:
            i0, i1, i2, i3 = inverse[i], inverse[i + 1], inverse[i + 2], inverse[i + 3]
            i4, i5, i6, i7 = inverse[i + 4], inverse[i + 5], inverse[i + 6], inverse[i + 7]
            a0, a1, a2, a3 = source[i], source[i + 1], source[i + 2], source[i + 3]
            a4, a5, a6, a7 = source[i + 4], source[i + 5], source[i + 6], source[i + 7]
            for j in range(i, n):
                first = a0 * i0[j] + a1 * i1[j] + a2 * i2[j] + a3 * i3[j]
                target[j] += first + (a4 * i4[j] + a5 * i5[j] + a6 * i6[j] + a7 * i7[j])
            i += 8
        while i < n:
            i0, a0 = inverse[i], source[i]
            for j in range(i, n):
                target[j] += a0 * i0[j]
            i += 1
    return out


@kernel
def inverse_upper(upper: Floats) -> Floats:
    """Inverse (n, n) of the triangular factor of a pass, its last pivot taken as one."""
    n = upper.shape[0]
    inverse = np.zeros((n, n))
    for i in range(n - 1, -1, -1):
        row, pivot = inverse[i], 1.0 if i == n - 1 else upper[i, i]
        row[i] = 1.0
        for k in range(i + 1, n):
            factor, other = upper[i, k], inverse[k]
            for j in range(k, n):
                row[j] -= factor * other[j]
        for j in range(i, n):
            row[j] /= pivot
    return inverse


@kernel
def quadratic_part(
    structure: ErrorStructure, image: ErrorImage, process: Components, levels: Levels, weights: Weights, dual: Floats
) -> Slopes:
    """Sum over columns b (2 L,) of `b^T dC b`.

    `s = (J F)^T b` is what a column has in the state's axes; g what decays of it from all lines before, h the same by
    how long ago; primed is the derivative by the logarithm of the attitude's level, which scales a part of F.
    """
    n_lines, n = dual.shape[0] // 2, dual.shape[1]
    total = np.zeros((_N, n))
    by_view, by_measurement = np.zeros(weights.of_view.shape[0]), np.zeros(n_lines)
    s, t = np.empty(n), np.empty(n)
    g, h, gp = np.zeros((6, n)), np.zeros((6, n)), np.zeros((6, n))
    of_view, of_view_p = np.zeros((6, n)), np.zeros((6, n))
    drift2, white2, late2 = process.drift**2, levels.white**2, levels.lateness**2
    along2 = (levels.pixel * structure.sigma_u_px) ** 2
    drift_sum, time_sum, attitude_sum = total[DRIFT], total[TIME], total[ATTITUDE]
    white_sum, pixel_sum, late_sum = total[WHITE], total[PIXEL], total[LATENESS]
    for line in range(n_lines):
        b0, b1 = dual[2 * line], dual[2 * line + 1]
        decay, gap = process.decay[line], structure.gap_s[line] if line else 0.0
        inverse_weight = 1.0 / weights.of_measurement[line]
        white = white2 * inverse_weight
        if structure.begins[line]:
            of_view[:] = 0.0
            of_view_p[:] = 0.0
        view = structure.view_of[line]
        constant2 = process.constant[view] ** 2
        for i in range(6):
            u, v = process.by_state[line, 0, i], process.by_state[line, 1, i]
            up, vp = levels.attitude * image.by_attitude[line, 0, i], levels.attitude * image.by_attitude[line, 1, i]
            gi, hi, gpi, q, qp = g[i], h[i], gp[i], of_view[i], of_view_p[i]
            for j in range(n):
                s[j] = u * b0[j] + v * b1[j]
                t[j] = up * b0[j] + vp * b1[j]
            for j in range(n):
                gi[j] *= decay
                gpi[j] *= decay
                hi[j] = decay * hi[j] + gap * gi[j]
            for j in range(n):
                drift_sum[j] += 2.0 * drift2 * s[j] * (s[j] + 2.0 * gi[j])
                time_sum[j] += 2.0 * drift2 * s[j] * hi[j]
                white_sum[j] += 2.0 * white * s[j] * s[j]
            for j in range(n):
                attitude_sum[j] += 2.0 * (white + drift2 + constant2) * s[j] * t[j]
            for j in range(n):
                attitude_sum[j] += 2.0 * drift2 * (t[j] * gi[j] + s[j] * gpi[j])
                attitude_sum[j] += 2.0 * constant2 * (t[j] * q[j] + s[j] * qp[j])
            for j in range(n):
                gi[j] += s[j]
                gpi[j] += t[j]
                q[j] += s[j]
                qp[j] += t[j]
        d0, d1, d2 = process.noise[line, 0], process.noise[line, 1], process.noise[line, 2]
        for j in range(n):
            by_measurement[line] += d0 * b0[j] * b0[j] + 2.0 * d1 * b0[j] * b1[j] + d2 * b1[j] * b1[j]
        a = 2.0 * inverse_weight * along2
        uu, uv, vv = image.late[line, 0], image.late[line, 1], image.late[line, 2]
        c = 2.0 * inverse_weight * late2
        if line == n_lines - 1 or structure.begins[line + 1]:
            for i in range(6):
                for j in range(n):
                    by_view[view] += constant2 * of_view[i, j] ** 2
        for j in range(n):
            pixel_sum[j] += a * b0[j] * b0[j]
            late_sum[j] += c * (uu * b0[j] * b0[j] + 2.0 * uv * b0[j] * b1[j] + vv * b1[j] * b1[j])
    out = np.zeros(_N)
    for i in range(_N):
        for j in range(n):
            out[i] += total[i, j]
    out[TIME] /= levels.correlation_time_s
    out[CONSTANT] = 2.0 * np.sum(by_view)
    return Slopes(out, by_view, by_measurement)


@kernel
def determinant_part(
    structure: ErrorStructure, image: ErrorImage, process: Components, levels: Levels, weights: Weights, factor: Factor
) -> Slopes:
    """Derivatives of log|C|: the filter's covariance recursion backwards.

    With adjoint Q of the covariance P after a line, `K = P H^T / S` and `Y = Q K`: that of the noise is
    `E = K^T Y + S^-1`, of the observation matrix H `2 (K^T - Y^T P)`, of the covariance before the line
    `Q - H^T Y^T - Y H + H^T E H`.
    """
    n = process.decay.shape[0]
    after = np.empty((n + 1, N_STATE, N_STATE))
    p = np.eye(N_STATE)
    after[0] = p
    for line in range(n):
        predict(p, process.decay[line], structure.begins[line])
        for i in range(N_STATE):
            a, b, row = factor.gain[line, i, 0], factor.gain[line, i, 1], p[i]
            for j in range(N_STATE):
                row[j] -= a * factor.gain[line, j, 0] + b * factor.gain[line, j, 1]
        after[line + 1] = p
    out = np.zeros(_N)
    by_view, by_measurement = np.zeros(weights.of_view.shape[0]), np.zeros(n)
    white2, late2 = levels.white**2, levels.lateness**2
    along2 = (levels.pixel * structure.sigma_u_px) ** 2
    q, k, y, by_observe = (
        np.zeros((N_STATE, N_STATE)),
        np.empty((2, N_STATE)),
        np.empty((2, N_STATE)),
        np.empty(N_STATE),
    )
    for line in range(n - 1, -1, -1):
        i00, l10, i11 = factor.root[line, 0], factor.root[line, 1], factor.root[line, 2]
        k0, k1, y0, y1 = k[0], k[1], y[0], y[1]
        for i in range(N_STATE):
            k1[i] = factor.gain[line, i, 1] * i11
            k0[i] = (factor.gain[line, i, 0] - k1[i] * l10) * i00
            y0[i], y1[i] = 0.0, 0.0
        for i in range(N_STATE):
            a, b, row = k0[i], k1[i], q[i]
            for j in range(N_STATE):
                y0[j] += a * row[j]
                y1[j] += b * row[j]
        e00, e10, e11 = i00 * i00 * (1.0 + l10 * l10 * i11 * i11), -l10 * i00 * i11 * i11, i11 * i11
        for i in range(N_STATE):
            e00 += k0[i] * y0[i]
            e10 += k1[i] * y0[i]
            e11 += k1[i] * y1[i]
        inverse_weight = 1.0 / weights.of_measurement[line]
        view = structure.view_of[line]
        constant, covariance = process.constant[view], after[line + 1]
        by_measurement[line] = (
            process.noise[line, 0] * e00 + 2.0 * process.noise[line, 1] * e10 + process.noise[line, 2] * e11
        )
        for row in range(2):
            yr, kr = y[row], k[row]
            for j in range(N_STATE):
                by_observe[j] = 2.0 * kr[j]
            for i in range(N_STATE):
                a, c = 2.0 * yr[i], covariance[i]
                for j in range(N_STATE):
                    by_observe[j] -= a * c[j]
            for i in range(6):
                unit = process.by_state[line, row, i]
                other = process.by_state[line, 1 - row, i]
                out[DRIFT] += by_observe[i] * process.drift * unit
                by_view[view] += 0.5 * by_observe[6 + i] * constant * unit
                noise = (e00 if row == 0 else e11) * unit + e10 * other
                out[WHITE] += 2.0 * white2 * inverse_weight * noise * unit
                by_unit = process.drift * by_observe[i] + constant * by_observe[6 + i]
                by_unit += 2.0 * white2 * inverse_weight * noise
                out[ATTITUDE] += by_unit * levels.attitude * image.by_attitude[line, row, i]
        out[PIXEL] += 2.0 * inverse_weight * along2 * e00
        late = e00 * image.late[line, 0] + 2.0 * e10 * image.late[line, 1] + e11 * image.late[line, 2]
        out[LATENESS] += 2.0 * inverse_weight * late2 * late
        h0, h1 = factor.observe[line, 0], factor.observe[line, 1]
        for i in range(N_STATE):
            row = q[i]
            a0, a1 = e00 * h0[i] + e10 * h1[i] - y0[i], e10 * h0[i] + e11 * h1[i] - y1[i]
            b0, b1 = h0[i], h1[i]
            for j in range(N_STATE):
                row[j] += a0 * h0[j] + a1 * h1[j] - b0 * y0[j] - b1 * y1[j]
        decay, before = process.decay[line], after[line]
        by_decay = 0.0
        for i in range(6):
            by_decay -= 2.0 * decay * q[i, i]
            for j in range(6):
                by_decay += 2.0 * decay * q[i, j] * before[i, j]
                q[i, j] *= decay * decay
            for j in range(6, N_STATE):
                if structure.begins[line]:
                    q[i, j] = 0.0
                else:
                    by_decay += 2.0 * q[i, j] * before[i, j]
                    q[i, j] *= decay
                q[j, i] = q[i, j]
        if structure.begins[line]:
            q[6:, 6:] = 0.0
        if line:
            out[TIME] += by_decay * decay * structure.gap_s[line] / levels.correlation_time_s
    out[CONSTANT] = 2.0 * np.sum(by_view)
    return Slopes(out, by_view, by_measurement)


@kernel
def predict(p: Floats, decay: float, begins: bool) -> None:
    """Replace the state's covariance (12, 12) by that of the next line, in a view that begins there or not."""
    decay2 = decay * decay
    for i in range(6):
        if begins:
            for j in range(N_STATE):
                p[6 + i, j] = 0.0
                p[j, 6 + i] = 0.0
            p[6 + i, 6 + i] = 1.0
    for i in range(6):
        for j in range(6):
            p[i, j] *= decay2
        for j in range(6, N_STATE):
            p[i, j] *= decay
            p[j, i] *= decay
        p[i, i] += 1.0 - decay2
