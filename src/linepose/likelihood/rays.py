"""Eq. 11 compiled: the rays of one block of points at one camera pose.

The error of a ray matters only across it: two components of its centre and two of its direction, with one 4 x 4
covariance a ray. Axes x, y, z here are the body's, n, e, d the world's; columns are those of layout.py.
"""

import math

from linepose.arrays import Floats
from linepose.compiling.kernels import kernel_part
from linepose.likelihood import layout as at
from linepose.likelihood.layout import LANES

_SMALL_ANGLE_SQUARED = 1e-4  # below this the series is exact to double precision


@kernel_part
def camera_axes(pose: Floats, axes: Floats) -> None:
    """Write the camera's axes in the body, the columns of `axes` (3, 3), for the rotation vector pose[3:6]."""
    x, y, z = pose[3], pose[4], pose[5]
    squared = x * x + y * y + z * z
    if squared < _SMALL_ANGLE_SQUARED:
        first = 1 - squared * (1 / 6 - squared * (1 / 120 - squared / 5040))
        second = 1 / 2 - squared * (1 / 24 - squared * (1 / 720 - squared / 40320))
    else:
        angle = math.sqrt(squared)
        half = math.sin(angle / 2) / angle
        first = math.sin(angle) / angle
        second = 2 * half * half
    cosine = 1 - second * squared
    axes[0, 0] = cosine + second * x * x
    axes[1, 1] = cosine + second * y * y
    axes[2, 2] = cosine + second * z * z
    axes[1, 0] = second * x * y + first * z
    axes[0, 1] = second * x * y - first * z
    axes[0, 2] = second * x * z + first * y
    axes[2, 0] = second * x * z - first * y
    axes[2, 1] = second * y * z + first * x
    axes[1, 2] = second * y * z - first * x


@kernel_part
def trace_rays(survey: Floats, pose: Floats, axes: Floats, rays: Floats) -> None:
    """Write the frame, centre and moment of every ray; `survey` (N, SURVEY_COLUMNS), `rays` (N, RAY_COLUMNS)."""
    r_x, r_y, r_z = pose[0], pose[1], pose[2]
    x_x, x_y, x_z = axes[0, 0], axes[1, 0], axes[2, 0]
    y_x, y_y, y_z = axes[0, 1], axes[1, 1], axes[2, 1]
    z_x, z_y, z_z = axes[0, 2], axes[1, 2], axes[2, 2]
    for i in range(survey.shape[0]):
        for lane in range(LANES):
            nx, ny, nz = survey[i, at.R_NX + lane], survey[i, at.R_NY + lane], survey[i, at.R_NZ + lane]
            ex, ey, ez = survey[i, at.R_EX + lane], survey[i, at.R_EY + lane], survey[i, at.R_EZ + lane]
            dx, dy, dz = survey[i, at.R_DX + lane], survey[i, at.R_DY + lane], survey[i, at.R_DZ + lane]
            sine, cosine = survey[i, at.SINE + lane], survey[i, at.COSINE + lane]
            # The ray's axes in the body: d along it, f across it in the scan plane; g is the camera's y.
            d_x, d_y, d_z = cosine * z_x + sine * x_x, cosine * z_y + sine * x_y, cosine * z_z + sine * x_z
            f_x, f_y, f_z = cosine * x_x - sine * z_x, cosine * x_y - sine * z_y, cosine * x_z - sine * z_z
            d_n, d_e, d_d = (
                nx * d_x + ny * d_y + nz * d_z,
                ex * d_x + ey * d_y + ez * d_z,
                dx * d_x + dy * d_y + dz * d_z,
            )
            c_n = survey[i, at.P_N + lane] + nx * r_x + ny * r_y + nz * r_z
            c_e = survey[i, at.P_E + lane] + ex * r_x + ey * r_y + ez * r_z
            c_d = survey[i, at.P_D + lane] + dx * r_x + dy * r_y + dz * r_z
            rays[i, at.D_N + lane], rays[i, at.D_E + lane], rays[i, at.D_D + lane] = d_n, d_e, d_d
            rays[i, at.F_N + lane] = nx * f_x + ny * f_y + nz * f_z
            rays[i, at.F_E + lane] = ex * f_x + ey * f_y + ez * f_z
            rays[i, at.F_D + lane] = dx * f_x + dy * f_y + dz * f_z
            rays[i, at.G_N + lane] = nx * y_x + ny * y_y + nz * y_z
            rays[i, at.G_E + lane] = ex * y_x + ey * y_y + ez * y_z
            rays[i, at.G_D + lane] = dx * y_x + dy * y_y + dz * y_z
            rays[i, at.C_N + lane], rays[i, at.C_E + lane], rays[i, at.C_D + lane] = c_n, c_e, c_d
            rays[i, at.M_N + lane] = d_e * c_d - d_d * c_e
            rays[i, at.M_E + lane] = d_d * c_n - d_n * c_d
            rays[i, at.M_D + lane] = d_n * c_e - d_e * c_n
            rays[i, at.CENTRE_ALONG + lane] = d_n * c_n + d_e * c_e + d_d * c_d
            rays[i, at.H_1 + lane], rays[i, at.H_2 + lane] = survey[i, at.SHARE_1 + lane], survey[i, at.SHARE_2 + lane]
            rays[i, at.H_3 + lane], rays[i, at.H_4 + lane] = survey[i, at.SHARE_3 + lane], survey[i, at.SHARE_4 + lane]
            rays[i, at.RAY_MASK + lane] = survey[i, at.MASK + lane]


@kernel_part
def propagate_covariances(survey: Floats, pose: Floats, axes: Floats, rays: Floats) -> None:
    """Write the covariance across every ray: of its centre (1, 2) and its direction (3, 4) along f and g.

    With a small displacement p and a small rotation w of the body, the components are f.p + (r x f).w, g.p + (r x g).w,
    g.w and -f.w; the camera's own error turns the direction only.
    """
    r_x, r_y, r_z = pose[0], pose[1], pose[2]
    x_x, x_y, x_z = axes[0, 0], axes[1, 0], axes[2, 0]
    g_x, g_y, g_z = axes[0, 1], axes[1, 1], axes[2, 1]
    z_x, z_y, z_z = axes[0, 2], axes[1, 2], axes[2, 2]
    # b = r x g
    b_x, b_y, b_z = r_y * g_z - r_z * g_y, r_z * g_x - r_x * g_z, r_x * g_y - r_y * g_x
    for i in range(survey.shape[0]):
        for lane in range(LANES):
            sine, cosine = survey[i, at.SINE + lane], survey[i, at.COSINE + lane]
            f_x, f_y, f_z = cosine * x_x - sine * z_x, cosine * x_y - sine * z_y, cosine * x_z - sine * z_z
            # a = r x f
            a_x, a_y, a_z = r_y * f_z - r_z * f_y, r_z * f_x - r_x * f_z, r_x * f_y - r_y * f_x
            xx, xy, xz = survey[i, at.S_XX + lane], survey[i, at.S_XY + lane], survey[i, at.S_XZ + lane]
            yy, yz, zz = survey[i, at.S_YY + lane], survey[i, at.S_YZ + lane], survey[i, at.S_ZZ + lane]
            xa, xb, xc = survey[i, at.S_XA + lane], survey[i, at.S_XB + lane], survey[i, at.S_XC + lane]
            ya, yb, yc = survey[i, at.S_YA + lane], survey[i, at.S_YB + lane], survey[i, at.S_YC + lane]
            za, zb, zc = survey[i, at.S_ZA + lane], survey[i, at.S_ZB + lane], survey[i, at.S_ZC + lane]
            aa, ab, ac = survey[i, at.S_AA + lane], survey[i, at.S_AB + lane], survey[i, at.S_AC + lane]
            bb, bc, cc = survey[i, at.S_BB + lane], survey[i, at.S_BC + lane], survey[i, at.S_CC + lane]
            # Covariance of p and of w with g.w, then with f.w.
            pg_x, pg_y, pg_z = (
                xa * g_x + xb * g_y + xc * g_z,
                ya * g_x + yb * g_y + yc * g_z,
                za * g_x + zb * g_y + zc * g_z,
            )
            wg_x, wg_y, wg_z = (
                aa * g_x + ab * g_y + ac * g_z,
                ab * g_x + bb * g_y + bc * g_z,
                ac * g_x + bc * g_y + cc * g_z,
            )
            pf_x, pf_y, pf_z = (
                xa * f_x + xb * f_y + xc * f_z,
                ya * f_x + yb * f_y + yc * f_z,
                za * f_x + zb * f_y + zc * f_z,
            )
            wf_x, wf_y, wf_z = (
                aa * f_x + ab * f_y + ac * f_z,
                ab * f_x + bb * f_y + bc * f_z,
                ac * f_x + bc * f_y + cc * f_z,
            )
            # Covariance of p and of w with the centre's first component.
            pa_x = xx * f_x + xy * f_y + xz * f_z + xa * a_x + xb * a_y + xc * a_z
            pa_y = xy * f_x + yy * f_y + yz * f_z + ya * a_x + yb * a_y + yc * a_z
            pa_z = xz * f_x + yz * f_y + zz * f_z + za * a_x + zb * a_y + zc * a_z
            wa_x = xa * f_x + ya * f_y + za * f_z + aa * a_x + ab * a_y + ac * a_z
            wa_y = xb * f_x + yb * f_y + zb * f_z + ab * a_x + bb * a_y + bc * a_z
            wa_z = xc * f_x + yc * f_y + zc * f_z + ac * a_x + bc * a_y + cc * a_z
            # The position's part of the centre's second component, with the rotation's part once and twice.
            pp_x, pp_y, pp_z = (
                xx * g_x + xy * g_y + xz * g_z,
                xy * g_x + yy * g_y + yz * g_z,
                xz * g_x + yz * g_y + zz * g_z,
            )
            pb_x, pb_y, pb_z = (
                xa * b_x + xb * b_y + xc * b_z,
                ya * b_x + yb * b_y + yc * b_z,
                za * b_x + zb * b_y + zc * b_z,
            )
            wb_x, wb_y, wb_z = (
                aa * b_x + ab * b_y + ac * b_z,
                ab * b_x + bb * b_y + bc * b_z,
                ac * b_x + bc * b_y + cc * b_z,
            )
            rays[i, at.V_11 + lane] = f_x * pa_x + f_y * pa_y + f_z * pa_z + a_x * wa_x + a_y * wa_y + a_z * wa_z
            rays[i, at.V_12 + lane] = g_x * pa_x + g_y * pa_y + g_z * pa_z + b_x * wa_x + b_y * wa_y + b_z * wa_z
            rays[i, at.V_22 + lane] = (
                g_x * (pp_x + pb_x + pb_x)
                + g_y * (pp_y + pb_y + pb_y)
                + g_z * (pp_z + pb_z + pb_z)
                + b_x * wb_x
                + b_y * wb_y
                + b_z * wb_z
            )
            rays[i, at.V_13 + lane] = f_x * pg_x + f_y * pg_y + f_z * pg_z + a_x * wg_x + a_y * wg_y + a_z * wg_z
            rays[i, at.V_23 + lane] = g_x * pg_x + g_y * pg_y + g_z * pg_z + b_x * wg_x + b_y * wg_y + b_z * wg_z
            rays[i, at.V_14 + lane] = -(f_x * pf_x + f_y * pf_y + f_z * pf_z + a_x * wf_x + a_y * wf_y + a_z * wf_z)
            rays[i, at.V_24 + lane] = -(g_x * pf_x + g_y * pf_y + g_z * pf_z + b_x * wf_x + b_y * wf_y + b_z * wf_z)
            rays[i, at.V_33 + lane] = survey[i, at.SPREAD_ALONG + lane] + g_x * wg_x + g_y * wg_y + g_z * wg_z
            rays[i, at.V_34 + lane] = -(g_x * wf_x + g_y * wf_y + g_z * wf_z)
            rays[i, at.V_44 + lane] = survey[i, at.SPREAD_ACROSS + lane] + f_x * wf_x + f_y * wf_y + f_z * wf_z
