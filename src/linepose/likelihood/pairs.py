"""Eq. 12-16 compiled: for every pair of rays, the point on each that is nearest to the other, and its weight.

In the frame of the ray it lies on, the nearest point moves across that ray by `a = centre + t direction` and along it
by `(h.a + w) / D`, where w does not depend on a. The inverse of its covariance follows from that of a (2 x 2) and from
the variance of w that a does not explain, so no 3 x 3 matrix is inverted. Both ends of a pair share their geometry.
"""

from linepose.arrays import Floats
from linepose.compiling.kernels import kernel_part
from linepose.likelihood import layout as at
from linepose.likelihood.layout import LANES

# Sine squared of the angle between rays at which they count as parallel: the nearest point has no digit left there.
PARALLEL_SINE_SQUARED = 1e-16


@kernel_part
def intersect(rays: Floats, rays_again: Floats, sums: Floats, sums_again: Floats) -> None:
    """Write what all pairs say of the point, into `sums` (N, SUM_COLUMNS), from `rays` (N, RAY_COLUMNS).

    Give either array twice: a loop that names rows i and j of one array needs more alias checks than LLVM makes,
    and stays scalar. Suffix 1 is the ray i, 2 the ray j; n is d_i x d_j up to sign, in the axes across each ray.
    """
    for i in range(rays.shape[0]):
        for column in range(at.SUM_COLUMNS):
            sums[i, column] = 0.0
    for i in range(rays.shape[0]):
        for j in range(i):
            for lane in range(LANES):
                dn1, de1, dd1 = rays[i, at.D_N + lane], rays[i, at.D_E + lane], rays[i, at.D_D + lane]
                dn2, de2, dd2 = rays_again[j, at.D_N + lane], rays_again[j, at.D_E + lane], rays_again[j, at.D_D + lane]
                p1 = dn2 * rays[i, at.G_N + lane] + de2 * rays[i, at.G_E + lane] + dd2 * rays[i, at.G_D + lane]
                q1 = -(dn2 * rays[i, at.F_N + lane] + de2 * rays[i, at.F_E + lane] + dd2 * rays[i, at.F_D + lane])
                p2 = (
                    dn1 * rays_again[j, at.G_N + lane]
                    + de1 * rays_again[j, at.G_E + lane]
                    + dd1 * rays_again[j, at.G_D + lane]
                )
                q2 = -(
                    dn1 * rays_again[j, at.F_N + lane]
                    + de1 * rays_again[j, at.F_E + lane]
                    + dd1 * rays_again[j, at.F_D + lane]
                )
                cosine = dn1 * dn2 + de1 * de2 + dd1 * dd2
                pp1, pq1, qq1 = p1 * p1, 2 * p1 * q1, q1 * q1
                pp2, pq2, qq2 = p2 * p2, 2 * p2 * q2, q2 * q2
                # Distances t along each ray to its point nearest the other; gap times |n| is what parts the two points.
                along1 = (
                    dn1 * rays_again[j, at.C_N + lane]
                    + de1 * rays_again[j, at.C_E + lane]
                    + dd1 * rays_again[j, at.C_D + lane]
                    - rays[i, at.CENTRE_ALONG + lane]
                )
                along2 = (
                    dn2 * rays[i, at.C_N + lane]
                    + de2 * rays[i, at.C_E + lane]
                    + dd2 * rays[i, at.C_D + lane]
                    - rays_again[j, at.CENTRE_ALONG + lane]
                )
                moment = (
                    dn1 * rays_again[j, at.M_N + lane]
                    + de1 * rays_again[j, at.M_E + lane]
                    + dd1 * rays_again[j, at.M_D + lane]
                    + dn2 * rays[i, at.M_N + lane]
                    + de2 * rays[i, at.M_E + lane]
                    + dd2 * rays[i, at.M_D + lane]
                )
                sine_squared = pp1 + qq1
                mask = rays[i, at.RAY_MASK + lane] * rays_again[j, at.RAY_MASK + lane]
                mask = mask if sine_squared > PARALLEL_SINE_SQUARED else 0.0
                sine_squared = sine_squared if sine_squared > PARALLEL_SINE_SQUARED else 1.0
                inverse = 1 / sine_squared
                t1 = (along1 + cosine * along2) * inverse
                t2 = (along2 + cosine * along1) * inverse
                gap = moment * inverse
                lean = gap * cosine
                # Ray i: covariance of a with the direction (c), of a (v), of a with u = n.direction; variances.
                v33, v34, v44 = rays[i, at.V_33 + lane], rays[i, at.V_34 + lane], rays[i, at.V_44 + lane]
                v13, v14 = rays[i, at.V_13 + lane], rays[i, at.V_14 + lane]
                v23, v24 = rays[i, at.V_23 + lane], rays[i, at.V_24 + lane]
                c13, c14, c23, c24 = v13 + t1 * v33, v14 + t1 * v34, v23 + t1 * v34, v24 + t1 * v44
                v11_1 = rays[i, at.V_11 + lane] + t1 * (v13 + c13)
                v12_1 = rays[i, at.V_12 + lane] + t1 * (v14 + c23)
                v22_1 = rays[i, at.V_22 + lane] + t1 * (v24 + c24)
                u1_1, u2_1 = c13 * p1 + c14 * q1, c23 * p1 + c24 * q1
                turn1 = v33 * pp1 + v34 * pq1 + v44 * qq1
                other1 = v11_1 * qq1 - v12_1 * pq1 + v22_1 * pp1 + lean * (lean * turn1 - 2 * (p1 * u2_1 - q1 * u1_1))
                # Ray j likewise.
                v33, v34, v44 = (
                    rays_again[j, at.V_33 + lane],
                    rays_again[j, at.V_34 + lane],
                    rays_again[j, at.V_44 + lane],
                )
                v13, v14 = rays_again[j, at.V_13 + lane], rays_again[j, at.V_14 + lane]
                v23, v24 = rays_again[j, at.V_23 + lane], rays_again[j, at.V_24 + lane]
                c13, c14, c23, c24 = v13 + t2 * v33, v14 + t2 * v34, v23 + t2 * v34, v24 + t2 * v44
                v11_2 = rays_again[j, at.V_11 + lane] + t2 * (v13 + c13)
                v12_2 = rays_again[j, at.V_12 + lane] + t2 * (v14 + c23)
                v22_2 = rays_again[j, at.V_22 + lane] + t2 * (v24 + c24)
                u1_2, u2_2 = c13 * p2 + c14 * q2, c23 * p2 + c24 * q2
                turn2 = v33 * pp2 + v34 * pq2 + v44 * qq2
                other2 = v11_2 * qq2 - v12_2 * pq2 + v22_2 * pp2 + lean * (lean * turn2 - 2 * (p2 * u2_2 - q2 * u1_2))
                # What the shared intrinsics add: they turn both directions at once, each along its first axis.
                shared = (
                    rays[i, at.H_1 + lane] * rays_again[j, at.H_1 + lane]
                    + rays[i, at.H_2 + lane] * rays_again[j, at.H_2 + lane]
                    + rays[i, at.H_3 + lane] * rays_again[j, at.H_3 + lane]
                    + rays[i, at.H_4 + lane] * rays_again[j, at.H_4 + lane]
                )
                push1 = -shared * (t1 * q1 + lean * p1)
                push2 = -shared * (t2 * q2 + lean * p2)
                # The point on ray i: covariance k of a with w, variance of w, then both in terms of the inverse of v.
                k1, k2 = t1 * push2 - gap * u1_1, -gap * u2_1
                y1, y2 = v22_1 * k1 - v12_1 * k2, v11_1 * k2 - v12_1 * k1
                det1 = v11_1 * v22_1 - v12_1 * v12_1
                rest1 = det1 * (other2 + gap * (gap * turn1 - 2 * p1 * push2)) - (k1 * y1 + k2 * y2)
                level = det1 * cosine
                f1_1, f2_1 = y1 - level * q1, y2 + level * p1
                # The point on ray j.
                k1, k2 = t2 * push1 - gap * u1_2, -gap * u2_2
                y1, y2 = v22_2 * k1 - v12_2 * k2, v11_2 * k2 - v12_2 * k1
                det2 = v11_2 * v22_2 - v12_2 * v12_2
                rest2 = det2 * (other1 + gap * (gap * turn2 - 2 * p2 * push1)) - (k1 * y1 + k2 * y2)
                level = det2 * cosine
                f1_2, f2_2 = y1 - level * q2, y2 + level * p2
                # Weights, accumulated.
                whole1, whole2 = det1 * rest1, det2 * rest2
                both = mask / (whole1 * whole2)
                scale1, scale2 = both * whole2, both * whole1
                w33 = scale1 * det1 * sine_squared
                w13, w23, w33 = -w33 * f1_1, -w33 * f2_1, w33 * (det1 * sine_squared)
                sums[i, at.W_11 + lane] += scale1 * (v22_1 * rest1 + f1_1 * f1_1)
                sums[i, at.W_12 + lane] += scale1 * (f1_1 * f2_1 - v12_1 * rest1)
                sums[i, at.W_22 + lane] += scale1 * (v11_1 * rest1 + f2_1 * f2_1)
                sums[i, at.W_13 + lane] += w13
                sums[i, at.W_23 + lane] += w23
                sums[i, at.W_33 + lane] += w33
                sums[i, at.B_1 + lane] += t1 * w13
                sums[i, at.B_2 + lane] += t1 * w23
                sums[i, at.B_3 + lane] += t1 * w33
                w33 = scale2 * det2 * sine_squared
                w13, w23, w33 = -w33 * f1_2, -w33 * f2_2, w33 * (det2 * sine_squared)
                sums_again[j, at.W_11 + lane] += scale2 * (v22_2 * rest2 + f1_2 * f1_2)
                sums_again[j, at.W_12 + lane] += scale2 * (f1_2 * f2_2 - v12_2 * rest2)
                sums_again[j, at.W_22 + lane] += scale2 * (v11_2 * rest2 + f2_2 * f2_2)
                sums_again[j, at.W_13 + lane] += w13
                sums_again[j, at.W_23 + lane] += w23
                sums_again[j, at.W_33 + lane] += w33
                sums_again[j, at.B_1 + lane] += t2 * w13
                sums_again[j, at.B_2 + lane] += t2 * w23
                sums_again[j, at.B_3 + lane] += t2 * w33
