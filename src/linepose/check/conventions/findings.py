"""The convention doctor in the check: which usual mistake with axes, signs, units or clocks explains the data."""

from typing import Final

import numpy as np

from linepose.check.conventions.examine import Explanation, HandSigmas, RecordingAt, examine
from linepose.check.finding import Finding, error, ok

_SUBJECT: Final = "conventions"


def convention_findings(recording_at: RecordingAt, sigmas: HandSigmas) -> list[Finding]:
    """What the doctor found: the mistake that explains the data, and those that the data cannot tell from it.

    `recording_at` gives the recording with the camera's clock moved by so many seconds, or raises InputError.
    """
    examination = examine(recording_at, sigmas)
    n_tried = len(examination.explanations) - 1
    if not examination.is_mistaken:
        told = f"of {n_tried} usual mistakes with axes, signs, units and clocks none explains the data better"
        return [ok(_SUBJECT, told)]
    first, *others = examination.best
    found = f"it looks as if {first.mistake.name}: with that undone the points fit to {first.mean_error_px:.1f} px, "
    found += f"as given {_fit(examination.as_given)}"
    advice = first.mistake.remedy
    for other in others:
        found += f"; or, as likely, {other.mistake.name}"
        advice += f"; or {other.mistake.remedy}"
    return [error(_SUBJECT, found, advice)]


def _fit(as_given: Explanation) -> str:
    return f"to {as_given.mean_error_px:.0f} px" if np.isfinite(as_given.mean_error_px) else "not at all"
