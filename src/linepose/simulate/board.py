"""Where the board stands in a simulated survey."""

import numpy as np

from linepose import rotations
from linepose.pattern import board_points
from linepose.rotations import Floats
from linepose.simulate.settings import BoardSettings


def world_points(settings: BoardSettings) -> Floats:
    """Centres of the targets in the world; (15, 3) in m from the survey origin."""
    return board_points() @ rotations.matrix_from_euler(settings.euler_rad).T + np.asarray(settings.position_m)
