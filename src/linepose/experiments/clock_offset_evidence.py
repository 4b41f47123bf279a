"""What is known of a clock offset, in words: whether the data tell it from the pose, and what to do."""

from dataclasses import dataclass
from typing import Final

from linepose.geometry.pose import TURN_WORDS

IDENTIFIABLE_SHRINKAGE: Final = 0.75  # of the shrinkage: the sigma is half of what it was before any data
MOST_COMMON: Final = 0.98  # correlation with the whole pose, where a sigma is five times what it is with the pose known
LINKED: Final = 0.9  # correlation with the pose, from which it is the pose that hides the offset, and not the noise
NOTABLE: Final = 3.0  # sigmas from zero
_LARGEST: Final = 0.9  # of the largest offset, where the search has run into its end
_WORDS: Final = {
    "r_x": "forward lever arm",
    "r_y": "sideways lever arm",
    "r_z": "height",
    **TURN_WORDS,
}


@dataclass(frozen=True)
class ClockOffsetEvidence:
    """What is known of the offset, and how to say it."""

    offset_s: float
    sigma_s: float
    maximum_s: float
    shrinkage: float
    correlation_pose: float
    correlation: dict[str, float]
    mahalanobis: float

    def is_identifiable(self) -> bool:
        """Whether the data tell the offset from the pose."""
        inside = abs(self.offset_s) < _LARGEST * self.maximum_s
        return self.shrinkage >= IDENTIFIABLE_SHRINKAGE and self.correlation_pose < MOST_COMMON and inside

    def verdict(self) -> str:
        """One or two sentences: what the offset is, or why it is not known."""
        found = f"{1e3 * self.offset_s:.1f} ± {1e3 * self.sigma_s:.1f} ms"
        if not self.is_identifiable():
            if abs(self.offset_s) >= _LARGEST * self.maximum_s and self.shrinkage >= IDENTIFIABLE_SHRINKAGE:
                return f"The clock offset is at the end of its range: {found} of ±{1e3 * self.maximum_s:g} ms."
            if self.correlation_pose < LINKED:
                return (
                    f"The data do not tell the clock offset: {found}, where ±{1e3 * self.maximum_s:g} ms were allowed."
                )
            return (
                f"The clock offset cannot be told from the pose: {found}, where ±{1e3 * self.maximum_s:g} ms were "
                f"allowed; it goes with the {self._partner()}, correlation {self._correlation():+.2f}."
            )
        if abs(self.offset_s) < NOTABLE * self.sigma_s:
            return f"No clock offset shows: {found} is less than {NOTABLE:g} sigmas."
        which = "behind" if self.offset_s > 0 else "ahead of"
        return (
            f"The camera's clock is {which} the navigation's: the offset is {found}. With it the pose moves by "
            f"{self.mahalanobis:.1f} sigmas."
        )

    def advice(self) -> str:
        """What to do; empty where there is nothing to do."""
        if not self.is_identifiable():
            if abs(self.offset_s) >= _LARGEST * self.maximum_s and self.shrinkage >= IDENTIFIABLE_SHRINKAGE:
                return "Raise experiments.clock_offset.maximum_s, and check in which time scale each clock runs."
            if self.correlation_pose < LINKED:
                return (
                    "Take the pose without the offset. Faster passes, more of them, or better navigation would tell it."
                )
            return (
                "Take the pose without the offset, and add passes in the other direction and at other speeds: they "
                "move the view the other way for the same offset."
            )
        if abs(self.offset_s) < NOTABLE * self.sigma_s:
            return ""
        verb = "Add" if self.offset_s > 0 else "Subtract"
        shift = abs(round(1e6 * self.offset_s))
        preposition = "to" if self.offset_s > 0 else "from"
        return f"{verb} {shift} us {preposition} the camera's time stamps and run again, or mend its clock."

    def _strongest(self) -> str:
        named = [f"correlation_{name}" for name in _WORDS]
        return max(named, key=lambda name: abs(self.correlation[name]))

    def _partner(self) -> str:
        return _WORDS[self._strongest().removeprefix("correlation_")]

    def _correlation(self) -> float:
        return self.correlation[self._strongest()]
