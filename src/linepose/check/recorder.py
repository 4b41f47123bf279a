"""What the convention doctor looks at: a platform's observations, read again where clock or settings differ."""

from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from linepose.check.conventions.recording import Recording
from linepose.config.platform import Platform
from linepose.errors import InputError
from linepose.inputs.source import ScansSection
from linepose.pipeline.load import with_navigation
from linepose.survey.observations import survey_from_table


@dataclass(frozen=True)
class Recorder:
    """A platform, the folder of its files, and two tables: its points as they were read, and with their body poses.

    `points` is None of a simulated platform that has no files yet.
    """

    platform: Platform
    folder: Path
    points: pd.DataFrame | None
    observations: pd.DataFrame

    def at(self, shift_s: float) -> Recording:
        """The recording with the camera's clock moved by so many seconds; raises InputError where it cannot be."""
        return self._recording(self.platform, shift_s)

    def of(self, platform: Platform) -> Recording:
        """The recording of the same files with other settings; raises InputError where it cannot be had."""
        mine, other = self.platform.source, platform.source
        shift_s = 0.0
        if isinstance(mine, ScansSection) and isinstance(other, ScansSection):
            shift_s = other.time_offset_s - mine.time_offset_s
        return self._recording(platform, shift_s)

    def _recording(self, platform: Platform, shift_s: float) -> Recording:
        return Recording(
            survey_from_table(self._table(platform, shift_s)), platform.intrinsics(), platform.start_pose()
        )

    def _table(self, platform: Platform, shift_s: float) -> pd.DataFrame:
        if not shift_s and (platform.navigation, platform.source) == (self.platform.navigation, self.platform.source):
            return self.observations
        if self.points is None or (shift_s and not isinstance(platform.source, ScansSection)):
            raise InputError("the platform", "no navigation log", "one that can be read again", "go on without")
        points = self.points.assign(time_us=self.points["time_us"] + round(shift_s * 1e6))
        return with_navigation(points, platform, self.folder)
