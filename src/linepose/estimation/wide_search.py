"""A search that finds the optimum from far away: rotations first, then least squares, then Powell's method.

What goes wrong far from the optimum is the rotation: with it wrong, points fall behind the camera and errors say
little. So many rotations around the start are tried at once (and places, where rotations alone lead nowhere), the most
likely ones are refined by least squares on the whitened residuals, which takes some ten steps where Powell's method
takes thousands of evaluations, and the best of these is left to Powell's method.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import least_squares

from linepose.arrays import Floats
from linepose.errors import EstimationError
from linepose.estimation.optimise import Optimum, Search, optimise
from linepose.geometry.pose import N_PARAMETERS, check_pose
from linepose.geometry.rotations import matrix_from_rotation_vector, rotation_vector_from_matrix
from linepose.likelihood.base import Likelihood

_OUT_OF_REACH: Final = 1e3  # whitened residual, in sigmas, of what has none
_SCALE: Final = np.repeat([1.0, 0.5], 3)  # m and rad that move a pixel about equally far, for a view from 2 m
_ROUNDING_ROOM: Final = 1e-6  # by which the least squares' range exceeds the search's, so that its start lies inside


@dataclass(frozen=True)
class WideSearch:
    """How widely is searched: candidates (a power of two) and their angle around the start, and how many are refined.

    `most_tried` candidates are given up before as many as `n_refined` ended in front of the camera.
    """

    n_candidates: int = 256
    maximum_angle_rad: float = float(np.radians(75.0))
    n_refined: int = 2
    most_tried: int = 8
    maximum_steps: int = 60
    tolerance: float = 1e-6


def search_widely(
    likelihood: Likelihood, start: ArrayLike, search: Search | None = None, wide: WideSearch | None = None
) -> Optimum:
    """The optimum from a start pose (6,), from farther away than Powell's method alone finds it.

    Noise parameters beyond the pose stay at the model's start until Powell's method. Raises InputError for a start
    that is not finite.
    """
    search, wide = search or Search(), wide or WideSearch()
    first = likelihood.start(check_pose(start, "start pose"))
    best, n_spent = first, 0
    for reach_m in (0.0, search.half_width_m):
        candidates = moved_and_turned(first, wide.n_candidates, reach_m, wide.maximum_angle_rad)
        refined, spent = _refined_candidates(likelihood, candidates, search, wide)
        n_spent += spent
        if refined:
            best = max(refined, key=likelihood.log_likelihood)
            break
    found = optimise(likelihood, best[:N_PARAMETERS], search)
    return Optimum(found.parameters, found.neg_log_likelihood, found.n_evaluations + n_spent, found.converged)


def _refined_candidates(
    likelihood: Likelihood, candidates: Floats, search: Search, wide: WideSearch
) -> tuple[list[Floats], int]:
    """The likeliest of candidates (K, P), refined, but for those that end where a point lies behind the camera."""
    log_likelihoods = likelihood.log_likelihoods(candidates)
    possible = int(np.isfinite(log_likelihoods).sum())
    refined, n_spent = [], len(candidates)
    for index in np.argsort(-log_likelihoods, kind="stable")[: min(possible, wide.most_tried)]:
        end, spent = refine(likelihood, candidates[index], candidates[0], search, wide)
        n_spent += spent + 1
        if np.isfinite(likelihood.log_likelihood(end)):
            refined.append(end)
        if len(refined) == wide.n_refined:
            break
    return refined, n_spent


def moved_and_turned(parameters: Floats, count: int, reach_m: float, maximum_angle_rad: float) -> Floats:
    """Parameters (count, P): the given ones (P,) first, then with the pose moved and turned about every axis.

    Moves and turns fill the balls of these radii evenly (a Sobol sequence), and are the same ones in every call.
    """
    from scipy.stats import qmc  # slow to import

    cube = qmc.Sobol(6, scramble=False).random(count)  # its first element is 0: no move, no turn
    around = np.tile(parameters, (count, 1))
    around[:, :3] += reach_m * _ball(cube[:, 3:])
    turns = matrix_from_rotation_vector(maximum_angle_rad * _ball(cube[:, :3]))
    rotation = matrix_from_rotation_vector(parameters[3:N_PARAMETERS])
    around[:, 3:N_PARAMETERS] = rotation_vector_from_matrix(turns @ rotation)
    return around


def refine(
    likelihood: Likelihood, parameters: Floats, centre: Floats, search: Search, wide: WideSearch
) -> tuple[Floats, int]:
    """Parameters (P,) whose pose has the least squared whitened residuals near the given ones, and evaluations spent.

    The pose stays within the search's range around `centre` (P,); other parameters are kept.
    """
    n_spent = 0

    def whitened(pose: Floats) -> Floats:
        nonlocal n_spent
        n_spent += 1
        return whitened_residuals(likelihood, np.concatenate([pose, parameters[N_PARAMETERS:]]))

    room = likelihood.half_widths(search.half_width_m, search.half_width_rad)[:N_PARAMETERS] + _ROUNDING_ROOM
    middle = centre[:N_PARAMETERS]
    found = least_squares(
        whitened,
        np.clip(parameters[:N_PARAMETERS], middle - room, middle + room),
        bounds=(middle - room, middle + room),
        x_scale=_SCALE,
        max_nfev=wide.maximum_steps,
        ftol=wide.tolerance,
        xtol=wide.tolerance,
    )
    return np.concatenate([found.x, parameters[N_PARAMETERS:]]), n_spent


def _ball(cube: Floats) -> Floats:
    """Points of the unit ball from points of the unit cube, uniform from uniform, 0 from 0; (K, 3) to (K, 3)."""
    height, azimuth = 2 * cube[:, 0] - 1, 2 * np.pi * cube[:, 1]
    across = np.sqrt(1 - height**2)
    direction = np.stack([across * np.cos(azimuth), across * np.sin(azimuth), height], axis=1)
    return np.cbrt(cube[:, 2:]) * direction


def whitened_residuals(likelihood: Likelihood, parameters: ArrayLike) -> Floats:
    """Reprojection errors along and across the line over their sigmas, at parameters (P,); (2 N M,).

    Their squares add up to `-2 log L`. What was not observed is 0; what has no residual is far out.
    """
    observed = np.isfinite(likelihood.survey.u_px)[..., None]
    try:
        residuals = likelihood.residuals(parameters)
    except EstimationError:
        return np.where(observed, _OUT_OF_REACH, 0.0).repeat(2, axis=-1).ravel()
    whitened = residuals.error_uv_px / residuals.sigma_px[..., None]
    whitened = np.where(np.isfinite(whitened), whitened, _OUT_OF_REACH)
    return np.where(observed, whitened, 0.0).ravel()
