"""Sizes of paper, and what fits on them."""

import difflib
import re
from dataclasses import dataclass
from typing import Final

from linepose.errors import InputError

MARGIN_MM: Final = 9.0  # along each edge, which a printer leaves white or where the bar and the marks stand
_LARGEST_MM: Final = 5000.0
_SIZES_MM: Final = {
    "A0": (841, 1189),
    "A1": (594, 841),
    "A2": (420, 594),
    "A3": (297, 420),
    "A4": (210, 297),
    "A5": (148, 210),
    "B0": (1000, 1414),
    "B1": (707, 1000),
    "B2": (500, 707),
    "B3": (353, 500),
    "B4": (250, 353),
    "letter": (215.9, 279.4),
    "legal": (215.9, 355.6),
    "tabloid": (279.4, 431.8),
    "arch-d": (609.6, 914.4),
    "arch-e": (914.4, 1219.2),
}
_OWN_SIZE: Final = re.compile(r"(\d+(?:\.\d+)?)x(\d+(?:\.\d+)?)", re.IGNORECASE)


@dataclass(frozen=True)
class Paper:
    """A sheet as it lies: its name, and its width and height (mm)."""

    name: str
    width_mm: float
    height_mm: float

    @property
    def inner_mm(self) -> tuple[float, float]:
        """Width and height within the margin (mm)."""
        return self.width_mm - 2 * MARGIN_MM, self.height_mm - 2 * MARGIN_MM

    def laid_for(self, width_mm: float, height_mm: float) -> "Paper":
        """The sheet upright or on its side, whichever is more like a field of this size."""
        wide = (self.width_mm >= self.height_mm) == (width_mm >= height_mm)
        return self if wide else Paper(self.name, self.height_mm, self.width_mm)

    def holds(self, width_mm: float, height_mm: float) -> bool:
        """Whether a field of this size fits within the margin, one way or the other."""
        sides = sorted(self.inner_mm)
        needed = sorted([width_mm, height_mm])
        return needed[0] <= sides[0] + 1e-6 and needed[1] <= sides[1] + 1e-6


def paper_of(text: str, option: str = "--paper") -> Paper:
    """The paper of this name, or of a size as 500x700 (mm); raises InputError that names the option."""
    own = _OWN_SIZE.fullmatch(text.strip())
    if own:
        width, height = float(own[1]), float(own[2])
        if not 4 * MARGIN_MM <= min(width, height) <= max(width, height) <= _LARGEST_MM:
            expected = f"sides from {4 * MARGIN_MM:g} to {_LARGEST_MM:g} mm"
            raise InputError(option, text, expected, "correct the size: width x height in mm, as in 500x700")
        return Paper(text.strip(), width, height)
    names = {name.lower(): name for name in _SIZES_MM}
    name = names.get(text.strip().lower())
    if name is None:
        near = difflib.get_close_matches(text.lower(), names, n=1)
        remedy = f"did you mean {names[near[0]]}?" if near else "give width x height in mm, as in 500x700"
        raise InputError(option, repr(text), f"one of {', '.join(_SIZES_MM)}, or a size in mm", remedy)
    return Paper(name, *(float(side) for side in _SIZES_MM[name]))


def smallest_paper(width_mm: float, height_mm: float) -> Paper | None:
    """The smallest known paper that holds a field of this size; None where none does."""
    fitting = [Paper(name, *sides) for name, sides in _SIZES_MM.items()]
    fitting = [one for one in fitting if one.holds(width_mm, height_mm)]
    return min(fitting, key=lambda one: one.width_mm * one.height_mm, default=None)
