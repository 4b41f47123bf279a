"""Where on a scan the points of the board lie: a smooth map fitted to the targets that were found."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import Floats

_FULL_MAP: Final = 10  # targets from which on perspective and a turn's bend are fitted, not only stretch and slant
_CUBIC_MAP: Final = 20  # ... and from which on a swing of the vehicle can be
_N_SQUARE, _N_CUBIC = 6, 10  # terms
_STEP_M: Final = 1e-4


@dataclass(frozen=True)
class BoardInScan:
    """Polynomial map from the board (m) to the scan (u, line): coefficients (6, 2) of 1, x, y, xy, x^2, y^2.

    Or (10, 2), of x^3, x^2 y, x y^2, y^3 too.
    """

    coefficients: Floats

    def position(self, board_m: ArrayLike) -> Floats:
        """Positions (..., 2) on the scan of board points (..., 2)."""
        return _terms(board_m, len(self.coefficients)) @ self.coefficients

    def jacobian(self, board_m: ArrayLike) -> Floats:
        """Change of the position with the board point, pixels and lines per metre; (..., 2) to (..., 2, 2)."""
        at = np.asarray(board_m, dtype=float)
        columns = [
            (self.position(at + step) - self.position(at - step)) / (2 * _STEP_M) for step in _STEP_M * np.eye(2)
        ]
        return np.stack(columns, axis=-1)


def fit_board(board_m: Floats, position: Floats) -> BoardInScan:
    """The map of least squares through targets at board points (n, 2) and scan positions (n, 2)."""
    n_terms = _N_SQUARE if len(board_m) >= _FULL_MAP else 3
    coefficients = np.zeros((_N_SQUARE, 2))
    coefficients[:n_terms] = np.linalg.lstsq(_terms(board_m, _N_SQUARE)[:, :n_terms], position, rcond=None)[0]
    return BoardInScan(coefficients)


def fit_swinging_board(board_m: Floats, position: Floats) -> BoardInScan | None:
    """The same for a vehicle that swings while it passes; None of too few targets."""
    if len(board_m) < _CUBIC_MAP:
        return None
    return BoardInScan(np.asarray(np.linalg.lstsq(_terms(board_m, _N_CUBIC), position, rcond=None)[0], dtype=float))


def _terms(board_m: ArrayLike, n_terms: int) -> Floats:
    x, y = np.moveaxis(np.asarray(board_m, dtype=float), -1, 0)
    terms = [np.ones_like(x), x, y, x * y, x * x, y * y]
    if n_terms == _N_CUBIC:
        terms += [x * x * x, x * x * y, x * y * y, y * y * y]
    return np.stack(terms, axis=-1)
