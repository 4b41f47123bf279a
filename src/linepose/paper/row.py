"""One row of the regression: a published number beside the obtained one."""

from typing import Any, Final

import pyarrow as pa

from linepose.tables import flags, floats, texts

REGRESSION: Final = pa.schema(
    [
        *texts("quantity"),
        *floats("published", "obtained", "tolerance"),
        *flags("passed", "known_deviation"),
        *texts("note"),
    ]
)


def row(
    quantity: str, published: float, obtained: float, tolerance: float, note: str = "", known_deviation: bool = False
) -> dict[str, Any]:
    """One number: published, obtained, and whether they differ by no more than the tolerance.

    `known_deviation` marks a published number that does not follow from the data; `note` says why.
    """
    return {
        "quantity": quantity,
        "published": float(published),
        "obtained": float(obtained),
        "tolerance": float(tolerance),
        "passed": bool(abs(obtained - published) <= tolerance),
        "known_deviation": known_deviation,
        "note": note,
    }
