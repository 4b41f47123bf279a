"""Where the board stands in a simulated survey."""

import numpy as np

from linepose.arrays import Floats
from linepose.geometry import rotations
from linepose.simulation.settings import BoardSettings
from linepose.survey.pattern import board_points


def world_points(settings: BoardSettings) -> Floats:
    """Centres of the targets in the world; (15, 3) in m from the survey origin."""
    return board_points() @ rotations.matrix_from_euler(settings.euler_rad).T + np.asarray(settings.position_m)
