"""The A1 calibration pattern of section 3.2: 3 rows of 5 targets, each a dot within a ring.

Board frame: origin at the centre, x along the rows of five, y from one row to the next, z away from the viewer.
Point ids run to and fro: 0-4 along x, 5-9 back in the second row, 10-14 along x again in the third.
"""

from typing import Final

import numpy as np

from linepose.arrays import Floats

N_COLUMNS: Final = 5
N_ROWS: Final = 3
N_POINTS: Final = N_COLUMNS * N_ROWS
COLUMN_SPACING_M: Final = 0.1511
ROW_SPACING_M: Final = 0.1669
SHEET_M: Final = (0.841, 0.594)  # A1, along x and y
PRINT_MARGIN_M: Final = 0.010  # unprinted paper along the sheet's edge
DOT_DIAMETER_M: Final = 0.010
RING_INNER_DIAMETER_M: Final = 0.075
RING_OUTER_DIAMETER_M: Final = 0.120
CORNER_MARK_CENTRE_M: Final = (-0.385, -0.262)  # beside point 0, clear of its ring
CORNER_MARK_SIDE_M: Final = 0.040


def board_points() -> Floats:
    """Centres of the targets in the board frame, by point id; (15, 3) in m."""
    return to_and_fro(N_ROWS, N_COLUMNS, ROW_SPACING_M, COLUMN_SPACING_M)


def to_and_fro(n_rows: int, n_columns: int, row_spacing_m: float, column_spacing_m: float) -> Floats:
    """Points of a grid around the origin, numbered along x in the first row and back in the next; (n, 3) in m."""
    point = np.arange(n_rows * n_columns)
    column, row = point % n_columns, point // n_columns
    column = np.where(row % 2 == 1, n_columns - 1 - column, column)
    x = (column - (n_columns - 1) / 2) * column_spacing_m
    y = (row - (n_rows - 1) / 2) * row_spacing_m
    return np.stack([x, y, np.zeros(len(point))], axis=-1)
