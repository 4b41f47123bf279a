"""What the survey tells of the camera: each intrinsic beside its prior."""

from typing import Final

import numpy as np

from linepose.output.report.sections import TableOnPage
from linepose.pipeline.adjusted_intrinsics import IDENTIFIABLE_SHARE, AdjustedIntrinsics

_WORDS: Final = {"principal_point_px": "principal point (px)", "focal_length_m": "focal length (mm)"}
_SCALE: Final = {"focal_length_m": 1e3}


def intrinsics_sentence(found: AdjustedIntrinsics) -> str:
    """Which intrinsics the survey told, and which it left to the platform file's sigmas."""
    told, left = ([_name(found.names[i]) for i in np.flatnonzero(one)] for one in (found.is_told, ~found.is_told))
    words = []
    if told:
        words.append(f"the survey tells {_joined(told)}")
    if left:
        words.append(f"{'it ' if told else 'the survey '}leaves {_joined(left)} to the platform file's sigmas")
    return f"Of the camera {', and '.join(words)}."


def intrinsics_on_page(anchor: str, found: AdjustedIntrinsics) -> TableOnPage:
    """The table: found and known before, each with one sigma, and whether the survey told it."""
    rows = []
    for i, name in enumerate(found.names):
        scale = _SCALE.get(name, 1.0)
        values = scale * np.array([found.estimate[i], found.sigma[i], found.prior[i], found.prior_sigma[i]])
        pairs = [f"{value:.5g} ± {sigma:.2g}" for value, sigma in (values[:2], values[2:])]
        rows.append([_WORDS.get(name, name), *pairs, "survey" if found.is_told[i] else "prior"])
    sentence = (
        f"One sigma each. The survey tells what it knows to less than {IDENTIFIABLE_SHARE:g} of the prior's sigma "
        "(camera.sigmas); what it does not tell stays where the platform's file has it, and moves with the pose."
    )
    heads = ["Intrinsic", "Found", "Known before", "Told by"]
    return TableOnPage(anchor, "The camera", sentence, heads, rows, folded=False)


def _name(name: str) -> str:
    return _WORDS.get(name, name).partition(" (")[0]


def _joined(words: list[str]) -> str:
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"
