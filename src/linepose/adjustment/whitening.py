"""The filter pass: residuals and columns of the linear model made independent and of unit variance, in linear time.

C, the covariance of all measurements under the error process, is never formed. A Kalman filter whose state is the
error process factors it: its innovations, divided by their roots, are `W e` with `W^T W = C^-1`, W lower triangular.
Applied to the residual and to every column of the design it gives the normal equations and chi squared; the sum of the
innovations' log-determinants is log|C|; its adjoint, backwards, gives `C^-1 e`, and with it every correction.
"""

from typing import Final, NamedTuple

import numpy as np

from linepose.adjustment.process import Components
from linepose.arrays import Floats
from linepose.compiling.kernels import kernel

N_STATE: Final = 12


class Factor(NamedTuple):
    """The filter's gains, which do not depend on data.

    observe (L, 2, 12): image of a unit of the state; gain (L, 12, 2): state by whitened innovation; root (L, 3): that
    of the innovation's covariance, inverted, as (1/l00, l10, 1/l11); decay (L,); begins (L,); log_determinant: log|C|.
    """

    observe: Floats
    gain: Floats
    root: Floats
    decay: Floats
    begins: np.ndarray
    log_determinant: float


@kernel
def factorise(process: Components, view: np.ndarray, begins: np.ndarray) -> Factor:
    """The factor of the covariance of all measurements; log_determinant is NaN where it is not positive definite.

    The state's covariance is held in blocks, of the drift, of the constant and of one with the other: both reach a
    measurement by the same image.
    """
    n = process.decay.shape[0]
    observe, gain, root = np.empty((n, 2, N_STATE)), np.empty((n, N_STATE, 2)), np.empty((n, 3))
    of_drift, of_both, of_constant = np.eye(6), np.zeros((6, 6)), np.eye(6)
    cross = np.empty((4, 6))  # with the innovation: drift by u and v, constant by u and v
    log_determinant, drift = 0.0, process.drift
    for line in range(n):
        constant, decay = process.constant[view[line]], process.decay[line]
        by_u, by_v = process.by_state[line, 0], process.by_state[line, 1]
        if begins[line]:
            for i in range(6):
                for j in range(6):
                    of_both[i, j] = 0.0
                    of_constant[i, j] = 1.0 if i == j else 0.0
        decay2 = decay * decay
        for i in range(6):
            for j in range(6):
                of_drift[i, j] *= decay2
                of_both[i, j] *= decay
            of_drift[i, i] += 1.0 - decay2
        for j in range(6):
            drift_u, drift_v, constant_u, constant_v = 0.0, 0.0, 0.0, 0.0
            for i in range(6):
                with_drift = drift * of_drift[j, i] + constant * of_both[j, i]
                with_constant = drift * of_both[i, j] + constant * of_constant[j, i]
                drift_u += by_u[i] * with_drift
                drift_v += by_v[i] * with_drift
                constant_u += by_u[i] * with_constant
                constant_v += by_v[i] * with_constant
            cross[0, j], cross[1, j], cross[2, j], cross[3, j] = drift_u, drift_v, constant_u, constant_v
        s00, s10, s11 = process.noise[line, 0], process.noise[line, 1], process.noise[line, 2]
        for i in range(6):
            u, v = drift * cross[0, i] + constant * cross[2, i], drift * cross[1, i] + constant * cross[3, i]
            s00 += u * by_u[i]
            s10 += v * by_u[i]
            s11 += v * by_v[i]
        l00 = np.sqrt(s00)
        l10 = s10 / l00
        l11 = np.sqrt(s11 - l10 * l10)
        log_determinant += 2.0 * (np.log(l00) + np.log(l11))
        i00, i11 = 1.0 / l00, 1.0 / l11
        root[line, 0], root[line, 1], root[line, 2] = i00, l10, i11
        for i in range(6):
            for block in range(2):
                first = cross[2 * block, i] * i00
                second = (cross[2 * block + 1, i] - l10 * first) * i11
                cross[2 * block, i], cross[2 * block + 1, i] = first, second
                gain[line, 6 * block + i, 0], gain[line, 6 * block + i, 1] = first, second
            observe[line, 0, i], observe[line, 1, i] = drift * by_u[i], drift * by_v[i]
            observe[line, 0, 6 + i], observe[line, 1, 6 + i] = constant * by_u[i], constant * by_v[i]
        for i in range(6):
            a, b, c, d = cross[0, i], cross[1, i], cross[2, i], cross[3, i]
            for j in range(6):
                of_drift[i, j] -= a * cross[0, j] + b * cross[1, j]
                of_both[i, j] -= a * cross[2, j] + b * cross[3, j]
                of_constant[i, j] -= c * cross[2, j] + d * cross[3, j]
    return Factor(observe, gain, root, process.decay, begins, log_determinant)


@kernel
def whiten(factor: Factor, rows: Floats) -> None:
    """Replace columns (2 L, n), rows u and v of every measurement, by W times them."""
    n_columns = rows.shape[1]
    x = np.zeros((N_STATE, n_columns))
    for line in range(factor.decay.shape[0]):
        e0, e1, decay = rows[2 * line], rows[2 * line + 1], factor.decay[line]
        h0, h1, gain = factor.observe[line, 0], factor.observe[line, 1], factor.gain[line]
        if factor.begins[line]:
            x[6:] = 0.0
        for i in range(0, N_STATE, 4):
            x0, x1, x2, x3 = x[i], x[i + 1], x[i + 2], x[i + 3]
            d0 = decay if i < 6 else 1.0
            d2 = decay if i < 4 else 1.0
            a0, a1, a2, a3 = h0[i] * d0, h0[i + 1] * d0, h0[i + 2] * d2, h0[i + 3] * d2
            b0, b1, b2, b3 = h1[i] * d0, h1[i + 1] * d0, h1[i + 2] * d2, h1[i + 3] * d2
            for j in range(n_columns):
                e0[j] -= a0 * x0[j] + a1 * x1[j] + a2 * x2[j] + a3 * x3[j]
                e1[j] -= b0 * x0[j] + b1 * x1[j] + b2 * x2[j] + b3 * x3[j]
        i00, l10, i11 = factor.root[line, 0], factor.root[line, 1], factor.root[line, 2]
        for j in range(n_columns):
            w = e0[j] * i00
            e0[j] = w
            e1[j] = (e1[j] - l10 * w) * i11
        for i in range(0, N_STATE, 2):
            x0, x1 = x[i], x[i + 1]
            d = decay if i < 6 else 1.0
            a0, b0, a1, b1 = gain[i, 0], gain[i, 1], gain[i + 1, 0], gain[i + 1, 1]
            for j in range(n_columns):
                x0[j] = d * x0[j] + a0 * e0[j] + b0 * e1[j]
                x1[j] = d * x1[j] + a1 * e0[j] + b1 * e1[j]


@kernel
def whiten_residual(factor: Factor, residual: Floats) -> Floats:
    """W times residuals (L, 2); (L, 2)."""
    n = residual.shape[0]
    out = np.empty((n, 2))
    x = np.zeros(N_STATE)
    for line in range(n):
        e0, e1, decay = residual[line, 0], residual[line, 1], factor.decay[line]
        h0, h1, gain = factor.observe[line, 0], factor.observe[line, 1], factor.gain[line]
        for i in range(6):
            x[i] *= decay
        if factor.begins[line]:
            x[6:] = 0.0
        for i in range(N_STATE):
            e0 -= h0[i] * x[i]
            e1 -= h1[i] * x[i]
        w0 = e0 * factor.root[line, 0]
        w1 = (e1 - factor.root[line, 1] * w0) * factor.root[line, 2]
        out[line, 0], out[line, 1] = w0, w1
        for i in range(N_STATE):
            x[i] += gain[i, 0] * w0 + gain[i, 1] * w1
    return out


@kernel
def unwhiten(factor: Factor, whitened: Floats) -> Floats:
    """W^T times whitened residuals (L, 2): `C^-1 e` of what was whitened; (L, 2)."""
    n = whitened.shape[0]
    dual = np.empty((n, 2))
    adjoint = np.zeros(N_STATE)
    for line in range(n - 1, -1, -1):
        w0, w1 = whitened[line, 0], whitened[line, 1]
        for i in range(N_STATE):
            w0 += factor.gain[line, i, 0] * adjoint[i]
            w1 += factor.gain[line, i, 1] * adjoint[i]
        w1 *= factor.root[line, 2]
        w0 = (w0 - factor.root[line, 1] * w1) * factor.root[line, 0]
        dual[line, 0], dual[line, 1] = w0, w1
        for i in range(N_STATE):
            adjoint[i] -= factor.observe[line, 0, i] * w0 + factor.observe[line, 1, i] * w1
            if i < 6:
                adjoint[i] *= factor.decay[line]
            elif factor.begins[line]:
                adjoint[i] = 0.0
    return dual


@kernel
def unwhiten_columns(factor: Factor, columns: Floats) -> Floats:
    """W^T times whitened columns (2 L, n); (2 L, n)."""
    n = columns.shape[1]
    dual = np.empty(columns.shape)
    adjoint = np.zeros((N_STATE, n))
    for line in range(factor.decay.shape[0] - 1, -1, -1):
        d0, d1 = dual[2 * line], dual[2 * line + 1]
        w0, w1, gain = columns[2 * line], columns[2 * line + 1], factor.gain[line]
        for j in range(n):
            d0[j] = w0[j]
            d1[j] = w1[j]
        for i in range(0, N_STATE, 4):
            x0, x1, x2, x3 = adjoint[i], adjoint[i + 1], adjoint[i + 2], adjoint[i + 3]
            a0, a1, a2, a3 = gain[i, 0], gain[i + 1, 0], gain[i + 2, 0], gain[i + 3, 0]
            b0, b1, b2, b3 = gain[i, 1], gain[i + 1, 1], gain[i + 2, 1], gain[i + 3, 1]
            for j in range(n):
                d0[j] += a0 * x0[j] + a1 * x1[j] + a2 * x2[j] + a3 * x3[j]
                d1[j] += b0 * x0[j] + b1 * x1[j] + b2 * x2[j] + b3 * x3[j]
        i00, l10, i11 = factor.root[line, 0], factor.root[line, 1], factor.root[line, 2]
        for j in range(n):
            value = d1[j] * i11
            d1[j] = value
            d0[j] = (d0[j] - l10 * value) * i00
        decay, begins = factor.decay[line], factor.begins[line]
        for i in range(0, N_STATE, 2):
            x0, x1 = adjoint[i], adjoint[i + 1]
            a0, a1 = factor.observe[line, 0, i], factor.observe[line, 0, i + 1]
            b0, b1 = factor.observe[line, 1, i], factor.observe[line, 1, i + 1]
            if i >= 6 and begins:
                x0[:] = 0.0
                x1[:] = 0.0
                continue
            d = decay if i < 6 else 1.0
            for j in range(n):
                x0[j] = d * (x0[j] - a0 * d0[j] - b0 * d1[j])
                x1[j] = d * (x1[j] - a1 * d0[j] - b1 * d1[j])
    return dual
