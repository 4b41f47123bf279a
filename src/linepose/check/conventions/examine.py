"""Each usual mistake is undone and the pose fitted near the hand-measured one; the data tell which undoing fits best.

What is compared is `1/2 chi^2` of the whitened residuals and of the hand measurement together, at its least: the
paper's -log L with a Gaussian prior on the pose (its sigmas as given). Two mistakes may leave the same residuals (a
flipped scan line, and a camera mounted the other way round); such ties are told.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

from linepose.arrays import Floats
from linepose.check.conventions.mistakes import AS_GIVEN, Mistake, usual_mistakes
from linepose.check.conventions.recording import Recording
from linepose.errors import EstimationError, InputError
from linepose.estimation.wide_search import whitened_residuals
from linepose.geometry.camera import straight_and_certain
from linepose.likelihood.base import Likelihood
from linepose.likelihood.published import PublishedLikelihood

ALIKE: Final = 3.0  # in -log: odds of 20, below which two explanations are not told apart
CONVINCING: Final = 10.0  # in -log: odds of 22,000, above which a mistake is believed
_MOST_PX: Final = 20.0  # mean error from which on points do not fit, whatever is undone
_FEW_PX: Final = 10.0  # below which they do
_SHARE: Final = 0.2  # of the error as given, to which undoing a mistake brings that of points in between
_FIRST_STEPS: Final = 6  # after which explanations that fit far worse than the best are left
_FAR_WORSE: Final = 10.0  # times the least -log
_MAXIMUM_STEPS: Final = 40
_TOLERANCE: Final = 1e-4

RecordingAt = Callable[[float], Recording]


@dataclass(frozen=True)
class HandSigmas:
    """One standard deviation of the hand-measured position (m) and of a turn about each axis (rad)."""

    position_m: float
    angle_rad: float


@dataclass(frozen=True)
class Explanation:
    """How well the data fit with one mistake undone: -log of likelihood and prior, mean reprojection error, pose (6,).

    Infinite, and NaN, where there is no fit at all.
    """

    mistake: Mistake
    neg_log_posterior: float
    mean_error_px: float
    pose: Floats


@dataclass(frozen=True)
class Examination:
    """Every explanation, the best first, and the data as they were given."""

    explanations: tuple[Explanation, ...]
    as_given: Explanation

    @property
    def best(self) -> tuple[Explanation, ...]:
        """What explains the data: the best, and all that the data cannot tell from it and that assume no more mistakes.

        The data as given alone, where nothing explains them convincingly better, and so that the points fit.
        """
        given = self.as_given
        better = [
            one
            for one in self.explanations
            if one.neg_log_posterior < given.neg_log_posterior - CONVINCING
            and not one.mean_error_px >= given.mean_error_px
            and _fits(one.mean_error_px, given.mean_error_px)
        ]
        if not better:
            return (given,)
        alike = [one for one in better if one.neg_log_posterior < better[0].neg_log_posterior + ALIKE]
        fewest = min(one.mistake.n_changes for one in alike)
        return tuple(one for one in alike if one.mistake.n_changes == fewest)

    @property
    def fits_as_given(self) -> bool:
        """Whether the points fit as they are."""
        return self.as_given.mean_error_px < _MOST_PX

    @property
    def is_mistaken(self) -> bool:
        """Whether a mistake explains the data convincingly better than taking them as given."""
        return self.best[0] is not self.as_given


def _fits(error_px: float, given_px: float) -> bool:
    """Whether points with a mean error fit, of which undoing a mistake is to make the most part of it vanish."""
    return error_px < _FEW_PX or (error_px < _MOST_PX and not error_px > _SHARE * given_px)


def examine(recording_at: RecordingAt, sigmas: HandSigmas, mistakes: Sequence[Mistake] | None = None) -> Examination:
    """Try every mistake on a recording.

    `recording_at` gives the recording with the camera's clock moved by so many seconds, and raises InputError where
    that leads outside the log or cannot be done.
    """
    as_given = explain(AS_GIVEN, recording_at, sigmas)
    begun = [explain(mistake, recording_at, sigmas, _FIRST_STEPS) for mistake in mistakes or usual_mistakes()]
    worst = _FAR_WORSE * min(one.neg_log_posterior for one in [as_given, *begun])
    tried = [
        explain(one.mistake, recording_at, sigmas) if one.neg_log_posterior <= worst < np.inf else one for one in begun
    ]
    ranked = sorted([as_given, *tried], key=lambda one: one.neg_log_posterior)
    return Examination(tuple(ranked), as_given)


def explain(
    mistake: Mistake, recording_at: RecordingAt, sigmas: HandSigmas, maximum_steps: int = _MAXIMUM_STEPS
) -> Explanation:
    """The best fit near the hand-measured pose, within so many steps, with this mistake undone."""
    try:
        recording = mistake.undo(recording_at(mistake.clock_shift_s))
        likelihood = PublishedLikelihood(recording.survey, straight_and_certain(recording.camera))
        pose, value = _fit(likelihood, recording.pose, sigmas, maximum_steps)
        if not np.isfinite(likelihood.log_likelihood(pose)):  # residuals alone do not tell in front from behind
            raise EstimationError("a point lies behind the camera")
        error_px = float(np.nanmean(likelihood.residuals(pose).error_px))
    except (InputError, EstimationError):
        return Explanation(mistake, np.inf, np.nan, np.full(6, np.nan))
    return Explanation(mistake, value, error_px, pose)


def _fit(likelihood: Likelihood, hand: Floats, sigmas: HandSigmas, maximum_steps: int) -> tuple[Floats, float]:
    """The best pose (6,) near the hand-measured one, and half the sum of squares there."""
    scale = np.repeat([sigmas.position_m, sigmas.angle_rad], 3)
    rotation = Rotation.from_rotvec(hand[3:])

    def moved(step: Floats) -> Floats:
        return np.concatenate([hand[:3] + step[:3], (Rotation.from_rotvec(step[3:]) * rotation).as_rotvec()])

    def residuals(unit: Floats) -> Floats:
        return np.concatenate([whitened_residuals(likelihood, moved(unit * scale)), unit])

    found = least_squares(residuals, np.zeros(len(scale)), max_nfev=maximum_steps, ftol=_TOLERANCE, xtol=_TOLERANCE)
    return moved(found.x * scale), float(found.cost)
