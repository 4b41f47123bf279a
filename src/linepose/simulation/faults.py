"""Planted faults, as arrays over observations and points, and over time."""

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linepose.arrays import Floats
from linepose.simulation.board import points_on_board
from linepose.simulation.settings import SimulationSettings
from linepose.simulation.trajectory import schedule


def clock_offsets_s(settings: SimulationSettings) -> Floats:
    """What is added to the time stamps of each observation's scan; (N,) in s."""
    offsets = np.zeros(len(settings.passes))
    for fault in settings.faults:
        offsets[fault.observation - 1] += fault.clock_offset_s
    return offsets


def missing(settings: SimulationSettings) -> NDArray[np.bool_]:
    """Which points are covered, by their true id; (N, M)."""
    mask = np.zeros((len(settings.passes), len(points_on_board(settings.board))), dtype=bool)
    for fault in settings.faults:
        mask[fault.observation - 1, list(fault.missing_points)] = True
    return mask


def id_of_label(settings: SimulationSettings) -> NDArray[np.int64]:
    """The true id of the point that each label names; (N, M), its own but for swapped points."""
    ids = np.tile(np.arange(len(points_on_board(settings.board))), (len(settings.passes), 1))
    for fault in settings.faults:
        for first, second in fault.swapped_points:
            ids[fault.observation - 1, [first, second]] = ids[fault.observation - 1, [second, first]]
    return ids


def jumps(settings: SimulationSettings, time_s: ArrayLike) -> Floats:
    """What the navigation solution's jumps add to it; times (...) to (..., 6), m and rad."""
    time = np.asarray(time_s, dtype=float)
    times = schedule(settings)
    added = np.zeros((*time.shape, 6))
    for fault in settings.faults:
        k = fault.observation - 1
        during = (time >= times.middle_s[k]) & (time <= times.end_s[k])
        added[during] += [*fault.jump_position_m, *fault.jump_euler_rad]
    return added
