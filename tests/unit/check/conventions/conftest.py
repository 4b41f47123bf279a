"""A survey without faults, its navigation on the clock's command, and the hand measurement."""

from dataclasses import dataclass
from pathlib import Path

import pytest

from linepose.check.conventions.recording import Recording
from linepose.config.platform import load_platform
from linepose.errors import InputError
from linepose.simulation.survey import simulate_survey, without_faults

PLATFORMS = Path(__file__).parents[4] / "config" / "platforms"


@dataclass(frozen=True)
class Recorded:
    """What `examine` takes: a recording by clock shift, possible only at the shift that is right."""

    recording: Recording
    right_shift_s: float = 0.0

    def __call__(self, shift_s: float) -> Recording:
        if shift_s != self.right_shift_s:
            raise InputError("observation 1, point 0", "time 0", "a time within the navigation log", "correct it")
        return self.recording


@pytest.fixture(scope="session", params=["ladybird-sim", "shrimp-sim"])
def recording(request) -> Recording:
    platform = load_platform(PLATFORMS, request.param)
    assert platform.simulation is not None
    survey, _ = simulate_survey(platform.intrinsics(), without_faults(platform.simulation), seed=5)
    return Recording(survey.select(survey.number[:12].tolist()), platform.intrinsics(), platform.start_pose())
