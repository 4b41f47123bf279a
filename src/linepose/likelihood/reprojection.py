"""Eq. 18-21 compiled: the estimates reprojected into every observation, their errors and the errors' variances."""

from linepose.arrays import Floats
from linepose.compiling.kernels import kernel_part
from linepose.likelihood import layout as at
from linepose.likelihood.layout import LANES

# Squared error below which it has no direction of its own; the error's variance is then taken along the scan line.
NO_ERROR = 1e-100


@kernel_part
def reproject(
    survey: Floats, pose: Floats, axes: Floats, rays: Floats, points: Floats, residuals: Floats, scores: Floats
) -> None:
    """Write `residuals` (N, RESIDUAL_COLUMNS) and add to `scores` (2 * LANES): sum of e^2 / sigma^2, points behind.

    With v the gradient of the error by the point in camera axes, the body's displacement moves the error by -v and
    its small rotation by -(point x v), both in body axes.
    """
    r_x, r_y, r_z = pose[0], pose[1], pose[2]
    x_x, x_y, x_z = axes[0, 0], axes[1, 0], axes[2, 0]
    y_x, y_y, y_z = axes[0, 1], axes[1, 1], axes[2, 1]
    z_x, z_y, z_z = axes[0, 2], axes[1, 2], axes[2, 2]
    for i in range(survey.shape[0]):
        for lane in range(LANES):
            fn, fe, fd = rays[i, at.F_N + lane], rays[i, at.F_E + lane], rays[i, at.F_D + lane]
            gn, ge, gd = rays[i, at.G_N + lane], rays[i, at.G_E + lane], rays[i, at.G_D + lane]
            dn, de, dd = rays[i, at.D_N + lane], rays[i, at.D_E + lane], rays[i, at.D_D + lane]
            sine, cosine = survey[i, at.SINE + lane], survey[i, at.COSINE + lane]
            mask = survey[i, at.MASK + lane]
            pn = points[at.E_N + lane] - rays[i, at.C_N + lane]
            pe = points[at.E_E + lane] - rays[i, at.C_E + lane]
            pd = points[at.E_D + lane] - rays[i, at.C_D + lane]
            across1, across2 = fn * pn + fe * pe + fd * pd, gn * pn + ge * pe + gd * pd
            along = dn * pn + de * pe + dd * pd
            depth = cosine * along - sine * across1
            in_front = depth > 0.0
            inverse = 1 / depth
            error_x, error_y = across1 * inverse / cosine, across2 * inverse
            squared = error_x * error_x + error_y * error_y
            weight_x = error_x if squared > NO_ERROR else 1.0
            weight_y = error_y if squared > NO_ERROR else 0.0
            # Gradient of weight . error by the point, in camera axes, then along f and d, in the world, in the body.
            v_x, v_y = weight_x * inverse, weight_y * inverse
            plane_x, plane_y = (cosine * across1 + sine * along) * inverse, error_y
            v_z = -(v_x * plane_x + v_y * plane_y)
            v_f, v_d = cosine * v_x - sine * v_z, sine * v_x + cosine * v_z
            vn, ve, vd = fn * v_f + gn * v_y + dn * v_d, fe * v_f + ge * v_y + de * v_d, fd * v_f + gd * v_y + dd * v_d
            b_x = x_x * v_x + y_x * v_y + z_x * v_z
            b_y = x_y * v_x + y_y * v_y + z_y * v_z
            b_z = x_z * v_x + y_z * v_y + z_z * v_z
            across_x = plane_x * depth
            o_x = r_x + x_x * across_x + y_x * across2 + z_x * depth
            o_y = r_y + x_y * across_x + y_y * across2 + z_y * depth
            o_z = r_z + x_z * across_x + y_z * across2 + z_z * depth
            w_a, w_b, w_c = o_y * b_z - o_z * b_y, o_z * b_x - o_x * b_z, o_x * b_y - o_y * b_x
            from_point = (
                vn * (points[at.E_NN + lane] * vn + 2 * points[at.E_NE + lane] * ve + 2 * points[at.E_ND + lane] * vd)
                + ve * (points[at.E_EE + lane] * ve + 2 * points[at.E_ED + lane] * vd)
                + points[at.E_DD + lane] * vd * vd
            )
            from_position = (
                b_x * (survey[i, at.S_XX + lane] * b_x + 2 * survey[i, at.S_XY + lane] * b_y)
                + b_y * (survey[i, at.S_YY + lane] * b_y + 2 * survey[i, at.S_YZ + lane] * b_z)
                + b_z * (survey[i, at.S_ZZ + lane] * b_z + 2 * survey[i, at.S_XZ + lane] * b_x)
            )
            from_rotation = (
                w_a * (survey[i, at.S_AA + lane] * w_a + 2 * survey[i, at.S_AB + lane] * w_b)
                + w_b * (survey[i, at.S_BB + lane] * w_b + 2 * survey[i, at.S_BC + lane] * w_c)
                + w_c * (survey[i, at.S_CC + lane] * w_c + 2 * survey[i, at.S_AC + lane] * w_a)
            )
            from_both = (
                b_x
                * (survey[i, at.S_XA + lane] * w_a + survey[i, at.S_XB + lane] * w_b + survey[i, at.S_XC + lane] * w_c)
                + b_y
                * (survey[i, at.S_YA + lane] * w_a + survey[i, at.S_YB + lane] * w_b + survey[i, at.S_YC + lane] * w_c)
                + b_z
                * (survey[i, at.S_ZA + lane] * w_a + survey[i, at.S_ZB + lane] * w_b + survey[i, at.S_ZC + lane] * w_c)
            )
            from_pixel = (
                weight_x * weight_x * survey[i, at.PLANE_X + lane] + weight_y * weight_y * survey[i, at.PLANE_Y + lane]
            )
            variance = from_point + from_position + from_rotation + 2 * from_both + from_pixel
            residuals[i, at.ERROR_X + lane], residuals[i, at.ERROR_Y + lane] = error_x, error_y
            residuals[i, at.VARIANCE + lane] = variance / (squared if squared > NO_ERROR else 1.0)
            term = squared * squared / variance
            scores[lane] += term if mask > 0.0 else 0.0
            scores[LANES + lane] += 0.0 if in_front else mask
