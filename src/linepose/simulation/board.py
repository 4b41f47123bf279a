"""Where the board stands in a simulated survey, and what is printed on it."""

from functools import lru_cache
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.geometry import rotations
from linepose.simulation.settings import BoardSettings
from linepose.survey.pattern import board_points
from linepose.survey.targets.registry import Target
from linepose.survey.targets.rings import RingsSection

PRINT_CELL_M: Final = 0.0005  # of a picture of the print, far below what a pixel sees


def target_of(settings: BoardSettings) -> Target:
    """What stands in the world: the paper's board where nothing else is told."""
    return RingsSection() if settings.target is None else settings.target


def points_on_board(settings: BoardSettings) -> Floats:
    """Points of the target in the board frame; (M, 3) in m."""
    return board_points() if settings.target is None else settings.target.points()


def world_points(settings: BoardSettings) -> Floats:
    """Points of the target in the world; (M, 3) in m from the survey origin."""
    turned = points_on_board(settings) @ rotations.matrix_from_euler(settings.euler_rad).T
    return turned + np.asarray(settings.position_m)


@lru_cache(maxsize=2)
def print_of(settings: BoardSettings) -> NDArray[np.bool_]:
    """Which cells of `PRINT_CELL_M` of a target's field are white, (H, W); (0, 0) for the paper's board."""
    artwork = None if settings.target is None else settings.target.artwork()
    return np.zeros((0, 0), dtype=np.bool_) if artwork is None else artwork.picture(PRINT_CELL_M)
