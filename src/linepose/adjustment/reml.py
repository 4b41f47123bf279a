"""Levels by restricted maximum likelihood (REML), with their priors.

At one linearisation, the density of the levels given the data, points and camera integrated out, is

    -log p = 1/2 (min chi^2 + log|C| + log|N|) - log prior

C the covariance of the measurements under the error process, N the normal equations with priors. Both determinants
belong to it (Neyman and Scott: without them levels are too small), at the same linearisation as chi squared.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
from scipy.optimize import minimize

from linepose.adjustment.draws import Drawn, passes_at
from linepose.adjustment.gradient import slopes_of_density
from linepose.adjustment.levels import LevelPriors, Levels, levels_from_log, log_from_levels
from linepose.adjustment.measurements import Measurements
from linepose.adjustment.normal import Pass
from linepose.adjustment.process import Weights
from linepose.adjustment.solve import Model, pass_at
from linepose.arrays import Floats

LOG_RANGE: Final = (-12.0, 14.0)  # of a level's logarithm
NOTHING: Final = 1e10  # in place of infinity, where the density is zero
_TAKEN_BACK: Final = 0.7  # of a move, by the next one


@dataclass(frozen=True)
class Restricted:
    """The density of the levels at one linearisation.

    free (F,): indices of the levels that are estimated; fixed: logarithms (7,) of all, of which those are replaced.
    """

    measurements: Measurements
    model: Model
    weights: Weights
    priors: LevelPriors
    free: tuple[int, ...]
    fixed: Floats

    def log_levels(self, free_logs: Floats) -> Floats:
        """Logarithms (7,) of all levels from those that are free (F,)."""
        logs = self.fixed.copy()
        logs[list(self.free)] = free_logs
        return logs

    def done(self, free_logs: Floats) -> Pass:
        """The pass at these levels (F,)."""
        levels = levels_from_log(self.log_levels(free_logs))
        return pass_at(self.measurements, self.model, levels, self.weights)[1]

    def negative_log_density(self, free_logs: Floats) -> float:
        """The negative logarithm of the density of the logarithms of free levels (F,), but for a constant."""
        done = self.done(free_logs)
        return float(self._negative_log(np.array(done.chi_squared + done.log_determinant), free_logs))

    def drawn(self, free_logs: Floats, size: int) -> tuple[Floats, Drawn]:
        """The negative logarithm (D,) at draws of free levels' logarithms (D, F), and each pass's last columns."""
        model = self.model
        logs = np.repeat(self.fixed[None], len(free_logs), axis=0)
        logs[:, list(self.free)] = free_logs
        structure = self.measurements.structure
        found = passes_at(model.rows, structure, model.image, self.weights, model.prior, logs, size)
        return self._negative_log(found.deviance, free_logs), found

    def _negative_log(self, deviance: Floats, free_logs: Floats) -> Floats:
        """From chi squared and log-determinant together (...,), at free logarithms (..., F).

        A large number where the density is zero.
        """
        median, sigma = self._prior
        value = 0.5 * deviance + 0.5 * np.sum(((free_logs - median) / sigma) ** 2, axis=-1)
        return np.where(np.isfinite(value), value, NOTHING)

    @cached_property
    def _prior(self) -> tuple[Floats, Floats]:
        """Median and sigma (F,) of the free levels' logarithms."""
        free = list(self.free)
        return np.log(np.asarray(self.priors.median))[free], np.asarray(self.priors.log_sigma)[free]

    def value_and_gradient(self, free_logs: Floats) -> tuple[float, Floats]:
        """The negative logarithm of the density at logarithms (F,), and its gradient (F,)."""
        logs = self.log_levels(free_logs)
        levels = levels_from_log(logs)
        process, done = pass_at(self.measurements, self.model, levels, self.weights)
        value = float(self._negative_log(np.array(done.chi_squared + done.log_determinant), free_logs))
        if value >= NOTHING:
            return value, np.zeros(len(free_logs))
        slopes = slopes_of_density(self.measurements.structure, self.model.image, process, levels, self.weights, done)
        median, sigma = self._prior
        return value, 0.5 * slopes.by_level[list(self.free)] + (free_logs - median) / sigma**2

    def hessian(self, free_logs: Floats, step: float) -> Floats:
        """Hessian (F, F) of the negative logarithm by central differences of its gradient, symmetric."""
        rows = [
            (self.value_and_gradient(free_logs + move)[1] - self.value_and_gradient(free_logs - move)[1]) / (2 * step)
            for move in step * np.eye(len(free_logs))
        ]
        return (np.array(rows) + np.array(rows).T) / 2

    def start(self, levels: Levels) -> Floats:
        """Logarithms (F,) of the free levels among these."""
        return log_from_levels(levels)[list(self.free)]


def most_likely(restricted: Restricted, start: Floats, slope: float = 1e-3) -> tuple[Floats, int]:
    """The free levels' logarithms (F,) of largest density near a start (F,), and the number of evaluations.

    It ends where no derivative is larger than `slope`.
    """
    found = minimize(
        restricted.value_and_gradient,
        start,
        jac=True,
        method="L-BFGS-B",
        bounds=[LOG_RANGE] * len(start),
        options={"maxiter": 100, "ftol": 1e-10, "gtol": slope},
    )
    return np.asarray(found.x), int(found.nfev)


def shortened(share: float, move: Floats, last: Floats | None) -> float:
    """The share of a move (F,) of the levels' logarithms that is made, where the one before was `last` (F,).

    Halved where a move takes back most of the last: levels and the linearisation they lead to would go in a circle.
    """
    if last is None or move @ last > -_TAKEN_BACK * (last @ last):
        return share
    return share / 2
