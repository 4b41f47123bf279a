"""How the kernel's arrays are laid out: points in blocks of lanes, one row of lanes a quantity.

A block holds `LANES` points. What belongs to one observation of a block is one line of a two-dimensional array,
in which the quantity `NAME` of lane `l` stands at column `NAME + l`, so that neighbouring points lie side by side
and the innermost loops over lanes become vector instructions.
"""

from typing import Final

LANES: Final = 16


def _offsets(count: int, start: int = 0) -> tuple[int, ...]:
    return tuple(LANES * (start + row) for row in range(count))


# What is known before any pose: the survey.
(R_NX, R_NY, R_NZ, R_EX, R_EY, R_EZ, R_DX, R_DY, R_DZ) = _offsets(9)  # body to world
(P_N, P_E, P_D) = _offsets(3, 9)  # body position, from the mean over the point's observations
# Covariance of the body's position (x, y, z) and small rotation (a, b, c), both in body axes.
(S_XX, S_XY, S_XZ, S_YY, S_YZ, S_ZZ) = _offsets(6, 12)
(S_XA, S_XB, S_XC, S_YA, S_YB, S_YC, S_ZA, S_ZB, S_ZC) = _offsets(9, 18)
(S_AA, S_AB, S_AC, S_BB, S_BC, S_CC) = _offsets(6, 27)
(SINE, COSINE) = _offsets(2, 33)  # of the ray's angle from the optical axis, within the scan plane
(SPREAD_ALONG, SPREAD_ACROSS) = _offsets(2, 35)  # variance of the ray's angle from the camera, rad^2
(SHARE_1, SHARE_2, SHARE_3, SHARE_4) = _offsets(4, 37)  # the ray's angle by one sigma of u0, f, k1, k2, rad
(PLANE_X, PLANE_Y) = _offsets(2, 41)  # variance of the observed point in the normalised plane
MASK: Final = LANES * 43  # 1 where the point was observed, and by another observation too; else 0
SURVEY_COLUMNS: Final = LANES * 44

# A ray at one camera pose, in the world: frame (first, second, direction) and centre.
(D_N, D_E, D_D) = _offsets(3)
(F_N, F_E, F_D) = _offsets(3, 3)  # first axis across the ray: within the scan plane
(G_N, G_E, G_D) = _offsets(3, 6)  # second axis across the ray: out of the scan plane
(C_N, C_E, C_D) = _offsets(3, 9)
(M_N, M_E, M_D) = _offsets(3, 12)  # direction x centre
CENTRE_ALONG: Final = LANES * 15  # direction . centre
# Covariance of the ray's centre (1, 2) and direction (3, 4) along the two axes across it.
(V_11, V_12, V_22, V_13, V_14, V_23, V_24, V_33, V_34, V_44) = _offsets(10, 16)
(H_1, H_2, H_3, H_4) = _offsets(4, 26)  # the direction's share of the intrinsics' sigmas, along the first axis
RAY_MASK: Final = LANES * 30
RAY_COLUMNS: Final = LANES * 31

# Sums over the pairs that end on a ray, in the ray's frame: information, and information times distance along it.
(W_11, W_12, W_22, W_13, W_23, W_33) = _offsets(6)
(B_1, B_2, B_3) = _offsets(3, 6)
SUM_COLUMNS: Final = LANES * 9

# Estimated points: position and covariance in the world.
(E_N, E_E, E_D) = _offsets(3)
(E_NN, E_NE, E_ND, E_EE, E_ED, E_DD) = _offsets(6, 3)
POINT_COLUMNS: Final = LANES * 9

# Residuals in the normalised plane: reprojected minus observed, and the variance along that direction.
(ERROR_X, ERROR_Y, VARIANCE) = _offsets(3)
RESIDUAL_COLUMNS: Final = LANES * 3
