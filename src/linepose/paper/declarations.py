"""config/paper/regression.yaml: what each number is held to, declared before anything is run."""

from collections.abc import Mapping
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Literal, Self

from pydantic import Field, NonNegativeFloat, PositiveFloat, model_validator

from linepose.config.yaml_file import read_yaml
from linepose.errors import InputError
from linepose.settings import Settings, SettingsError, validated

NumberSetName = Literal["ladybird", "ladybird_attitude", "ladybird_simulated", "shrimp_simulated"]
PLACE = "config/paper/regression.yaml"


class Tolerance(Settings):
    """How far the numbers of a group may be from the published ones: the sum of three parts."""

    quantities: list[str] = Field(min_length=1, description="Names of the numbers; * stands for any text.")
    absolute: NonNegativeFloat = Field(0.0, description="In the number's own unit.")
    relative: NonNegativeFloat = Field(0.0, description="Share of the published number.")
    sigmas: NonNegativeFloat = Field(0.0, description="Multiples of the sigma that the paper prints for the number.")
    note: str = Field("", description="What a reader should know of the group.")

    def holds_for(self, quantity: str) -> bool:
        """Whether the number belongs to the group."""
        return any(fnmatchcase(quantity, pattern) for pattern in self.quantities)


class Expected(Settings):
    """The value that is expected instead of a published one, in the number's own unit."""

    expected: float = Field(description="The value, or the centre of the interval, that is expected.")
    tolerance: PositiveFloat = Field(description="How far from it the obtained number may be, either way.")


class Deviation(Settings):
    """Numbers that are known not to be reached, for one reason."""

    reason: str = Field(min_length=1, description="Why the published number is not reached.")
    numbers: dict[str, Expected] = Field(min_length=1, description="What is expected instead, by the number's name.")


class Declarations(Settings):
    """What the results are held against."""

    platforms: dict[str, NumberSetName] = Field(description="The set of numbers that each platform is held against.")
    tolerances: list[Tolerance] = Field(description="Every number belongs to exactly one of these groups.")
    deviations: list[Deviation] = Field([], description="Known deviations; the published number no longer counts.")

    @model_validator(mode="after")
    def _one_deviation_a_number(self) -> Self:
        names = [name for deviation in self.deviations for name in deviation.numbers]
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            found = f"{names.count(twice[0])} deviations for {twice[0]}"
            raise SettingsError(found, "one deviation a number", "leave out all but one")
        return self

    def tolerance_of(self, quantity: str) -> Tolerance:
        """The group of a number; raises InputError where it belongs to none or to several."""
        groups = [group for group in self.tolerances if group.holds_for(quantity)]
        if len(groups) != 1:
            raise InputError(
                f"{PLACE}: tolerances",
                f"{len(groups) or 'no'} groups for {quantity}",
                "exactly one",
                "make the patterns of `quantities` name it once",
            )
        return groups[0]

    def reason(self, beginning: str) -> str:
        """Why numbers whose names begin like this deviate; empty where none does."""
        reasons = [reason for name, (_, reason) in self.expected.items() if name.startswith(beginning)]
        return reasons[0] if reasons else ""

    @property
    def expected(self) -> Mapping[str, tuple[Expected, str]]:
        """Each number that is known to deviate, with what is expected instead and the reason."""
        return {
            name: (value, deviation.reason)
            for deviation in self.deviations
            for name, value in deviation.numbers.items()
        }


def load_declarations(path: Path) -> Declarations:
    """The declarations in a file; raises InputError naming the first key that is wrong."""
    return validated(Declarations, read_yaml(path), str(path))
