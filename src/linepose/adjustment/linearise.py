"""Every measurement linearised at the camera's pose, its point and the corrected body pose.

With b the point in the body's axes seen from the camera, `b = R_wb^T (P - p) - r`, and `q = R_bc^T b` in the camera's,
the point is seen at

    u = f s(x) + u0,   v = f (y - g(x)),   x = q_x / q_z,   y = q_y / q_z,   f in pixels

with s what the lens makes of x, and g where the line lies across a straight one (`geometry.lens`). The line observes u,
and v = 0 at the time of its exposure. The body pose is the reported one, moved along the body's rate by the clock
offset, plus a correction c, all six numbers added: position (m), Euler angles (rad). The linear model of a measurement
is

    e = y - h + J c0 = J_theta d_theta + J_P dP + J c + n

at the present correction c0, so that the corrections themselves, not steps of them, are what the error process knows.
theta: lever arm r (3, m), small rotation on the left of R_bc (3, rad), principal point u0 (px), focal length (m), those
coefficients of the lens that are sought, shift downwards of all points whose height is from one source (m), clock
offset (s).
"""

from typing import Final, NamedTuple

import numpy as np

from linepose.arrays import Floats
from linepose.compiling.kernels import kernel, kernel_part
from linepose.geometry.lens import ALONG, Lens

N_LEAST_THETA: Final = 10  # without coefficients of the lens
_OF_FOCAL: Final = 7
_N_ALONG: Final = len(ALONG)


class Optics(NamedTuple):
    """The camera on the body: lever_arm_m (3,), body_from_camera (3, 3), and its intrinsics.

    sought (C,): which of the lens's coefficients are estimated, by their place in `COEFFICIENTS`.
    """

    lever_arm_m: Floats
    body_from_camera: Floats
    principal_point_px: float
    focal_length_m: float
    pixel_pitch_m: float
    lens: Lens
    sought: np.ndarray


class Linearised(NamedTuple):
    """L measurements, rows u and v in pixels.

    residual_px (L, 2): y - h; by_theta (L, 2, 10 + C); by_point (L, 2, 3); by_body (L, 2, 6).
    """

    residual_px: Floats
    by_theta: Floats
    by_point: Floats
    by_body: Floats


def empty_linearised(n_measurements: int, n_sought: int = 0) -> Linearised:
    """Room for `linearise` with so many coefficients of the lens sought."""
    return Linearised(
        np.zeros((n_measurements, 2)),
        np.zeros((n_measurements, 2, N_LEAST_THETA + n_sought)),
        np.zeros((n_measurements, 2, 3)),
        np.zeros((n_measurements, 2, 6)),
    )


@kernel_part
def _through_table(x: float, lens: Lens, out: Floats) -> None:
    """Write s, ds/dx, y and dy/dx of the table at x into out (4,), as `geometry.lens` has it."""
    knots = lens.knot_x
    i = int(min(max(int(np.searchsorted(knots, x)) - 1, 0), len(knots) - 2))
    width = knots[i + 1] - knots[i]
    t = min(max((x - knots[i]) / width, 0.0), 1.0)
    beyond = x - (knots[i] + t * width)
    for row in range(2):
        values, slopes = (lens.knot_s, lens.slope_s) if row == 0 else (lens.knot_y, lens.slope_y)
        rise, first, second = values[i + 1] - values[i], width * slopes[i], width * slopes[i + 1]
        square, cube = 3.0 * rise - 2.0 * first - second, first + second - 2.0 * rise
        slope = (first + t * (2.0 * square + t * 3.0 * cube)) / width
        out[2 * row] = values[i] + t * (first + t * (square + t * cube)) + beyond * slope
        out[2 * row + 1] = slope


@kernel_part
def _by_coefficient(coefficient: int, x: float) -> float:
    """Derivative of s by k1, k2, k3 and p2, and of g by tilt and smile."""
    if coefficient == 0:
        return x**3
    if coefficient == 1:
        return x**5
    if coefficient == 2:
        return x**7
    if coefficient == 3:
        return 3.0 * x * x
    return x if coefficient == 4 else x * x


@kernel
def linearise(
    u_px: Floats,
    body_pose: Floats,
    rate: Floats,
    point_of: np.ndarray,
    points_m: Floats,
    shifts: Floats,
    optics: Optics,
    out: Linearised,
) -> int:
    """Fill `out` at body poses (L, 6), corrected, and points (K, 3) of which measurement l sees `point_of[l]`.

    rate (L, 6): of the body (m/s, rad/s), along which a clock offset moves it; zero where none is estimated. shifts
    (K,): share of the common shift that a point follows, one or none.

    Returns the number of measurements whose point is not in front of the camera; `out` is of use only if it is none.
    """
    behind = 0
    r = optics.lever_arm_m
    c = optics.body_from_camera
    f = optics.focal_length_m / optics.pixel_pitch_m
    lens, has_table, n_sought = optics.lens, len(optics.lens.knot_x) > 0, len(optics.sought)
    is_bent = has_table or lens.tilt != 0.0 or lens.smile != 0.0
    at_table = np.empty(4)
    for line in range(u_px.shape[0]):
        pose = body_pose[line]
        cr, sr = np.cos(pose[3]), np.sin(pose[3])
        cp, sp = np.cos(pose[4]), np.sin(pose[4])
        cy, sy = np.cos(pose[5]), np.sin(pose[5])
        w00, w01, w02 = cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr
        w10, w11, w12 = sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr
        w20, w21, w22 = -sp, cp * sr, cp * cr
        point = points_m[point_of[line]]
        d0, d1, d2 = point[0] - pose[0], point[1] - pose[1], point[2] - pose[2]
        b0 = w00 * d0 + w10 * d1 + w20 * d2 - r[0]
        b1 = w01 * d0 + w11 * d1 + w21 * d2 - r[1]
        b2 = w02 * d0 + w12 * d1 + w22 * d2 - r[2]
        depth = c[0, 2] * b0 + c[1, 2] * b1 + c[2, 2] * b2
        if not depth > 0.0:
            behind += 1
            continue
        x = (c[0, 0] * b0 + c[1, 0] * b1 + c[2, 0] * b2) / depth
        y = (c[0, 1] * b0 + c[1, 1] * b1 + c[2, 1] * b2) / depth
        x2 = x * x
        along = x * (1.0 + x2 * (lens.k1 + x2 * (lens.k2 + x2 * lens.k3)) + 3.0 * lens.p2 * x)
        along_slope = 1.0 + x2 * (3.0 * lens.k1 + x2 * (5.0 * lens.k2 + x2 * 7.0 * lens.k3)) + 6.0 * lens.p2 * x
        off, off_slope = y, 0.0
        if is_bent:
            off -= x * (lens.tilt + x * lens.smile)
            off_slope -= lens.tilt + 2.0 * x * lens.smile
            if has_table:
                _through_table(x, lens, at_table)
                along += at_table[0] - x
                along_slope += at_table[1] - 1.0
                off -= at_table[2]
                off_slope -= at_table[3]
        out.residual_px[line, 0] = u_px[line] - optics.principal_point_px - f * along
        out.residual_px[line, 1] = -f * off
        by_x = f * along_slope / depth
        by_y = f / depth
        for row in range(2):
            if row == 0:
                g0, g1, g2 = (
                    by_x * (c[0, 0] - x * c[0, 2]),
                    by_x * (c[1, 0] - x * c[1, 2]),
                    by_x * (c[2, 0] - x * c[2, 2]),
                )
            else:
                g0, g1, g2 = (
                    by_y * (c[0, 1] - y * c[0, 2]),
                    by_y * (c[1, 1] - y * c[1, 2]),
                    by_y * (c[2, 1] - y * c[2, 2]),
                )
                if is_bent:
                    bend = by_y * off_slope
                    g0 += bend * (c[0, 0] - x * c[0, 2])
                    g1 += bend * (c[1, 0] - x * c[1, 2])
                    g2 += bend * (c[2, 0] - x * c[2, 2])
            theta = out.by_theta[line, row]
            theta[0], theta[1], theta[2] = -g0, -g1, -g2
            theta[3], theta[4], theta[5] = g1 * b2 - g2 * b1, g2 * b0 - g0 * b2, g0 * b1 - g1 * b0
            theta[6] = 1.0 - row
            theta[_OF_FOCAL] = (along if row == 0 else off) / optics.pixel_pitch_m
            for k in range(n_sought):
                coefficient = optics.sought[k]
                moves_along = coefficient < _N_ALONG
                by = f * _by_coefficient(coefficient, x)
                theta[_OF_FOCAL + 1 + k] = (by if row == 0 else 0.0) if moves_along else (0.0 if row == 0 else -by)
            h0 = w00 * g0 + w01 * g1 + w02 * g2
            h1 = w10 * g0 + w11 * g1 + w12 * g2
            h2 = w20 * g0 + w21 * g1 + w22 * g2
            by_point = out.by_point[line, row]
            by_point[0], by_point[1], by_point[2] = h0, h1, h2
            t0, t1, t2 = h1 * d2 - h2 * d1, h2 * d0 - h0 * d2, h0 * d1 - h1 * d0
            body = out.by_body[line, row]
            body[0], body[1], body[2] = -h0, -h1, -h2
            body[3] = t0 * w00 + t1 * w10 + t2 * w20
            body[4] = t1 * cy - t0 * sy
            body[5] = t2
            moved = 0.0
            for i in range(6):
                moved += body[i] * rate[line, i]
            theta[_OF_FOCAL + 1 + n_sought] = h2 * shifts[point_of[line]]
            theta[_OF_FOCAL + 2 + n_sought] = moved
    return behind
