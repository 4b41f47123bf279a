"""Estimates by the adjustment."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike

from linepose.adjustment.adjust import adjust
from linepose.adjustment.known_points import KnownPoints
from linepose.adjustment.result import Adjustment
from linepose.adjustment.settings import AdjustmentSettings
from linepose.errors import EstimationError, InputError
from linepose.estimation.estimator import Conditions, Estimate, Estimator
from linepose.geometry.camera import Camera
from linepose.survey.hand_measured import HandMeasured
from linepose.survey.observations import Survey

GAUSS_NEWTON = "gauss_newton"
_FEWER_DRAWS = 60  # of the levels, where many estimates are made
_FEWEST = 10
_FEW = {"n_draws": _FEWEST, "n_samples": _FEWEST}  # where only the pose is asked for


@dataclass(frozen=True)
class AdjustmentEstimator(Estimator):
    """The adjusted pose; the hand measurement counts as `settings.hand_measured_prior` says."""

    survey: Survey
    camera: Camera
    hand_measured: HandMeasured
    settings: AdjustmentSettings = field(default_factory=AdjustmentSettings)
    known_points: KnownPoints | None = None

    def select(self, numbers: Sequence[int]) -> "AdjustmentEstimator":
        """The same with these observations only; the tape measured once."""
        return replace(self, survey=self.survey.select(list(numbers)))

    def adjusted(self, start: ArrayLike | None = None, seed: int = 0) -> Adjustment:
        """All that the adjustment finds, from a start pose (6,), the hand-measured one if None."""
        return adjust(
            self.survey,
            self.camera,
            self.hand_measured.pose,
            self.hand_measured.body_covariance,
            self.settings.replaced(seed=seed),
            self.known_points,
            start_pose=start,
        )

    def estimate(self, start: ArrayLike, seed: int | None = None) -> Estimate:
        """The adjusted pose from a start pose (6,) with the posterior's covariance; of fewer draws without a seed."""
        if seed is None:
            settings = self.settings.replaced(n_draws=min(_FEWER_DRAWS, self.settings.n_draws), n_samples=_FEWEST)
            return self.noted(replace(self, settings=settings).adjusted(start))
        return self.noted(self.adjusted(start, seed))

    def searches(self) -> tuple[str, ...]:
        """Gauss-Newton, the adjustment's own."""
        return (GAUSS_NEWTON,)

    def search_by(self, name: str, start: ArrayLike) -> Estimate:
        """The adjusted pose from a start pose (6,); NaN where the adjustment comes to no estimate from there."""
        if name != GAUSS_NEWTON:
            raise InputError("basin.optimisers", f"{name!r}", GAUSS_NEWTON, "correct the name, or leave it out")
        quick = replace(self, settings=self.settings.replaced(**_FEW))
        try:
            return quick.noted(quick.adjusted(start))
        except EstimationError:
            return Estimate(self.survey.number, np.full(6, np.nan), np.full((6, 6), np.nan), np.nan, 0)

    def variations(self) -> Mapping[str, Estimator]:
        """With and without the hand measurement as a prior, and without heavy tails."""
        counts = self.settings.hand_measured_prior
        other = self.settings.replaced(hand_measured_prior=not counts)
        name = "without the hand measurement as prior" if counts else "with the hand measurement as prior"
        return {
            name: replace(self, settings=other),
            "no observation down-weighted": replace(self, settings=self.settings.replaced(tails=False)),
        }

    def noted(self, found: Adjustment) -> Estimate:
        """What an adjustment of this survey found, as an estimate."""
        return Estimate(
            self.survey.number,
            found.pose,
            found.covariance,
            0.5 * found.diagnostics.chi_squared,
            found.diagnostics.n_passes,
        )


def adjustment_estimator(survey: Survey, conditions: Conditions) -> AdjustmentEstimator:
    """The adjustment of a survey under these conditions."""
    settings = AdjustmentSettings(**dict(conditions.adjustment), hand_measured_prior=conditions.prior)
    return AdjustmentEstimator(survey, conditions.camera, conditions.hand_measured, settings, conditions.known_points)
