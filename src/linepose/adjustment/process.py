"""The error process: how the body poses that were reported may be wrong, and what that adds to a measurement.

The correction of the body pose at measurement l of view v is

    c_l = F_l [ a z(t_l) + c q_v + b w_l ] + rho_l d_l

F_l is the symmetric root S R^1/2 of the reported covariance (S its sigmas, R its correlations) with attitude rows times
k; z are six independent unit Ornstein-Uhlenbeck processes of correlation time tau, which run on between views; q_v is
constant in a view, w_l white; rho_l is the body's motion in one line and d_l, of sigma s, how many lines late the
measurement is. Its image, with J the projection by the body pose, is `J c_l`, and to it come pixels: g sigma_u along
the line, and a small part across it that keeps matrices regular.

The state of the filter is (z, q): its transition is `exp(-dt / tau)` of z within and between views, one of q within a
view and nothing of it between two, its covariance the identity throughout.
"""

from typing import Final, NamedTuple

import numpy as np

from linepose.adjustment.levels import Levels
from linepose.adjustment.linearise import Linearised
from linepose.arrays import Floats
from linepose.compiling.kernels import kernel

ACROSS_FLOOR_PX: Final = 0.05


class ErrorStructure(NamedTuple):
    """What of the error process does not depend on levels nor on where the measurements are linearised.

    root (L, 6, 6): S R^1/2; motion (L, 6): the body's motion in one line (m, rad), zero where it is not known;
    late_px (L,): the sigma across the line (px) that one line of lateness has where the motion is not known, else zero;
    gap_s (L,): time since the measurement before, infinite for the first; begins (L,): whether a view begins;
    view_of (L,): row of the view; sigma_u_px: of the camera.
    """

    root: Floats
    motion: Floats
    late_px: Floats
    gap_s: Floats
    begins: np.ndarray
    view_of: np.ndarray
    sigma_u_px: float


class ErrorImage(NamedTuple):
    """The images (px) of unit errors: by_position, by_attitude (L, 2, 6) of J F, and of one line of lateness (L, 3).

    The last is its variance as (uu, uv, vv).
    """

    by_position: Floats
    by_attitude: Floats
    late: Floats


class Components(NamedTuple):
    """The error process at given levels, as the filter takes it.

    by_state (L, 2, 6): image of a unit of `a z + c q` is that of a unit of F; noise (L, 3): variance (uu, uv, vv) of
    what is independent; decay (L,): of z since the measurement before; drift: a; constant (N,): c of each view.
    """

    by_state: Floats
    noise: Floats
    decay: Floats
    drift: float
    constant: Floats


class Weights(NamedTuple):
    """Weights of the constant of each view (N,) and of the noise of each measurement (L,), one if none is wrong."""

    of_view: Floats
    of_measurement: Floats


@kernel
def error_image(structure: ErrorStructure, linearised: Linearised) -> ErrorImage:
    """The images of unit errors where the measurements are linearised."""
    n = linearised.by_body.shape[0]
    by_position, by_attitude, late = np.empty((n, 2, 6)), np.empty((n, 2, 6)), np.empty((n, 3))
    moved = np.empty(2)
    for line in range(n):
        root = structure.root[line]
        for row in range(2):
            j = linearised.by_body[line, row]
            moved[row] = 0.0
            for i in range(6):
                moved[row] += j[i] * structure.motion[line, i]
                by_position[line, row, i] = j[0] * root[0, i] + j[1] * root[1, i] + j[2] * root[2, i]
                by_attitude[line, row, i] = j[3] * root[3, i] + j[4] * root[4, i] + j[5] * root[5, i]
        late[line, 0] = moved[0] * moved[0]
        late[line, 1] = moved[0] * moved[1]
        late[line, 2] = moved[1] * moved[1] + structure.late_px[line] ** 2
    return ErrorImage(by_position, by_attitude, late)


@kernel
def components(structure: ErrorStructure, image: ErrorImage, levels: Levels, weights: Weights) -> Components:
    """The error process at these levels; a weight divides the variance of what it belongs to."""
    n = image.late.shape[0]
    by_state, noise, decay = np.empty((n, 2, 6)), np.empty((n, 3)), np.empty(n)
    white2, late2 = levels.white**2, levels.lateness**2
    along2 = (levels.pixel * structure.sigma_u_px) ** 2
    for line in range(n):
        decay[line] = np.exp(-structure.gap_s[line] / levels.correlation_time_s)
        uu, uv, vv = 0.0, 0.0, 0.0
        for i in range(6):
            u = image.by_position[line, 0, i] + levels.attitude * image.by_attitude[line, 0, i]
            v = image.by_position[line, 1, i] + levels.attitude * image.by_attitude[line, 1, i]
            by_state[line, 0, i], by_state[line, 1, i] = u, v
            uu += u * u
            uv += u * v
            vv += v * v
        inverse_weight = 1.0 / weights.of_measurement[line]
        noise[line, 0] = inverse_weight * (white2 * uu + late2 * image.late[line, 0] + along2)
        noise[line, 1] = inverse_weight * (white2 * uv + late2 * image.late[line, 1])
        noise[line, 2] = inverse_weight * (white2 * vv + late2 * image.late[line, 2] + ACROSS_FLOOR_PX**2)
    return Components(by_state, noise, decay, levels.drift, levels.constant / np.sqrt(weights.of_view))


@kernel
def corrections(
    structure: ErrorStructure,
    image_components: Components,
    linearised: Linearised,
    levels: Levels,
    weights: Weights,
    dual: Floats,
) -> tuple[Floats, Floats, Floats]:
    """Expected corrections of all body poses (L, 6), given `C^-1 (e - A dx)` (L, 2); with z (L, 6) and q (N, 6).

    Every latent is its prior covariance with the measurements times the dual: for z two first-order recursions.
    """
    n, n_views = dual.shape[0], weights.of_view.shape[0]
    score, z, q = np.empty((n, 6)), np.empty((n, 6)), np.zeros((n_views, 6))
    ahead = np.zeros(6)
    for line in range(n):
        for i in range(6):
            score[line, i] = (
                image_components.by_state[line, 0, i] * dual[line, 0]
                + image_components.by_state[line, 1, i] * dual[line, 1]
            )
            ahead[i] = ahead[i] * image_components.decay[line] + score[line, i]
            z[line, i] = ahead[i]
            q[structure.view_of[line], i] += image_components.constant[structure.view_of[line]] * score[line, i]
    behind = np.zeros(6)
    for line in range(n - 1, -1, -1):
        for i in range(6):
            z[line, i] = image_components.drift * (z[line, i] + behind[i])
            behind[i] = (behind[i] + score[line, i]) * image_components.decay[line]
    result = np.zeros((n, 6))
    white2, late2 = levels.white**2, levels.lateness**2
    for line in range(n):
        view, inverse_weight = structure.view_of[line], 1.0 / weights.of_measurement[line]
        moved = 0.0
        for i in range(6):
            by_body = linearised.by_body[line, 0, i] * dual[line, 0] + linearised.by_body[line, 1, i] * dual[line, 1]
            moved += by_body * structure.motion[line, i]
        for i in range(6):
            total = 0.0
            for j in range(6):
                latent = (
                    image_components.drift * z[line, j]
                    + image_components.constant[view] * q[view, j]
                    + white2 * inverse_weight * score[line, j]
                )
                total += structure.root[line, i, j] * latent
            if i >= 3:
                total *= levels.attitude
            result[line, i] = total + late2 * inverse_weight * moved * structure.motion[line, i]
    return result, z, q
