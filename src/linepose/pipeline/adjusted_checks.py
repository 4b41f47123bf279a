"""The checks that only an adjustment has: weights of views, curvature, draws of the levels."""

from collections.abc import Sequence
from math import isnan
from typing import Final

from linepose.adjustment.draws_in_words import draws_in_words
from linepose.adjustment.lost_weight import most_lost_by_tails
from linepose.adjustment.thresholds import (
    CAUSES,
    MISFIT_SIGMAS,
    TRUSTED_EIGENVALUE,
)
from linepose.estimation.identifiability import WORDS
from linepose.pipeline.checks import CAMERA_SIGMAS, AdjustedEvidence, Check, Evidence, Level, LostMeasurement

_MANY: Final = 3  # one view in so many may be far off
_NAMED: Final = 5  # measurements in a message
_LARGE: Final = 3.0  # times what the navigation reports, from which its errors deserve a look ...
_FAR_TOO_LARGE: Final = 10.0  # ... and from which something else is wrong


def doubtful_views(evidence: Evidence, adjusted: AdjustedEvidence) -> Check:
    """Whether the adjustment had to give views, or more single measurements than heavy tails explain, little weight."""
    found = f"All {evidence.n_observations} observations count, each with its weight."
    if evidence.influence is not None:
        found += (
            f" Observation {evidence.most_influential} has the most influence: without it the pose moves by "
            f"{evidence.influence:.1f} sigmas."
        )
    if not adjusted.doubtful and not adjusted.lost:
        return Check("Weights", Level.GOOD, f"{found} None is far off.")
    advice, brief = [], []
    if adjusted.doubtful:
        named = ", ".join(f"{one.observation} ({CAUSES[one.fault]})" for one in adjusted.doubtful)
        found += f" Far off, and of little weight: observation {named}."
        if len(adjusted.doubtful) > evidence.n_observations / _MANY:
            advice.append("Look at these observations before the pose is relied on: more than a third are far off.")
            brief.append(f"{len(adjusted.doubtful)} of {evidence.n_observations} observations are far off")
    if adjusted.lost:
        bound = most_lost_by_tails(adjusted.n_measurements)
        found += (
            f" Of {adjusted.n_measurements} measurements{' of the others' if adjusted.doubtful else ''} "
            f"{len(adjusted.lost)} have lost their weight, where heavy tails explain up to {bound}: "
            f"{_named(adjusted.lost)}."
        )
        if len(adjusted.lost) > bound:
            advice.append("Look at these measurements: labels of other points, or matches of what looks alike.")
            brief.append(f"{len(adjusted.lost)} of {adjusted.n_measurements} measurements have lost their weight")
    return Check("Weights", Level.CARE if advice else Level.GOOD, found, " ".join(advice), ", ".join(brief))


def _named(lost: Sequence[LostMeasurement]) -> str:
    """The lightest by name, and that there are more."""
    named = [f"point {one.point} of observation {one.observation} ({one.weight:.2g})" for one in lost[:_NAMED]]
    return ", ".join(named) + (", ..." if len(lost) > _NAMED else "")


def curvature(adjusted: AdjustedEvidence) -> Check:
    """Whether the sigmas rest on a curvature that the data show."""
    if isnan(adjusted.least_eigenvalue):
        return Check(
            "Curvature",
            Level.BAD,
            "The search ended where the sigmas cannot be had.",
            "See to the other checks that failed first.",
            "the search ended where the sigmas cannot be had",
        )
    found = (
        f"Along the direction that is known least, chi squared curves {adjusted.least_eigenvalue:.2f} of what the "
        "normal equations say."
    )
    if adjusted.least_eigenvalue >= TRUSTED_EIGENVALUE:
        return Check("Curvature", Level.GOOD, found)
    return Check(
        "Curvature",
        Level.BAD,
        f"{found} Below {TRUSTED_EIGENVALUE} the sigmas are not to be trusted.",
        "Add observations from other sides and with other tilts.",
        "the sigmas rest on a direction that is hardly known",
    )


def camera(adjusted: AdjustedEvidence) -> Check:
    """Whether the intrinsics agree with the platform's file."""
    name, sigmas = WORDS.get(adjusted.camera_parameter, adjusted.camera_parameter), adjusted.camera_sigmas
    if sigmas is not None and isnan(sigmas):
        return Check(
            "Camera",
            Level.CARE,
            "Whether the camera is as the platform's file has it cannot be told: its sigmas cannot be had.",
            "See to the other checks that failed first.",
            "whether the camera is as in the platform's file cannot be told",
        )
    if adjusted.camera_held and (sigmas is None or sigmas <= CAMERA_SIGMAS):
        held = " and ".join(WORDS.get(one, one) for one in adjusted.camera_held)
        return Check(
            "Camera",
            Level.CARE,
            f"The sigmas of {held} in the platform's file are so small that no survey can test them.",
            "Give in camera.sigmas how well it is known; a wrong camera moves the pose.",
            f"the survey cannot test {held}",
        )
    if sigmas is None:
        return Check("Camera", Level.GOOD, "The camera is taken from the platform's file: the survey hardly tests it.")
    found = f"Of the camera {name} lies {sigmas:.1f} sigmas from the platform's file"
    if sigmas <= CAMERA_SIGMAS:
        return Check("Camera", Level.GOOD, f"{found}, as far as the survey tests it.")
    return Check(
        "Camera",
        Level.CARE,
        f"{found}: the survey contradicts it.",
        "Check section camera against the data sheet or the lens's calibration (focal length, pixel pitch, field of "
        "view, binning), and how well camera.sigmas says that it is known; a wrong camera moves the pose.",
        f"{name} is {sigmas:.1f} sigmas from the platform's file",
    )


def draws(adjusted: AdjustedEvidence) -> Check:
    """Whether the draws of the levels are worth enough."""
    told = draws_in_words(adjusted.effective_draws, adjusted.pareto_shape)
    found = f"The draws of the levels are {told.found}."
    return Check("Draws of the levels", Level.CARE if told.advice else Level.GOOD, found, told.advice, told.brief)


def times(adjusted: AdjustedEvidence) -> Check:
    """Whether drift of the navigation is allowed for."""
    if adjusted.drift_known:
        return Check("Times", Level.GOOD, "Drift of the navigation is estimated from the times.")
    return Check(
        "Times",
        Level.CARE,
        "The measurements have no times that differ: drift of the navigation is not known and not allowed for.",
        "Give the times (time_us): where the navigation drifts the sigmas are too small without them.",
        "without times drift of the navigation is not allowed for",
    )


def known_target(misfit: float) -> Check:
    """Whether the target's known geometry, so many sigmas off what is seen without it, could be used."""
    found = f"The target's known geometry is {max(misfit, 0.0):.1f} sigmas off what is seen without it"
    if misfit <= MISFIT_SIGMAS:
        return Check("Known target", Level.GOOD, f"{found}, and counts.")
    return Check(
        "Known target",
        Level.CARE,
        f"{found}, and was not used.",
        "Correct the dimensions of target, the ids of the labels, or target.sigma_m.",
        f"the target's known geometry is {misfit:.0f} sigmas off",
    )


def error_size(adjusted: AdjustedEvidence) -> Check:
    """Whether the navigation's errors are about as large as it reports."""
    found = f"The navigation's errors are {adjusted.navigation_error:.2g} times what it reports."
    if adjusted.navigation_error <= _LARGE:
        return Check("Size of the errors", Level.GOOD, found)
    far_too_large = adjusted.navigation_error > _FAR_TOO_LARGE
    return Check(
        "Size of the errors",
        Level.BAD if far_too_large else Level.CARE,
        f"{found} Either its sigmas are too small, or something else is wrong that these stand for.",
        "Run linepose check, which looks for mistakes with axes, signs, units, clocks and the hand measurement; "
        "else correct the units of the navigation's sigmas.",
        f"the navigation errs by {adjusted.navigation_error:.2g} times what it reports",
    )
