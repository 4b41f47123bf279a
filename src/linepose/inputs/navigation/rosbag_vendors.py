"""What fixes and attitudes of a bag say, whichever driver's message holds them, the usual kinds first."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
from scipy.spatial.transform import Rotation

from linepose.arrays import Floats
from linepose.inputs.navigation.rosbag_axes import quaternion_of
from linepose.inputs.navigation.rosbag_messages import topics_of

FIX_KINDS: Final = (
    ("sensor_msgs/msg/NavSatFix",),
    ("gps_common/msg/GPSFix", "gps_msgs/msg/GPSFix"),
    ("sbg_driver/msg/SbgEkfNav",),
)
IMU_KINDS: Final = (("sensor_msgs/msg/Imu",), ("sbg_driver/msg/SbgEkfEuler",))
SBG: Final = "sbg_driver/msg/"
_NO_FIX: Final = -1
_UNKNOWN_COVARIANCE: Final = 0


@dataclass(frozen=True)
class Fix:
    """Latitude, longitude (deg), ellipsoidal height (m), and covariance (3, 3), None if unknown.

    The covariance is in east, north, up; SBG's in the axes that its driver writes.
    """

    geodetic: tuple[float, float, float]
    covariance: Floats | None


@dataclass(frozen=True)
class Attitude:
    """Quaternion x, y, z, w in the axes of the bag, and covariance (3, 3): of the orientation, SBG's of its angles."""

    quaternion: Sequence[float] | Floats
    covariance: Floats


def kinds_of(bag: Any, groups: Sequence[Sequence[str]], topic: str | None) -> list[str]:
    """The kinds of message that are looked for: of the topic that is named, else the first that the bag has."""
    if topic is None:
        return list(next((group for group in groups if topics_of(bag, group)), groups[0]))
    everything = [kind for group in groups for kind in group]
    return list(next((group for group in groups if topic in topics_of(bag, group)), everything))


def fix_of(message: Any) -> Fix | None:
    """The position of a message, None where it says that it has none."""
    if hasattr(message, "undulation"):  # SBG
        return _sbg_fix(message)
    if message.status.status == _NO_FIX:
        return None
    known = message.position_covariance_type != _UNKNOWN_COVARIANCE
    covariance = np.asarray(message.position_covariance, dtype=float).reshape(3, 3) if known else None
    return Fix((message.latitude, message.longitude, message.altitude), covariance)


def attitude_of(message: Any) -> Attitude | None:
    """The attitude of a message, None where it says that it is not valid."""
    if not hasattr(message, "angle"):
        covariance = np.asarray(message.orientation_covariance, dtype=float).reshape(3, 3)
        return Attitude(quaternion_of(message.orientation), covariance)
    if not (message.status.attitude_valid and message.status.heading_valid):
        return None
    angle, sigma = message.angle, message.accuracy
    quaternion = Rotation.from_euler("ZYX", [angle.z, angle.y, angle.x]).as_quat()
    return Attitude(quaternion, np.diag(np.square([sigma.x, sigma.y, sigma.z])))


def _sbg_fix(message: Any) -> Fix | None:
    if not message.status.position_valid:
        return None
    place = getattr(message, "position", None)  # latitude, longitude, altitude in releases before 3
    latitude, longitude, altitude = (
        (message.latitude, message.longitude, message.altitude) if place is None else (place.x, place.y, place.z)
    )
    sigma = message.position_accuracy
    return Fix((latitude, longitude, altitude + message.undulation), np.diag(np.square([sigma.x, sigma.y, sigma.z])))
