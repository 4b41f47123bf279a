"""The convention doctor in the check: which usual mistake with axes, signs, units or clocks explains the data.

Advice is given only after it was followed: the platform is read again as the advice would have it, and fits.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from linepose.check.conventions.examine import (
    ALIKE,
    Examination,
    Explanation,
    HandSigmas,
    RecordingAt,
    examine,
    explain,
)
from linepose.check.conventions.mistakes import AS_GIVEN, Mistake
from linepose.check.conventions.recording import Recording
from linepose.check.conventions.remedies import Remedy, remedies
from linepose.check.finding import Finding, Level, error, ok, warning
from linepose.check.motion import OFF_HEADING
from linepose.config.platform import Platform
from linepose.errors import InputError

_SUBJECT: Final = "conventions"

_FIRST_CONVENTIONS: Final = "first follow the advice on conventions, and check again"
_SIDEWAYS: Final = (
    "leave the log as it is if the vehicle was driven sideways, or pushed by wind: no other axes or angles fit the "
    "points better"
)

Reread = Callable[[Platform], Recording]


def convention_findings(
    platform: Platform,
    recording_at: RecordingAt,
    reread: Reread,
    sigmas: HandSigmas,
    mistakes: Sequence[Mistake] | None = None,
) -> list[Finding]:
    """What the doctor found: the mistake that explains the data, and those that the data cannot tell from it.

    `recording_at` gives the recording with the camera's clock moved by so many seconds, `reread` that of the platform
    with other settings; either raises InputError where it cannot be had. `mistakes` are all usual ones, if not given.
    """
    examination = examine(recording_at, sigmas, mistakes)
    n_tried = len(examination.explanations) - 1
    if not examination.is_mistaken and not examination.fits_as_given:
        found = f"as given the points fit {_fit(examination.as_given)}, and undoing none of {n_tried} usual mistakes "
        found += "with axes, signs, units and clocks makes them fit"
        return [warning(_SUBJECT, found, "check the camera, the labels, and what hand_measured says, in m and deg")]
    if not examination.is_mistaken:
        told = f"of {n_tried} usual mistakes with axes, signs, units and clocks none explains the data better"
        return [ok(_SUBJECT, told)]
    given = f"as given {_fit(examination.as_given)}"
    helping = _helping(platform, recording_at(0.0), reread, examination, sigmas)
    if not helping:
        likely = examination.best[0].mistake.name
        found = f"{given}; it looks as if {likely}, which no key of the platform file mends so that they fit"
        return [warning(_SUBJECT, found, "convert the log or the hand measurement accordingly, and check again")]
    (first, remedy), *others = helping
    found = f"it looks as if {first.mistake.name}: with that undone the points fit to {first.mean_error_px:.1f} px, "
    found += given
    advice = remedy.in_words()
    for other, another in others:
        found += f"; or, as likely, {other.mistake.name}"
        advice += f"; or, if it is rather that {other.mistake.name}, {another.in_words()}"
    return [error(_SUBJECT, found, advice)]


def _helping(
    platform: Platform, recording: Recording, reread: Reread, examination: Examination, sigmas: HandSigmas
) -> list[tuple[Explanation, Remedy]]:
    """The best explanations with a remedy that was tried and helps; those with the same remedy once."""
    found: list[tuple[Explanation, Remedy]] = []
    for one in examination.best:
        for remedy in remedies(one.mistake, platform, recording):
            if any(_says_the_same(remedy, other) for _, other in found):
                break
            if _helps(remedy, one, platform, reread, sigmas):
                found.append((one, remedy))
                break
    return found


def _says_the_same(remedy: Remedy, other: Remedy) -> bool:
    """Whether one says all that the other says, of the same keys."""
    return remedy.values == other.values


def _helps(remedy: Remedy, undone: Explanation, platform: Platform, reread: Reread, sigmas: HandSigmas) -> bool:
    """Whether the data of the platform that follows the advice fit as well as with the mistake undone."""
    try:
        recording = reread(remedy.applied(platform))
    except InputError:
        return False
    followed = explain(AS_GIVEN, lambda _: recording, sigmas)
    return followed.neg_log_posterior < undone.neg_log_posterior + ALIKE


def _fit(as_given: Explanation) -> str:
    return f"to {as_given.mean_error_px:.0f} px" if np.isfinite(as_given.mean_error_px) else "not at all"


def agreed(others: list[Finding], of_conventions: list[Finding]) -> list[Finding]:
    """Findings on motion and hand measurement with those on conventions, so that only one of them advises a change.

    Where a mistake was found, it is what the others see from afar; where the data fit as they are, a body that moves
    off its heading is no reason to change the log.
    """
    level = max(finding.level for finding in of_conventions)
    if level == Level.ERROR:
        others = [replace(one, advice=_FIRST_CONVENTIONS) if one.advice else one for one in others]
    elif level == Level.OK:
        others = [replace(one, advice=_SIDEWAYS) if one.advice == OFF_HEADING else one for one in others]
    return [*others, *of_conventions]
