"""Eq. 17 compiled: the mean of all nearest points to each pattern point, weighted by their inverse covariances."""

from linepose.arrays import Floats
from linepose.compiling.kernels import kernel_part
from linepose.likelihood import layout as at
from linepose.likelihood.layout import LANES


@kernel_part
def accumulate_pairs(rays: Floats, sums: Floats, points: Floats) -> None:
    """Turn each ray's `sums` (N, SUM_COLUMNS) into the world and add them up, in `points` (POINT_COLUMNS,).

    The estimate's columns hold information times position, the covariance's information.
    """
    for column in range(at.POINT_COLUMNS):
        points[column] = 0.0
    for i in range(rays.shape[0]):
        for lane in range(LANES):
            fn, fe, fd = rays[i, at.F_N + lane], rays[i, at.F_E + lane], rays[i, at.F_D + lane]
            gn, ge, gd = rays[i, at.G_N + lane], rays[i, at.G_E + lane], rays[i, at.G_D + lane]
            dn, de, dd = rays[i, at.D_N + lane], rays[i, at.D_E + lane], rays[i, at.D_D + lane]
            cn, ce, cd = rays[i, at.C_N + lane], rays[i, at.C_E + lane], rays[i, at.C_D + lane]
            w11, w12, w13 = sums[i, at.W_11 + lane], sums[i, at.W_12 + lane], sums[i, at.W_13 + lane]
            w22, w23, w33 = sums[i, at.W_22 + lane], sums[i, at.W_23 + lane], sums[i, at.W_33 + lane]
            b1, b2, b3 = sums[i, at.B_1 + lane], sums[i, at.B_2 + lane], sums[i, at.B_3 + lane]
            # Rows 1 to 3 of the information, turned on the right.
            n1, e1, d1 = w11 * fn + w12 * gn + w13 * dn, w11 * fe + w12 * ge + w13 * de, w11 * fd + w12 * gd + w13 * dd
            n2, e2, d2 = w12 * fn + w22 * gn + w23 * dn, w12 * fe + w22 * ge + w23 * de, w12 * fd + w22 * gd + w23 * dd
            n3, e3, d3 = w13 * fn + w23 * gn + w33 * dn, w13 * fe + w23 * ge + w33 * de, w13 * fd + w23 * gd + w33 * dd
            nn, ne, nd = fn * n1 + gn * n2 + dn * n3, fn * e1 + gn * e2 + dn * e3, fn * d1 + gn * d2 + dn * d3
            ee, ed, dd_ = fe * e1 + ge * e2 + de * e3, fe * d1 + ge * d2 + de * d3, fd * d1 + gd * d2 + dd * d3
            points[at.E_NN + lane] += nn
            points[at.E_NE + lane] += ne
            points[at.E_ND + lane] += nd
            points[at.E_EE + lane] += ee
            points[at.E_ED + lane] += ed
            points[at.E_DD + lane] += dd_
            points[at.E_N + lane] += fn * b1 + gn * b2 + dn * b3 + nn * cn + ne * ce + nd * cd
            points[at.E_E + lane] += fe * b1 + ge * b2 + de * b3 + ne * cn + ee * ce + ed * cd
            points[at.E_D + lane] += fd * b1 + gd * b2 + dd * b3 + nd * cn + ed * ce + dd_ * cd


@kernel_part
def solve_points(points: Floats) -> None:
    """Turn information into covariance and information times position into position, in place (POINT_COLUMNS,).

    NaN where no pair says anything.
    """
    for lane in range(LANES):
        nn, ne, nd = points[at.E_NN + lane], points[at.E_NE + lane], points[at.E_ND + lane]
        ee, ed, dd = points[at.E_EE + lane], points[at.E_ED + lane], points[at.E_DD + lane]
        n, e, d = points[at.E_N + lane], points[at.E_E + lane], points[at.E_D + lane]
        a_nn, a_ne, a_nd = ee * dd - ed * ed, nd * ed - ne * dd, ne * ed - nd * ee
        a_ee, a_ed, a_dd = nn * dd - nd * nd, ne * nd - nn * ed, nn * ee - ne * ne
        inverse = 1 / (nn * a_nn + ne * a_ne + nd * a_nd)
        a_nn, a_ne, a_nd = a_nn * inverse, a_ne * inverse, a_nd * inverse
        a_ee, a_ed, a_dd = a_ee * inverse, a_ed * inverse, a_dd * inverse
        points[at.E_NN + lane], points[at.E_NE + lane], points[at.E_ND + lane] = a_nn, a_ne, a_nd
        points[at.E_EE + lane], points[at.E_ED + lane], points[at.E_DD + lane] = a_ee, a_ed, a_dd
        points[at.E_N + lane] = a_nn * n + a_ne * e + a_nd * d
        points[at.E_E + lane] = a_ne * n + a_ee * e + a_ed * d
        points[at.E_D + lane] = a_nd * n + a_ed * e + a_dd * d
