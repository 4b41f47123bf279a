"""Writers of navigation logs in the formats that the readers take, by the formats' own descriptions."""

import numpy as np
import pandas as pd
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_typestore
from scipy.spatial.transform import Rotation

NED_FROM_ENU = np.array([[0, 1, 0], [1, 0, 0], [0, 0, -1]])
FLU_FROM_FRD = np.diag([1, -1, -1])


def write_sbet(path, drive, wander_rad=0.03):
    """An SBET trajectory: the platform's heading is counted from the wander frame."""
    zeros = np.zeros(len(drive.time_us))
    euler, place = drive.true_euler, drive.geodetic
    columns = [
        drive.second, np.deg2rad(place[:, 0]), np.deg2rad(place[:, 1]), place[:, 2], zeros, zeros, zeros,
        euler[:, 0], euler[:, 1], euler[:, 2] + wander_rad, zeros + wander_rad, *[zeros] * 6,
    ]  # fmt: skip
    np.stack(columns, axis=-1).astype("<f8").tofile(path)


def write_rms(path, drive):
    """Its RMS file: angles in minutes of arc."""
    sigma = np.sqrt(np.diagonal(drive.covariance, axis1=1, axis2=2))
    zeros = np.zeros((len(sigma), 3))
    table = np.hstack([drive.second[:, None], sigma[:, :3], zeros, np.rad2deg(sigma[:, 3:]) * 60])
    table.astype("<f8").tofile(path)


def write_location(path, drive, use=5):
    """Resonon's location file: GPS seconds, roll positive with the right wing up."""
    euler, place = drive.true_euler, drive.geodetic
    rows = zip(drive.gps_us, euler, place, strict=True)
    rest = f"0 0 {use} 12"
    lines = [
        f"{time / 1e6:.6f} {-roll:.15g} {pitch:.15g} {yaw:.15g} {place[1]:.15g} {place[0]:.15g} {place[2]:.9f} {rest}"
        for time, (roll, pitch, yaw), place in rows
    ]
    path.write_text("\n".join(lines) + "\n")


def geodetic_table(drive):
    """Latitude, longitude (deg), height (m), angles (deg) and sigmas (m, deg), times as Unix seconds."""
    sigma = np.sqrt(np.diagonal(drive.covariance, axis1=1, axis2=2))
    names = ["lat", "lon", "h", "roll", "pitch", "heading", "sn", "se", "sd", "sr", "sp", "sh"]
    degrees = np.rad2deg(np.hstack([drive.true_euler, sigma[:, 3:]]))
    table = pd.DataFrame(np.hstack([drive.geodetic, degrees[:, :3], sigma[:, :3], degrees[:, 3:]]), columns=names)
    return table.assign(t=drive.time_us / 1e6)


def fixed_axes_covariance(euler_rad, covariance, matrix):
    """Covariances of east, north, up and small turns about them, of north, east, down, roll, pitch, yaw.

    The turns that a change of each angle makes, by differences of rotations: `matrix` are those of `euler_rad`.
    """
    by_angle = np.empty((len(euler_rad), 3, 3))
    step = 1e-6
    for axis in range(3):
        moved = []
        for sign in (1, -1):
            changed = euler_rad.copy()
            changed[:, axis] += sign * step
            moved.append(Rotation.from_euler("ZYX", changed[:, ::-1]))
        still = Rotation.from_matrix(matrix)
        turn = ((moved[0] * still.inv()).as_rotvec() - (moved[1] * still.inv()).as_rotvec()) / (2 * step)
        by_angle[:, :, axis] = turn
    both = np.zeros((len(euler_rad), 6, 6))
    both[:, :3, :3] = NED_FROM_ENU.T
    both[:, 3:, 3:] = NED_FROM_ENU.T @ by_angle
    return both @ covariance @ np.swapaxes(both, -1, -2)


def enu_flu_quaternion(matrix):
    """Quaternions x, y, z, w of bodies x forward, y left, z up in east, north, up."""
    return Rotation.from_matrix(NED_FROM_ENU.T @ matrix @ FLU_FROM_FRD).as_quat()


class Bag:
    """A bag of ROS 1 or 2 that is written message by message."""

    def __init__(self, path, ros):
        self.ros = ros
        self.store = get_typestore(Stores.ROS1_NOETIC if ros == 1 else Stores.ROS2_HUMBLE)
        self.writer = Writer1(path) if ros == 1 else Writer2(path, version=9)
        self.connections = {}

    def __enter__(self):
        self.writer.open()
        return self

    def __exit__(self, *_):
        self.writer.close()

    def type(self, name):
        return self.store.types[name]

    def header(self, time_us):
        values = {
            "stamp": self.type("builtin_interfaces/msg/Time")(
                int(time_us // 1_000_000), int(time_us % 1_000_000) * 1000
            )
        }
        values |= {"seq": 0} if self.ros == 1 else {}
        return self.type("std_msgs/msg/Header")(frame_id="map", **values)

    def write(self, topic, kind, time_us, message):
        if topic not in self.connections:
            self.connections[topic] = self.writer.add_connection(topic, kind, typestore=self.store)
        serialize = self.store.serialize_ros1 if self.ros == 1 else self.store.serialize_cdr
        self.writer.write(self.connections[topic], int(time_us) * 1000, bytes(serialize(message, kind)))

    def odometry(self, topic, time_us, position_enu, quaternion, covariance):
        point = self.type("geometry_msgs/msg/Point")(*(float(one) for one in position_enu))
        turn = self.type("geometry_msgs/msg/Quaternion")(*(float(one) for one in quaternion))
        pose = self.type("geometry_msgs/msg/Pose")(point, turn)
        zero = self.type("geometry_msgs/msg/Vector3")(0.0, 0.0, 0.0)
        twist = self.type("geometry_msgs/msg/Twist")(zero, zero)
        message = self.type("nav_msgs/msg/Odometry")(
            self.header(time_us),
            "base_link",
            self.type("geometry_msgs/msg/PoseWithCovariance")(pose, np.asarray(covariance, dtype=float).ravel()),
            self.type("geometry_msgs/msg/TwistWithCovariance")(twist, np.zeros(36)),
        )
        self.write(topic, "nav_msgs/msg/Odometry", time_us, message)

    def pose(self, topic, time_us, position, quaternion, covariance=None):
        point = self.type("geometry_msgs/msg/Point")(*(float(one) for one in position))
        turn = self.type("geometry_msgs/msg/Quaternion")(*(float(one) for one in quaternion))
        pose, kind = self.type("geometry_msgs/msg/Pose")(point, turn), "geometry_msgs/msg/PoseStamped"
        if covariance is not None:
            values = np.asarray(covariance, dtype=float).ravel()
            pose = self.type("geometry_msgs/msg/PoseWithCovariance")(pose, values)
            kind = "geometry_msgs/msg/PoseWithCovarianceStamped"
        self.write(topic, kind, time_us, self.type(kind)(self.header(time_us), pose))

    def fix(self, topic, time_us, geodetic, covariance_enu, status=0, kind=3):
        message = self.type("sensor_msgs/msg/NavSatFix")(
            self.header(time_us),
            self.type("sensor_msgs/msg/NavSatStatus")(status, 1),
            *(float(one) for one in geodetic),
            np.asarray(covariance_enu, dtype=float).ravel(),
            kind,
        )
        self.write(topic, "sensor_msgs/msg/NavSatFix", time_us, message)

    def imu(self, topic, time_us, quaternion, covariance):
        zero = self.type("geometry_msgs/msg/Vector3")(0.0, 0.0, 0.0)
        turn = self.type("geometry_msgs/msg/Quaternion")(*(float(one) for one in quaternion))
        covariance = np.asarray(covariance, dtype=float).ravel()
        message = self.type("sensor_msgs/msg/Imu")(
            self.header(time_us), turn, covariance, zero, np.zeros(9), zero, np.zeros(9)
        )
        self.write(topic, "sensor_msgs/msg/Imu", time_us, message)
