"""What the check tells that it has read: in the units and about the axes of the devices."""

import numpy as np
import pytest

from linepose.check.contents import of_log
from linepose.inputs.navigation import Poses, geodetic_record
from linepose.inputs.navigation.record import corrected_record
from linepose.inputs.navigation.table import TableSection

FIRST = "latitude 50.0000000, longitude 8.0000000 deg, height 100.000 m, roll 1.000, pitch 2.000, yaw 30.000 deg"


def record(**keys):
    """Two poses at 50, 8 deg: 1 deg west of the middle of UTM's zone, where its north is 0.77 deg off."""
    place = np.array([[50.0, 8.0, 100.0], [50.001, 8.0, 100.0]])
    poses = Poses(np.array([0, 1]) + 1_700_000_000_000_000, place, np.radians([[1.0, 2.0, 30.0]] * 2), "log")
    columns = {"time": "t", "position": ["a", "b", "c"], "attitude": ["d", "e", "f"]}
    return geodetic_record([poses], [], TableSection(format="table", file="log", columns=columns, **keys))


@pytest.mark.parametrize("keys", [{}, {"frame": "projected"}, {"frame": "tangent", "origin": [49.0, 5.0, 0.0]}])
def test_first_pose_is_told_as_the_device_showed_it(keys):
    read = record(**keys)
    assert keys == {} or abs(np.degrees(read.log.euler_rad[0, 2]) - 30.0) > 0.5
    assert of_log(read).found.endswith(f"; the first: {FIRST}")


def test_corrections_that_were_made_are_told():
    read = corrected_record(record(frame="projected"), ["yaw_plus_90"])
    assert of_log(read, ["yaw_plus_90"]).found.endswith(
        f"{FIRST.replace('yaw 30', 'yaw 120')}, corrected by navigation.corrections"
    )
