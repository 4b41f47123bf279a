"""What the errors of a view that the adjustment gave little weight look like: a clock, labels, a jump, or unclear."""

from typing import Final

import numpy as np

from linepose.adjustment.lost_weight import most_lost_by_tails
from linepose.adjustment.result import Adjustment
from linepose.adjustment.thresholds import CLOCK, DOUBTFUL_WEIGHT, JUMP, LABEL, UNCLEAR
from linepose.arrays import Floats
from linepose.likelihood.base import Residuals

_MOSTLY: Final = 0.8  # share of the squared errors that a cause explains
_FEWEST: Final = 3  # measurements of a view that tell causes apart


def view_faults(found: Adjustment, errors: Residuals) -> list[str]:
    """One word a view (N,): `clock`, `label`, `jump` or `unclear`, empty for a view that is as good as the rest.

    A view is far off that has lost its own weight, or in which more measurements have than heavy tails explain. Some
    measurements far off while the others are good: labels. Errors that one time shift explains: a clock. Otherwise the
    body's pose jumped or drifted within the view. Of fewer than three measurements it is not clear.
    """
    words = []
    for view in range(len(found.view_weight)):
        single = found.measurement_weight[view]
        n_lost, n_seen = int(np.sum(single < DOUBTFUL_WEIGHT)), int(np.sum(np.isfinite(single)))
        far_off = found.view_weight[view] < DOUBTFUL_WEIGHT or n_lost > most_lost_by_tails(n_seen)
        words.append(_word(errors, single, view) if far_off else "")
    return words


def _word(errors: Residuals, single: Floats, view: int) -> str:
    seen = np.flatnonzero(np.isfinite(errors.error_px[view]))
    if len(seen) < _FEWEST:
        return UNCLEAR
    bad = single[seen] < DOUBTFUL_WEIGHT
    if bad.any() and not bad.all() and bad.sum() <= len(seen) / 2:
        return LABEL
    error = errors.error_uv_px[view, seen]
    total = float(np.sum(error**2))
    shifted = total - float(np.sum((error - error.mean(axis=0)) ** 2))
    if total > 0 and _along_motion(error) and shifted > _MOSTLY * total:
        return CLOCK
    return JUMP


def _along_motion(error: Floats) -> bool:
    """Whether the common error of a view (K, 2) is across the scan line, as a shift in time is."""
    along, across = np.abs(error.mean(axis=0))
    return bool(across > along)
