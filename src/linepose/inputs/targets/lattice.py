"""Which candidates are neighbours: a lattice grown from cell to cell.

Each step is predicted from the step before it, so shear, perspective and the bends of a turning vehicle do no harm.
Lengths are taken in the mean candidate's own stretch, in which the board's rows and columns stand almost square.
"""

from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.inputs.targets.ring_board import RingBoard
from linepose.inputs.targets.targets import Targets

_SHORTEST: Final = 0.70  # of a step, times the shortest spacing
_LONGEST: Final = 1.45  # times the longest
_LEAST_SINE: Final = 0.80  # between the two kinds of steps
_REACH: Final = 0.25  # of a step: how far from its predicted place a candidate may be
_STEPS: Final = ((1, 0), (0, 1), (-1, 0), (0, -1))

Cells = dict[int, tuple[int, int]]


def grow_lattice(targets: Targets, board: RingBoard) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Indices (n,) of the candidates in the largest lattice, and their cells (n, 2), whose smallest are 0."""
    best: Cells = {}
    least = np.inf
    place = targets.centre @ np.linalg.inv(_stretch(targets)).T if len(targets.centre) else targets.centre
    for start in range(len(place)):
        for across, along in _steps_from(place, start, board):
            cells, error = _grown(place, start, across, along)
            if _fits_board(cells, board) and (len(cells), -error) > (len(best), -least):
                best, least = cells, error
    index = np.array(sorted(best), dtype=np.int64)
    cell = np.array([best[int(one)] for one in index], dtype=np.int64).reshape(-1, 2)
    return index, cell - cell.min(axis=0) if len(cell) else cell


def _stretch(targets: Targets) -> Floats:
    """Matrix (2, 2) from hole radii to pixels and lines, from the median candidate by area."""
    area = np.linalg.det(targets.covariance)
    middle = np.argsort(area, kind="stable")[len(area) // 2]
    return 2 * np.linalg.cholesky(targets.covariance[middle])


def _steps_from(place: Floats, start: int, board: RingBoard) -> list[tuple[Floats, Floats]]:
    """Pairs of steps of about the right lengths, about perpendicular, from one candidate to two others."""
    step = place - place[start]
    length = np.linalg.norm(step, axis=1)
    shortest = _SHORTEST * board.shortest_spacing_m / board.hole_radius_m
    longest = _LONGEST * board.longest_spacing_m / board.hole_radius_m
    near = np.flatnonzero((length > shortest) & (length < longest))
    pairs = []
    for first in near:
        for second in near:
            cross = step[first, 0] * step[second, 1] - step[first, 1] * step[second, 0]
            if cross > _LEAST_SINE * length[first] * length[second]:
                pairs.append((step[first], step[second]))
    return pairs


def _fits_board(cells: Cells, board: RingBoard) -> bool:
    extent = np.ptp(np.array(list(cells.values())), axis=0) + 1
    sides = sorted([board.n_rows, board.n_columns])
    return int(extent.min()) <= sides[0] and int(extent.max()) <= sides[1]


def _grown(place: Floats, start: int, across: Floats, along: Floats) -> tuple[Cells, float]:
    """Cells of all candidates that are reached step by step, and the sum of what the steps were off, in steps."""
    cells: Cells = {start: (0, 0)}
    taken = {(0, 0)}
    error = 0.0
    waiting = [(start, np.stack([across, along]))]
    while waiting:
        here, basis = waiting.pop(0)
        for i, j in _STEPS:
            cell = (cells[here][0] + i, cells[here][1] + j)
            axis, sign = (0, i) if i else (1, j)
            expected = place[here] + sign * basis[axis]
            distance = np.linalg.norm(place - expected, axis=1)
            nearest = int(np.argmin(distance))
            if cell in taken or nearest in cells or distance[nearest] > _REACH * np.linalg.norm(basis[axis]):
                continue
            error += float(distance[nearest] / np.linalg.norm(basis[axis]))
            cells[nearest] = cell
            taken.add(cell)
            turned = basis.copy()
            turned[axis] = sign * (place[nearest] - place[here])
            waiting.append((nearest, turned))
    return cells, error
