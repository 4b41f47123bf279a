"""The sets of numbers that a platform can be held against: what each reads, and the numbers it makes of that."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from typing import Final

from linepose.paper.declarations import NumberSetName
from linepose.paper.experiment_numbers import basin_numbers, table_numbers
from linepose.paper.number import Number, Published, Results
from linepose.paper.simulated_numbers import simulated_numbers
from linepose.paper.stage_numbers import attitude_numbers, field_numbers

_STAGES: Final = ("pose", "outliers", "navigation_sigma")
_TRUTH: Final = ("truth", "truth_error", "extraction_accuracy", "detection")


@dataclass(frozen=True)
class NumberSet:
    """The results of a platform that are read, results/NAME/{name}.parquet, and the numbers they give."""

    results: tuple[str, ...]
    numbers: Callable[[str, Published, Results], list[Number]]


def _ladybird(name: str, published: Published, results: Results) -> list[Number]:
    return [
        *field_numbers(name, published, results),
        *table_numbers(name, published, results),
        *basin_numbers(name, published, results),
    ]


def _shrimp_simulated(name: str, published: Published, results: Results) -> list[Number]:
    return [*simulated_numbers("shrimp", name, published, results), *basin_numbers(name, published, results)]


NUMBER_SETS: Final[Mapping[NumberSetName, NumberSet]] = {
    "ladybird": NumberSet((*_STAGES, "subsets", "repeatability", "basin_summary"), _ladybird),
    "ladybird_attitude": NumberSet(_STAGES, attitude_numbers),
    "ladybird_simulated": NumberSet((*_STAGES, *_TRUTH), partial(simulated_numbers, "ladybird")),
    "shrimp_simulated": NumberSet((*_STAGES, *_TRUTH, "basin_summary"), _shrimp_simulated),
}
