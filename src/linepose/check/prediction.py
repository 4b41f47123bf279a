"""The sigmas that the survey's geometry promises, and which motion is missing where one is too large."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from linepose.arrays import Floats
from linepose.check.finding import Finding, PredictedSigma, error, ok, warning
from linepose.check.information import published_covariance, shared_covariance
from linepose.check.motions import best_motions, motions, spread_in_words
from linepose.check.replay import replayed
from linepose.errors import EstimationError, LineposeError
from linepose.estimation.identifiability import WORDS, identifiability, in_body_axes
from linepose.geometry.camera import Camera
from linepose.geometry.pose import POSE_COLUMNS
from linepose.geometry.rotations import left_jacobian_so3
from linepose.survey.observations import Survey

TOO_LARGE: Final = 0.5  # of the hand measurement's sigma
_SWEPT: Final = 0.5  # of the points, below which the replayed survey is not this one
_UNITS: Final = ("m", "m", "m", "rad", "rad", "rad")
_SUBJECT: Final = "predicted sigmas"


@dataclass(frozen=True)
class Prediction:
    """Predicted sigmas of the six numbers, rotations as small turns about the body's axes, and what was found."""

    sigmas: tuple[PredictedSigma, ...]
    findings: tuple[Finding, ...]


def predict(survey: Survey, camera: Camera, pose: Floats, hand_sigma: Floats, point_m: Floats) -> Prediction:
    """What a calibration will know, from the geometry at a hand-measured pose (6,).

    hand_sigma (6,): how well the pose is known by hand, position (m) and turns about the body's axes (rad); point_m
    (M, 3): the pattern points at that pose, from the survey's origin.
    """
    ideal = replayed(survey, camera, pose, point_m)
    swept = np.isfinite(ideal.u_px).sum() / np.isfinite(survey.u_px).sum()
    if swept < _SWEPT:
        found = (
            f"not known: at the hand-measured pose only {100 * swept:.0f} % of the points would cross the scan line on "
            "the sensor when the vehicle drives along its heading"
        )
        advice = "check hand_measured.euler_deg (camera x lies along the scan line), and the navigation's yaw"
        return Prediction((), (warning(_SUBJECT, found, advice),))
    try:
        published = published_covariance(ideal, camera, pose, point_m)
    except LineposeError as fault:
        found = f"a direction of the pose stays open; {spread_in_words(survey)} ({fault})"
        advice = "add passes from other sides, at other distances, and with the vehicle rolled and pitched"
        return Prediction((), (error(_SUBJECT, found, advice),))
    names, in_axes = in_body_axes(POSE_COLUMNS, pose, published)
    sigma = np.sqrt(np.diag(in_axes))
    shared_sigma = _shared_sigma(ideal, camera, pose)
    sigmas = tuple(
        PredictedSigma(
            WORDS[name],
            unit,
            float(hand_sigma[k]),
            float(sigma[k]),
            None if shared_sigma is None else float(shared_sigma[k]),
        )
        for k, (name, unit) in enumerate(zip(names, _UNITS, strict=True))
    )
    large = [one for one in sigmas if one.published > TOO_LARGE * one.hand]
    if not large:
        return Prediction(
            sigmas, (ok(_SUBJECT, f"all below half of the hand measurement's; {spread_in_words(survey)}"),)
        )
    words = identifiability(names, in_axes, hand_sigma).weakest_in_words()
    worst = max(large, key=lambda one: one.published / one.hand)
    index = [WORDS[name] for name in names].index(worst.name)
    direction = _axis_of_pose(pose)[index]
    told = ", ".join(f"{one.name} {size(one.published, one.unit)} ({size(one.hand, one.unit)})" for one in large)
    found = f"less than twice as good as by hand: {told}; weakest direction: {words}; {spread_in_words(survey)}"
    ranked = best_motions(motions(ideal, camera, pose, point_m), direction)
    ways = "; or ".join(f"{way}: {worst.name} to {size(value, worst.unit)}" for way, value in ranked[:2])
    advice = f"drive four more passes {ways}" if ways else "add passes from other sides and with other tilts"
    return Prediction(sigmas, (warning(_SUBJECT, found, advice),))


def _shared_sigma(ideal: Survey, camera: Camera, pose: Floats) -> Floats | None:
    try:
        shared = shared_covariance(ideal, camera, pose)
    except EstimationError:
        return None
    return None if shared is None else np.sqrt(np.diag(in_body_axes(POSE_COLUMNS, pose, shared)[1]))


def _axis_of_pose(pose: Floats) -> Floats:
    """Rows (6, 6): each number in body axes as a combination of the pose's parameters."""
    rows = np.eye(6)
    rows[3:, 3:] = left_jacobian_so3(pose[3:6])
    return rows


def size(value: float, unit: str) -> str:
    """A sigma for people: millimetres or degrees."""
    return f"{1e3 * value:.0f} mm" if unit == "m" else f"{np.degrees(value):.2f} deg"
