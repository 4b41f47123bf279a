"""The map that places go to: easting, northing, height of a projected system, or of local coordinates."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.inputs.local_frame import MAP_FRAME
from linepose.output.exports.map_frame import MapFrame
from linepose.output.exports.points import frame_of
from linepose.pipeline.calibration import Calibration
from linepose.tables import read_table

_EAST_NORTH_UP: Final = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
_STEP_M: Final = 1.0


@dataclass(frozen=True)
class SurveyMap:
    """Where a survey lies: on the map of `frame`, or, without one, in coordinates of its own."""

    frame: MapFrame | None

    @property
    def crs(self) -> str | None:
        """Name of the projected system; None for local coordinates."""
        return None if self.frame is None else self.frame.name

    @property
    def is_tangent(self) -> bool:
        """Whether north, east, down are of a plane that touches the Earth, and not the map's own."""
        return self.frame is not None and self.frame.origin is not None

    def places(self, north_east_down: ArrayLike) -> Floats:
        """Easting, northing, height (m) of places north, east, down (m); (K, 3) to (K, 3)."""
        if self.frame is None:
            return np.asarray(north_east_down, dtype=float) @ _EAST_NORTH_UP.T
        return self.frame.places(north_east_down)

    def jacobian(self, north_east_down: ArrayLike) -> Floats:
        """Derivatives (3, 3) of easting, northing, height by north, east, down at a place (3,)."""
        if not self.is_tangent:
            return _EAST_NORTH_UP.copy()
        steps = np.asarray(north_east_down, dtype=float) + _STEP_M * np.vstack([np.eye(3), -np.eye(3)])
        on_map = self.places(steps)
        return (on_map[:3] - on_map[3:]).T / (2 * _STEP_M)


def survey_map(calibration: Calibration) -> SurveyMap:
    """The map of a platform's survey: what its file says, its navigation log, or local coordinates."""
    section = calibration.platform_file.map_frame
    path = calibration.results.path("map_frame")
    if section is None and not (path.is_file() and len(read_table(path, MAP_FRAME))):
        return SurveyMap(None)
    return SurveyMap(frame_of(calibration))
