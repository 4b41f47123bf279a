"""Readers of ROS bags: the usual messages, those of vendors' drivers, and transforms."""

from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from unit.bad_input.log_readers import log_reader
from unit.bad_input.reader import TIME_US, Reader, drive, written
from unit.inputs import writers
from unit.inputs.navigation.test_rosbag_vendors import DEFINITIONS, SBG_NAV, VendorBag

UPRIGHT = [0.0, 0.0, 0.0, 1.0]
INSPVA = (
    "std_msgs/Header header\nfloat64 latitude\nfloat64 longitude\nfloat64 height\n"
    "float64 roll\nfloat64 pitch\nfloat64 azimuth\nstring status"
)
VENDORS = DEFINITIONS | {"sbg_driver/msg/SbgEkfNav": SBG_NAV, "novatel_gps_msgs/msg/Inspva": INSPVA}


def _bag(write: Callable[[Any, int, int], None]) -> bytes:
    """A bag to which `write` adds what it has at each time."""

    def made(path: Path) -> None:
        with VendorBag(path, VENDORS) as bag:
            for row, time in enumerate(TIME_US):
                write(bag, row, int(time))

    return written(made, "run.bag")


def _odometry(bag: Any, row: int, time: int) -> None:
    bag.odometry("/odometry", time, [float(row), 2.0, 3.0], UPRIGHT, np.eye(6) * 1e-4)


def _pose(bag: Any, row: int, time: int) -> None:
    bag.pose("/pose", time, [float(row), 2.0, 3.0], UPRIGHT, np.eye(6) * 1e-4)


def _fixes(bag: Any, row: int, time: int) -> None:
    bag.imu("/imu", time, UPRIGHT, np.eye(3) * 1e-6)
    bag.fix("/fix", time, drive().geodetic[row], np.eye(3) * 1e-4)


def _gps_fixes(bag: Any, row: int, time: int) -> None:
    bag.imu("/imu", time, UPRIGHT, np.eye(3) * 1e-6)
    bag.gps_fix("/gps", time, drive().geodetic[row])


def _sbg(bag: Any, row: int, time: int) -> None:
    bag.sbg_euler(time, [0.02, 0.05, 0.4])
    bag.sbg_nav(time, drive().geodetic[row], is_old=False)


def _applanix(bag: Any, row: int, time: int) -> None:
    bag.gsof49(time, drive().geodetic[row], [2, 5, 40])


def _novatel(bag: Any, row: int, time: int) -> None:
    kind = "novatel_gps_msgs/msg/Inspva"
    place = (float(one) for one in drive().geodetic[row])
    message = bag.type(kind)(bag.header(time), *place, 2.0, 5.0, 40.0, "INS_SOLUTION_GOOD")
    bag.write("/inspva", kind, time, message)


def _transforms(bag: Any, row: int, time: int) -> None:
    bag.transform(time, "odom", "base_link", [row, 0, 0], UPRIGHT)


def _folder(path: Path) -> None:
    with writers.Bag(path, 2) as bag:
        for time in TIME_US:
            bag.odometry("/odometry", int(time), [1.0, 2.0, 3.0], UPRIGHT, np.eye(6) * 1e-4)


def _of_ros_2() -> dict[str, bytes]:
    with TemporaryDirectory() as folder:
        _folder(Path(folder) / "run")
        return {path.name: path.read_bytes() for path in (Path(folder) / "run").iterdir()}


def _ros_2(name: str, spoilt: str) -> Reader:
    one = log_reader(name, bytes, "run.db3", False, of=("message Odometry",), format="rosbag")
    return Reader(name, _of_ros_2, spoilt, one.read, one.holds, spoilt.endswith(".yaml"), one.of)


def bag_readers() -> list[Reader]:
    """All of them."""
    kinds: dict[str, tuple[Callable[[Any, int, int], None], tuple[str, ...]]] = {
        "odometry": (_odometry, ("Odometry",)),
        "pose": (_pose, ("PoseWithCovarianceStamped", "PoseStamped")),
        "fixes": (_fixes, ("NavSatFix", "Imu")),
        "gps fixes": (_gps_fixes, ("GPSFix",)),
        "sbg": (_sbg, ("SbgEkfNav", "SbgEkfEuler")),
        "applanix": (_applanix, ("NavigationSolutionGsof49",)),
        "novatel": (_novatel, ("INSPVA", "INSPVAX", "Inspva", "Inspvax")),
        "transforms": (_transforms, ("TFMessage", "tfMessage")),
    }
    made = []
    for name, (write, messages) in kinds.items():
        of = tuple(f"message {one}" for one in messages)
        keys = {"tf_frames": ("odom", "base_link")} if name == "transforms" else {}
        bag = lambda write=write: _bag(write)  # noqa: E731
        made.append(log_reader(f"rosbag {name}", bag, "run.bag", False, of=of, format="rosbag", **keys))
    return [*made, _ros_2("rosbag 2", "run.db3"), _ros_2("rosbag 2 metadata", "metadata.yaml")]
