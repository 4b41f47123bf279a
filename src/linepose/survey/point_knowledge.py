"""What is known of a point beside its measurements, and the table of it on disk."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa

from linepose.arrays import Floats
from linepose.tables import flags, floats, optional_floats, texts

_INDICES: Final = tuple((i, j) for i in range(3) for j in range(i, 3))
POSITION: Final = ("north_m", "east_m", "down_m")
INFORMATION: Final = tuple(f"information_{'ned'[i]}{'ned'[j]}_per_m2" for i, j in _INDICES)
KNOWN_POINTS: Final = pa.schema(
    [*texts("point"), *floats(*POSITION, *INFORMATION), *flags("shared"), *optional_floats("shift_sigma_m")]
)


@dataclass(frozen=True)
class PointKnowledge:
    """position_m (3,) north, east, down as the survey's positions are, and its information (3, 3) (1/m^2).

    shared: whether its height errs by what all such points have in common, of sigma shift_sigma_m.
    """

    position_m: Floats
    information: Floats
    shared: bool = False
    shift_sigma_m: float | None = None


def knowledge_table(known: Mapping[str, PointKnowledge]) -> pd.DataFrame:
    """One row a point; columns as in `KNOWN_POINTS`."""
    rows = [
        [name, *one.position_m, *(one.information[i, j] for i, j in _INDICES), one.shared, one.shift_sigma_m]
        for name, one in known.items()
    ]
    table = pd.DataFrame(rows, columns=KNOWN_POINTS.names)
    return table.astype({"shift_sigma_m": float})


def knowledge_from_table(table: pd.DataFrame) -> dict[str, PointKnowledge]:
    """The inverse of `knowledge_table`."""
    known = {}
    for _, row in table.iterrows():
        information = np.zeros((3, 3))
        for name, (i, j) in zip(INFORMATION, _INDICES, strict=True):
            information[i, j] = information[j, i] = row[name]
        shift = None if pd.isna(row["shift_sigma_m"]) else float(row["shift_sigma_m"])
        position = row[list(POSITION)].to_numpy(dtype=float)
        known[str(row["point"])] = PointKnowledge(position, information, bool(row["shared"]), shift)
    return known


def arrays_of(
    known: Mapping[str, PointKnowledge], names: Sequence[str], origin_m: Floats
) -> tuple[Floats, Floats, Floats, float | None]:
    """Positions (M, 3) from an origin, information (M, 3, 3), shifts (M,) of points by name, and the shift's sigma."""
    position, information, shifts = np.zeros((len(names), 3)), np.zeros((len(names), 3, 3)), np.zeros(len(names))
    sigma = None
    for row, name in enumerate(names):
        if name in known:
            one = known[name]
            position[row], information[row] = one.position_m - origin_m, one.information
            shifts[row], sigma = float(one.shared), one.shift_sigma_m if one.shared else sigma
    return position, information, shifts, sigma
