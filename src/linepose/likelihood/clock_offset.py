"""Any noise model with one parameter more: how far the camera's clock is behind the navigation's.

The body pose of a point that the camera stamped `t` is the navigation's at `t + offset`: a positive offset means that
the camera's stamps are too early. Noise models know a survey with fixed body poses, so the log-likelihood is worked out
on a grid of offsets, of which each evaluation needs the four around it, and interpolated by a cubic between them: it is
a smooth function of the offset, because the body poses are.
"""

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.likelihood.base import Likelihood, Residuals
from linepose.survey.navigation_log import NavigationLog
from linepose.survey.navigation_motion import survey_at, survey_motions
from linepose.survey.observations import Survey

OFFSET_NAME: Final = "clock_offset_s"
STEPS: Final = 50  # of the grid, to the largest offset on either side
_AROUND: Final = np.array([-1, 0, 1, 2])
_MANY: Final = 64  # rows at one node
_SCATTER: Final = 0.05  # of the largest offset: where walkers start


class ClockOffsetLikelihood(Likelihood):
    """A noise model with the clock offset (s) as its last parameter, even within `maximum_s` on either side.

    `at` makes the noise model of the survey with body poses at an offset. Beyond the largest offset the log-likelihood
    is minus infinity.
    """

    def __init__(self, at: Callable[[float], Likelihood], maximum_s: float) -> None:
        if not maximum_s > 0:
            raise InputError("clock offset", f"largest offset {maximum_s} s", "a positive number", "correct it")
        self.maximum_s = maximum_s
        self._make = at
        self._step = maximum_s / STEPS
        self._node = lru_cache(maxsize=None)(lambda k: at(k * self._step))
        self.inner = self._node(0)
        self.survey = self.inner.survey
        self.camera = self.inner.camera

    @property
    def parameter_names(self) -> tuple[str, ...]:
        """Those of the noise model, and the offset."""
        return (*self.inner.parameter_names, OFFSET_NAME)

    def start(self, pose: ArrayLike) -> Floats:
        """That of the noise model, with clocks that agree."""
        return np.append(self.inner.start(pose), 0.0)

    def half_widths(self, translation_m: float, rotation_rad: float) -> Floats:
        """Those of the noise model, and the largest offset."""
        return np.append(self.inner.half_widths(translation_m, rotation_rad), self.maximum_s)

    def initial_walker_sigma(self, translation_m: float, rotation_rad: float) -> Floats:
        """That of the noise model, and a small part of the largest offset."""
        return np.append(self.inner.initial_walker_sigma(translation_m, rotation_rad), _SCATTER * self.maximum_s)

    def log_likelihoods(self, parameters: ArrayLike) -> Floats:
        """Log-likelihood of each row; (K, P + 1) to (K,)."""
        rows = np.array(parameters, dtype=float, ndmin=2)
        offset = rows[:, -1] / self._step
        inside = np.flatnonzero(np.abs(rows[:, -1]) <= self.maximum_s)
        below = np.floor(offset[inside])
        nodes = below[:, None].astype(int) + _AROUND
        values = np.empty(nodes.shape)
        for node in np.unique(nodes):
            row, column = np.nonzero(nodes == node)
            values[row, column] = _evaluated(self._node(int(node)), rows[inside[row], :-1])
        out = np.full(len(rows), -np.inf)
        out[inside] = _between(values, offset[inside] - below)
        return out

    def log_likelihood(self, parameters: ArrayLike) -> float:
        """Log-likelihood at one parameter vector (P + 1,)."""
        vector = np.asarray(parameters, dtype=float)
        offset = vector[-1] / self._step
        if not abs(vector[-1]) <= self.maximum_s:
            return -np.inf
        below = np.floor(offset)
        values = [self._node(int(below) + around).log_likelihood(vector[:-1]) for around in _AROUND.tolist()]
        return float(_between(np.array(values), offset - below))

    def residuals(self, parameters: ArrayLike) -> Residuals:
        """Residuals and estimated points with body poses at the offset that the parameters (P + 1,) hold."""
        vector = np.asarray(parameters, dtype=float)
        return self._make(float(vector[-1])).residuals(vector[:-1])

    def chi_square(self, parameters: ArrayLike) -> tuple[float, int]:
        """That of the noise model with body poses at the offset that the parameters (P + 1,) hold."""
        vector = np.asarray(parameters, dtype=float)
        return self._make(float(vector[-1])).chi_square(vector[:-1])

    def without_cheirality(self) -> "ClockOffsetLikelihood":
        """The noise model without cheirality with the offset."""
        return ClockOffsetLikelihood(lambda offset_s: self._make(offset_s).without_cheirality(), self.maximum_s)

    def select(self, numbers: Sequence[int]) -> "ClockOffsetLikelihood":
        """The same model of these observations only."""
        kept = tuple(numbers)
        return ClockOffsetLikelihood(lambda offset_s: self._make(offset_s).select(kept), self.maximum_s)


def _evaluated(likelihood: Likelihood, rows: Floats) -> Floats:
    """Log-likelihood of each row (K, P); few are not worth the start of threads."""
    if len(rows) >= _MANY:
        return likelihood.log_likelihoods(rows)
    return np.array([likelihood.log_likelihood(row) for row in rows])


def with_clock_offset(
    survey: Survey, log: NavigationLog, maximum_s: float, model: Callable[[Survey], Likelihood]
) -> ClockOffsetLikelihood:
    """A noise model of a survey with the clock offset, body poses carried along their paths in the raw log.

    Raises InputError where the log does not reach as far around an observation as the clocks may differ.
    """
    motions = survey_motions(log, survey, maximum_s * (1 + 2 / STEPS))  # the grid's last node lies beyond the largest
    return ClockOffsetLikelihood(lambda offset_s: model(survey_at(survey, motions, offset_s)), maximum_s)


def _between(values: Floats, share: ArrayLike) -> Floats:
    """Cubic through values (..., 4) at -1, 0, 1, 2, taken at shares (...) of the way from 0 to 1.

    Minus infinity where one of the values is.
    """
    t = np.asarray(share, dtype=float)
    weights = np.stack(
        [
            -t * (t - 1) * (t - 2) / 6,
            (t + 1) * (t - 1) * (t - 2) / 2,
            -(t + 1) * t * (t - 2) / 2,
            (t + 1) * t * (t - 1) / 6,
        ],
        axis=-1,
    )
    finite = np.all(np.isfinite(values), axis=-1)
    total = np.sum(np.where(finite[..., None], values, 0.0) * weights, axis=-1)
    return np.asarray(np.where(finite, total, -np.inf))
