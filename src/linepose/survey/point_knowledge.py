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
BOARD: Final = ("board_x_m", "board_y_m", "board_z_m")
KNOWN_POINTS: Final = pa.schema(
    [
        *texts("point"),
        *floats(*POSITION, *INFORMATION),
        *flags("shared"),
        *optional_floats("shift_sigma_m", *BOARD, "board_sigma_m"),
    ]
)


_OFF_BOARD: Final = (np.nan, np.nan, np.nan)


@dataclass(frozen=True)
class PointKnowledge:
    """position_m (3,) north, east, down as the survey's positions are, and its information (3, 3) (1/m^2).

    shared: whether its height errs by what all such points have in common, of sigma shift_sigma_m.
    board_m (3,): where it lies in the target's own frame, each coordinate known to board_sigma_m, if it was measured.
    """

    position_m: Floats
    information: Floats
    shared: bool = False
    shift_sigma_m: float | None = None
    board_m: Floats | None = None
    board_sigma_m: float | None = None


def knowledge_table(known: Mapping[str, PointKnowledge]) -> pd.DataFrame:
    """One row a point; columns as in `KNOWN_POINTS`."""
    rows = [
        [
            name,
            *one.position_m,
            *(one.information[i, j] for i, j in _INDICES),
            one.shared,
            one.shift_sigma_m,
            *(_OFF_BOARD if one.board_m is None else one.board_m),
            one.board_sigma_m,
        ]
        for name, one in known.items()
    ]
    table = pd.DataFrame(rows, columns=KNOWN_POINTS.names)
    return table.astype({"shift_sigma_m": float, "board_sigma_m": float})


def knowledge_from_table(table: pd.DataFrame) -> dict[str, PointKnowledge]:
    """The inverse of `knowledge_table`."""
    known = {}
    for _, row in table.iterrows():
        information = np.zeros((3, 3))
        for name, (i, j) in zip(INFORMATION, _INDICES, strict=True):
            information[i, j] = information[j, i] = row[name]
        board = row[list(BOARD)].to_numpy(dtype=float)
        known[str(row["point"])] = PointKnowledge(
            row[list(POSITION)].to_numpy(dtype=float),
            information,
            bool(row["shared"]),
            _or_none(row["shift_sigma_m"]),
            None if np.isnan(board).any() else board,
            _or_none(row["board_sigma_m"]),
        )
    return known


def _or_none(value: float) -> float | None:
    return None if pd.isna(value) else float(value)


def board_of(known: Mapping[str, PointKnowledge], names: Sequence[str]) -> tuple[Floats, float]:
    """Places (M, 3) of points by name in the target's own frame, NaN where they are not known, and their sigma (m)."""
    board, sigma = np.full((len(names), 3), np.nan), 1.0
    for row, name in enumerate(names):
        one = known.get(name)
        if one is not None and one.board_m is not None and one.board_sigma_m is not None:
            board[row], sigma = one.board_m, one.board_sigma_m
    return board, sigma


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
