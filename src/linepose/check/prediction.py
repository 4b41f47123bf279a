"""The sigmas that a survey promises, and which motion is missing where one is too large.

The observations are adjusted as they are, so that what is promised is what a run delivers; what more passes would bring
follows from the normal equations of the same survey with them, at the levels that the adjustment found.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from linepose.adjustment.known_points import KnownPoints
from linepose.adjustment.result import Adjustment
from linepose.adjustment.settings import AdjustmentSettings
from linepose.arrays import Floats
from linepose.check.finding import Finding, PredictedSigma, error, ok, warning
from linepose.check.motions import Promise, best_motions, motions, spread_in_words
from linepose.check.replay import replayed
from linepose.errors import EstimationError
from linepose.estimation.adjustment_estimator import AdjustmentEstimator
from linepose.estimation.identifiability import WORDS, identifiability, in_body_axes
from linepose.geometry.camera import Camera
from linepose.geometry.pose import POSE_COLUMNS
from linepose.survey.hand_measured import HandMeasured
from linepose.survey.observations import Survey

TOO_LARGE: Final = 0.5  # of the hand measurement's sigma
_SWEPT: Final = 0.5  # of the points, below which the replayed survey is not this one
_UNITS: Final = ("m", "m", "m", "rad", "rad", "rad")
_SUBJECT: Final = "predicted sigmas"
_CONTRADICTING: Final = "correct its coordinates, its sigmas or its label; it counts little as it is"
_DRAWS: Final = AdjustmentSettings(n_draws=60, n_samples=10)


@dataclass(frozen=True)
class Prediction:
    """Predicted sigmas of the six numbers, rotations as small turns about the body's axes, and what was found.

    `adjusted` is what the observations as they are give, None where it is not known.
    """

    sigmas: tuple[PredictedSigma, ...]
    findings: tuple[Finding, ...]
    adjusted: Adjustment | None = None


def predict(
    survey: Survey,
    camera: Camera,
    hand: HandMeasured,
    prior: bool,
    point_m: Floats,
    known_points: KnownPoints | None = None,
) -> Prediction:
    """What a calibration will know, from the observations and the hand-measured pose.

    `prior`: whether the hand measurement counts as a prior; point_m (M, 3): the pattern's points at that pose, from the
    survey's origin; known_points: what else is known of them.
    """
    ideal = replayed(survey, camera, hand.pose, point_m)
    swept = np.isfinite(ideal.u_px).sum() / np.isfinite(survey.u_px).sum()
    if swept < _SWEPT:
        found = (
            f"not known: at the hand-measured pose only {100 * swept:.0f} % of the points would cross the scan line on "
            "the sensor when the vehicle drives along its heading"
        )
        advice = "check hand_measured.euler_deg (camera x lies along the scan line), and the navigation's yaw"
        return Prediction((), (warning(_SUBJECT, found, advice),))
    settings = _DRAWS.replaced(hand_measured_prior=prior)
    try:
        adjusted = AdjustmentEstimator(survey, camera, hand, settings, known_points).adjusted()
    except EstimationError as fault:
        found = f"a direction of the pose stays open; {spread_in_words(survey)} ({fault})"
        advice = "add passes from other sides, at other distances, and with the vehicle rolled and pitched"
        return Prediction((), (error(_SUBJECT, found, advice),))
    against = tuple(
        warning("known points", f"point {one.point} is {one.sigmas:.1f} sigmas off what all else says", _CONTRADICTING)
        for one in adjusted.diagnostics.contradictions
    )
    if (board := adjusted.diagnostics.board) is not None and not board.counts:
        against += (warning("known points", *board.in_words()),)
    names, in_axes = in_body_axes(POSE_COLUMNS, adjusted.pose, adjusted.covariance)
    sigma, by_hand = np.sqrt(np.diag(in_axes)), np.sqrt(np.diag(hand.body_covariance))
    sigmas = tuple(
        PredictedSigma(WORDS[name], unit, float(by_hand[k]), float(sigma[k]))
        for k, (name, unit) in enumerate(zip(names, _UNITS, strict=True))
    )
    large = [one for one in sigmas if one.predicted > TOO_LARGE * one.hand]
    if not large:
        told = f"all below half of the hand measurement's; {spread_in_words(survey)}"
        return Prediction(sigmas, (*against, ok(_SUBJECT, told)), adjusted)
    words = identifiability(names, in_axes, by_hand).weakest_in_words()
    worst = max(large, key=lambda one: one.predicted / one.hand)
    told = ", ".join(f"{one.name} {size(one.predicted, one.unit)} ({size(one.hand, one.unit)})" for one in large)
    found = f"less than twice as good as by hand: {told}; known least: {words}; {spread_in_words(survey)}"
    promise = Promise(camera, adjusted, hand.body_covariance if prior else None, known_points)
    ranked = best_motions(motions(ideal, promise, point_m), sigmas.index(worst))
    ways = "; or ".join(f"{way}: {worst.name} to {size(value, worst.unit)}" for way, value in ranked[:2])
    advice = f"drive four more passes {ways}" if ways else "add passes from other sides and with other tilts"
    return Prediction(sigmas, (*against, warning(_SUBJECT, found, advice)), adjusted)


def size(value: float, unit: str) -> str:
    """A sigma for people: millimetres or degrees."""
    return f"{1e3 * value:.0f} mm" if unit == "m" else f"{np.degrees(value):.2f} deg"
