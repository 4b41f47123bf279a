"""What the draws of the levels are worth, in words, and what helps where it is too little."""

from dataclasses import dataclass
from typing import Final

import numpy as np

from linepose.adjustment.thresholds import FEWEST_EFFECTIVE_DRAWS, TRUSTED_SHAPE

_AMPLE: Final = 2.0  # times the fewest draws that are aimed at, since what more draws are worth varies
_MOST_DIGITS: Final = 6


@dataclass(frozen=True)
class DrawsInWords:
    """What was found; the fault in a few words and what to do, both empty where the draws are worth enough."""

    found: str
    brief: str = ""
    advice: str = ""


def draws_in_words(effective_draws: float, pareto_shape: float) -> DrawsInWords:
    """What so many effective draws with this Pareto shape of their weights are good for.

    Few draws are mended by more. A heavy tail is not: it says that the levels are spread wider than they are drawn.
    """
    few, heavy = effective_draws < FEWEST_EFFECTIVE_DRAWS, pareto_shape > TRUSTED_SHAPE
    found = (
        f"worth {_apart(effective_draws, FEWEST_EFFECTIVE_DRAWS, 0)}, Pareto shape "
        f"{_apart(pareto_shape, TRUSTED_SHAPE, 2)}"
    )
    if few:
        times = int(np.ceil(_AMPLE * FEWEST_EFFECTIVE_DRAWS / max(effective_draws, 1.0)))
        return DrawsInWords(
            f"{found}, where {FEWEST_EFFECTIVE_DRAWS:.0f} or more are needed",
            "the draws of the levels are too few",
            f"Make adjustment.n_draws in config/config.yaml {times} times as large and run again.",
        )
    if heavy:
        return DrawsInWords(
            f"{found}, where {TRUSTED_SHAPE:g} or less is to be trusted",
            "the levels are known too loosely for sigmas to be trusted",
            "Add views, with other motions; more draws do not help.",
        )
    return DrawsInWords(found)


def _apart(value: float, bound: float, digits: int) -> str:
    """A number with so many digits, or as many more as tell it from the bound."""
    while value != bound and digits < _MOST_DIGITS and float(f"{value:.{digits}f}") == bound:
        digits += 1
    return f"{value:.{digits}f}"
