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
    column = np.arange(N_POINTS) % N_COLUMNS
    row = np.arange(N_POINTS) // N_COLUMNS
    column = np.where(row % 2 == 1, N_COLUMNS - 1 - column, column)
    x = (column - (N_COLUMNS - 1) / 2) * COLUMN_SPACING_M
    y = (row - (N_ROWS - 1) / 2) * ROW_SPACING_M
    return np.stack([x, y, np.zeros(N_POINTS)], axis=-1)
