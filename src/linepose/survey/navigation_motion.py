"""How the body moved around each observation, as smooth functions of time: its pose a little earlier or later.

Between two solutions of a log there is motion and there is noise. A smoothing spline whose strength generalised cross
validation chooses tells them apart: it follows a smooth log exactly, and takes the mean path through a noisy one. A
point's pose is then carried along that path, so that it keeps the noise that it had and a small shift of its time
changes it smoothly.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline, make_smoothing_spline
from scipy.spatial.transform import Rotation

from linepose.arrays import Floats
from linepose.errors import EstimationError, InputError
from linepose.geometry.rotations import euler_from_matrix, matrix_from_euler
from linepose.survey.navigation_log import NavigationLog
from linepose.survey.observations import Survey

_AROUND: Final = 10  # solutions beyond the times that are asked for, on either side
_FEWEST: Final = 8  # solutions, below which there is no telling motion from noise
_MOST: Final = 400  # values of an observation that are smoothed: of 20 s twenty a second
_WEIGHTS: Final = (1e-4, 1e10)  # of the second derivative, for solutions a second apart
_TRIED: Final = 141


@dataclass(frozen=True)
class Motion:
    """One observation's path: position (m) and turn (rad) as splines of seconds since `start_us`.

    The body's rotation at a time is `reference @ exp(turn)`, with `reference` (3, 3).
    """

    start_us: int
    path: BSpline
    reference: Floats

    def carried(
        self, time_us: NDArray[np.int64], position_m: Floats, rotation: Floats, offset_s: float
    ) -> tuple[Floats, Floats]:
        """Positions (P, 3) and rotations (P, 3, 3) at times (P,), moved along the path to `offset_s` later."""
        seconds = (time_us - self.start_us) / 1e6
        before, after = self.path(seconds), self.path(seconds + offset_s)
        first, second = (Rotation.from_rotvec(at[:, 3:]).as_matrix() for at in (before, after))
        return position_m + (after[:, :3] - before[:, :3]), rotation @ np.swapaxes(first, -1, -2) @ second


def motion(log: NavigationLog, time_us: NDArray[np.int64], reach_s: float) -> Motion:
    """The path around an observation's points at times (P,), as far as `reach_s` before and after them.

    Raises InputError where the log does not reach that far, EstimationError where it has too few solutions there.
    """
    reach_us = round(reach_s * 1e6)
    first, last = int(time_us.min()) - reach_us, int(time_us.max()) + reach_us
    if first < log.time_us[0] or last > log.time_us[-1]:
        raise InputError(
            "navigation log",
            f"times from {log.time_us[0]} to {log.time_us[-1]} us",
            f"times from {first} to {last} us, as far as the clock may be off",
            "complete the log, or lower experiments.clock_offset.maximum_s",
        )
    begin = max(int(np.searchsorted(log.time_us, first)) - _AROUND, 0)
    end = min(int(np.searchsorted(log.time_us, last)) + _AROUND, len(log.time_us))
    if end - begin < _FEWEST:
        raise EstimationError(f"navigation log: {end - begin} solutions around {first} us, expected {_FEWEST} or more")
    start_us = int(log.time_us[begin])
    seconds = (log.time_us[begin:end] - start_us) / 1e6
    matrices = matrix_from_euler(log.euler_rad[begin:end])
    reference = matrices[len(matrices) // 2]
    turn = Rotation.from_matrix(reference.T @ matrices).as_rotvec()
    place = log.position_m[begin:end] - log.position_m[begin]
    return Motion(start_us, smooth_path(seconds, np.hstack([place, turn])), reference)


def smooth_path(seconds: Floats, values: Floats) -> BSpline:
    """A cubic spline of increasing times (K,) through or near values (K, D), each column smoothed as it is noisy.

    Of many values neighbours are averaged first, because the choice of the smoothing takes a matrix of all of them.
    """
    size = -(-len(seconds) // _MOST)
    block = np.arange(len(seconds)) // size
    count = np.bincount(block)
    times = np.bincount(block, seconds) / count
    means = np.stack([np.bincount(block, column) / count for column in values.T], axis=-1)
    weights = smoothing(times, means)
    splines = [make_smoothing_spline(times, mean, lam=weight) for mean, weight in zip(means.T, weights, strict=True)]
    return BSpline(splines[0].t, np.stack([spline.c for spline in splines], axis=-1), splines[0].k)


def smoothing(times: Floats, values: Floats) -> Floats:
    """The weight of the squared second derivative (D,) that generalised cross-validation gives values (K, D).

    The smoother of a natural cubic spline is `(I + lambda K)^-1`; with the eigenvalues of K each weight is tried at
    the cost of a sum, for all columns at once.
    """
    step = np.diff(times)
    second = np.zeros((len(times), len(times) - 2))
    inner = np.arange(len(times) - 2)
    second[inner, inner], second[inner + 2, inner] = 1 / step[:-1], 1 / step[1:]
    second[inner + 1, inner] = -1 / step[:-1] - 1 / step[1:]
    gram = np.diag((step[:-1] + step[1:]) / 3) + np.diag(step[1:-1] / 6, 1) + np.diag(step[1:-1] / 6, -1)
    roughness, vectors = np.linalg.eigh(second @ np.linalg.solve(gram, second.T))
    roughness = np.maximum(roughness, 0.0)
    energy = (vectors.T @ values) ** 2
    weights = np.geomspace(*_WEIGHTS, _TRIED) * step.mean() ** 3
    left = weights[:, None] * roughness / (1 + weights[:, None] * roughness)  # of each eigenvector after smoothing
    score = (left**2 @ energy) / np.sum(left, axis=1)[:, None] ** 2
    return weights[np.argmin(score, axis=0)]


def survey_motions(log: NavigationLog, survey: Survey, reach_s: float) -> tuple[Motion, ...]:
    """The path around each observation of a survey (N); raises InputError naming the one that the log does not hold."""
    motions = []
    for number, time_us, u_px in zip(survey.number, survey.time_us, survey.u_px, strict=True):
        try:
            motions.append(motion(log, time_us[np.isfinite(u_px)], reach_s))
        except InputError as error:
            raise InputError(
                f"observation {number}: {error.place}", error.found, error.expected, error.remedy
            ) from None
    return tuple(motions)


def survey_at(survey: Survey, motions: Sequence[Motion], offset_s: float) -> Survey:
    """The survey with each point's body pose of `offset_s` later than it has it; covariances stay.

    At no offset it is the survey as it was associated, whatever way that was.
    """
    position, euler = survey.position_m.copy(), survey.euler_rad.copy()
    for row, path in enumerate(motions):
        seen = np.isfinite(survey.u_px[row])
        rotation = matrix_from_euler(survey.euler_rad[row, seen])
        moved, turned = path.carried(survey.time_us[row, seen], survey.position_m[row, seen], rotation, offset_s)
        position[row, seen], euler[row, seen] = moved, euler_from_matrix(turned)
    return replace(survey, position_m=position, euler_rad=euler)
