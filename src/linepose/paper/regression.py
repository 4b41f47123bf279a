"""The regression: every published number beside the obtained one, judged by what is declared of it."""

from collections.abc import Mapping, Sequence
from typing import Any, Final

import pandas as pd
import pyarrow as pa

from linepose.errors import EstimationError, InputError
from linepose.paper.declarations import PLACE, Declarations, Expected, NumberSetName
from linepose.paper.number import Number, Published, Results
from linepose.paper.number_sets import NUMBER_SETS
from linepose.paper.stage_numbers import shrimp_hand_measured_numbers
from linepose.tables import flags, floats, optional_floats, texts

REGRESSION: Final = pa.schema(
    [
        *texts("quantity"),
        *floats("published", "obtained", "tolerance"),
        *flags("passed"),
        *optional_floats("expected", "expected_tolerance"),
        *texts("note"),
    ]
)
_NONE: Final = float("nan")  # of a number that is not declared to deviate


def obtained_numbers(
    published: Published, results: Mapping[str, Results], platforms: Mapping[str, NumberSetName]
) -> list[Number]:
    """Every number that results are held against: the Shrimp's hand-measured ones, then those of each platform.

    `platforms` names the set of numbers of each platform, `results` has the tables that its set reads.
    """
    obtained = shrimp_hand_measured_numbers(published)
    for name, tables in results.items():
        obtained += NUMBER_SETS[platforms[name]].numbers(name, published, tables)
    return obtained


def regression_table(obtained: Sequence[Number], declarations: Declarations) -> pd.DataFrame:
    """The numbers with their tolerances and whether they passed; columns as in `REGRESSION`.

    A number passes within the tolerance of the published one. One with a declared deviation passes within the tolerance
    of the value that is expected instead, and nowhere else: also where it is reproduced after all. Raises InputError
    for a number without a tolerance, and for a deviation declared of a number that these platforms do not have.
    """
    quantities = {number.quantity for number in obtained}
    run = {_platform(quantity) for quantity in quantities}
    expected = declarations.expected
    for name in expected:
        if name not in quantities and _platform(name) in run:
            raise InputError(f"{PLACE}: deviations", name, "a number of the regression", "correct or remove it")
    return pd.DataFrame([_judged(number, declarations, expected) for number in obtained], columns=REGRESSION.names)


def check_passed(regression: pd.DataFrame) -> None:
    """Raise EstimationError naming every number that did not pass."""
    failed = regression[~regression["passed"]]
    if len(failed):
        told = "; ".join(_told(row) for row in failed.itertuples())
        raise EstimationError(f"{len(failed)} of {len(regression)} published numbers are not reproduced: {told}")


def _judged(number: Number, declarations: Declarations, expected: Mapping[str, tuple[Expected, str]]) -> dict[str, Any]:
    group = declarations.tolerance_of(number.quantity)
    tolerance = group.absolute + group.relative * abs(number.published) + group.sigmas * number.sigma
    row = {
        "quantity": number.quantity,
        "published": float(number.published),
        "obtained": float(number.obtained),
        "tolerance": tolerance,
    }
    if number.quantity not in expected:
        passed = abs(number.obtained - number.published) <= tolerance
        return row | {"passed": passed, "expected": _NONE, "expected_tolerance": _NONE, "note": group.note}
    instead, reason = expected[number.quantity]
    return row | {
        "passed": abs(number.obtained - instead.expected) <= instead.tolerance,
        "expected": instead.expected,
        "expected_tolerance": instead.tolerance,
        "note": reason,
    }


def _platform(quantity: str) -> str:
    return quantity.split(", ", 1)[0]


def _told(row: Any) -> str:
    told = f"{row.quantity}: published {row.published:g}, obtained {row.obtained:.6g}"
    if pd.isna(row.expected):
        return f"{told}, tolerance {row.tolerance:.2g}"
    return f"{told}, declared to be {row.expected:g} instead, tolerance {row.expected_tolerance:.2g}"
