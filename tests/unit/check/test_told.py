"""What readers warn of, beside what the check finds of the clocks: guesses that do not contradict each other."""

import numpy as np
import pytest

from linepose.check.clock import overlap_findings
from linepose.check.told import agreeing, readers_warnings
from linepose.inputs.gps_time import tell_lost_weeks

WEEKS_S = 1024 * 7 * 86_400
LOG_US = 1_000_000_000_000_000 + 100_000 * np.arange(100)  # in 2001: 1024 weeks later is 2021


@pytest.mark.parametrize(
    ("late_s", "is_told"),
    [
        (0, True),
        (WEEKS_S, True),
        (WEEKS_S + 7_200, True),
        (WEEKS_S + 18, True),
        (2 * WEEKS_S, True),
        (3_600, False),
        (18, False),
    ],
)
def test_lost_weeks_are_told_unless_something_else_explains_the_clocks(late_s, is_told):
    with readers_warnings() as told:
        tell_lost_weeks(int(LOG_US[0]), "log.nmea")
    clocks = overlap_findings(LOG_US[20:30] + late_s * 1_000_000, LOG_US, "navigation log", 0.0)
    assert len(told) == 1
    assert "may have lost 1024 GPS weeks" in told[0].found
    assert agreeing(told, clocks) == (told if is_told else [])


def test_other_warnings_are_told_whatever_explains_the_clocks(caplog):
    with readers_warnings() as told:
        tell_lost_weeks(int(LOG_US[0]), "log.nmea")
    (weeks,) = told
    other = type(weeks)(weeks.level, "navigation log", "log.nmea: 3 records are left out")
    clocks = overlap_findings(LOG_US[20:30] + 18_000_000, LOG_US, "navigation log", 0.0)
    assert agreeing([weeks, other], clocks) == [other]
