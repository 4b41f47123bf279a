"""Navigation format `rosbag`: bags of ROS 1 (.bag) and ROS 2 (a folder, or .db3 and .mcap files).

Odometry; else a fix (NavSatFix, GPSFix, SbgEkfNav) for the position and Imu or SbgEkfEuler for the attitude; else
NovAtel's INSPVA or INSPVAX, Applanix's GSOF 49, PoseStamped or PoseWithCovarianceStamped; or tf. After REP-103 the
world is east, north, up and the body x forward, y left, z up. Times are the headers' (Unix).
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final, Literal

from pydantic import Field, PositiveFloat

from linepose.inputs.navigation.format import GeodeticSection, NavigationFormat
from linepose.inputs.navigation.poses import Poses
from linepose.inputs.navigation.positions_between import DEFAULT_GAP_S
from linepose.inputs.navigation.record import Covariances, NavigationRecord, geodetic_record, local_record
from linepose.inputs.navigation.rosbag_axes import AttitudeAxes, OrientationCovariance
from linepose.inputs.navigation.rosbag_fixes import fixes_and_imu
from linepose.inputs.navigation.rosbag_messages import opened, topics_of
from linepose.inputs.navigation.rosbag_poses import (
    APPLANIX,
    NOVATEL,
    ODOMETRY,
    POSES,
    applanix_poses,
    novatel_poses,
    whole_poses,
)
from linepose.inputs.navigation.rosbag_transforms import transform_poses
from linepose.inputs.navigation.rosbag_vendors import FIX_KINDS, IMU_KINDS, SBG, kinds_of


class RosbagSection(GeodeticSection):
    """Keys of the format `rosbag`."""

    format: Literal["rosbag"] = Field(description="`rosbag`: a ROS 1 or ROS 2 bag.")
    odometry_topic: str | None = Field(
        None, description="Topic of nav_msgs/Odometry; if not given, the bag's only one, if it has one."
    )
    pose_topic: str | None = Field(
        None,
        description="Topic of geometry_msgs/PoseStamped or PoseWithCovarianceStamped; if not given, the bag's only "
        "one, where it has no odometry and no fixes.",
    )
    inspva_topic: str | None = Field(
        None,
        description="Topic of a NovAtel driver's INSPVA or INSPVAX; if not given, the bag's only one, where it has no "
        "odometry and no fixes.",
    )
    applanix_topic: str | None = Field(
        None,
        description="Topic of an Applanix driver's NavigationSolutionGsof49; if not given, the only one, where the bag "
        "has no odometry and no fixes.",
    )
    tf_frames: tuple[str, ...] = Field(
        (),
        description="Frames of tf from the world to the body, of which each is the parent of the next: `[map, odom, "
        "base_link]`; tf is read where they are given.",
    )
    fix_topic: str | None = Field(
        None,
        description="Topic of sensor_msgs/NavSatFix, gps_common/GPSFix or SBG's SbgEkfNav, where there is no odometry; "
        "if not given, the only one of the first of these kinds.",
    )
    imu_topic: str | None = Field(
        None,
        description="Topic of sensor_msgs/Imu with orientation, or of SBG's SbgEkfEuler, for fixes; if not given, the "
        "only one of the first of these kinds.",
    )
    attitude_axes: AttitudeAxes | None = Field(
        None,
        description="Axes of the orientation: `enu`, forward, left, up in east, north, up (REP-103), or `ned`, "
        "forward, right, down in north, east, down (VectorNav; SBG and MicroStrain by default); of odometry, poses and "
        "tf also those of the position; if not given, enu, and of SBG's own messages ned.",
    )
    orientation_covariance: OrientationCovariance = Field(
        "fixed_axes",
        description="What a bag's covariance of the orientation is of: small turns about the world's axes (REP-103), "
        "or roll, pitch, yaw, as the NovAtel driver fills it in.",
    )
    maximum_fix_gap_s: PositiveFloat = Field(
        DEFAULT_GAP_S,
        description="Longest time between two NavSatFix over which the position is interpolated (s); how many poses "
        "are left out for it is told.",
    )


def read(section: RosbagSection, folder: Path) -> NavigationRecord:
    """The record of the bags; raises InputError where they have no such topic, or more than one and none is named."""
    parts, is_geodetic = [], False
    for path in section.paths(folder):
        with opened(path) as bag:
            part, is_geodetic = _part(bag, path, section)
        parts.append(part)
    poses, covariances = [part[0] for part in parts], [part[1] for part in parts]
    return geodetic_record(poses, covariances, section) if is_geodetic else local_record(poses, covariances, section)


def _is_bag(path: Path) -> dict[str, Any] | None:
    return {} if path.suffix in {".bag", ".db3", ".mcap"} or (path / "metadata.yaml").is_file() else None


def _keys_against(section: RosbagSection, corrections: Sequence[str]) -> list[dict[str, Any]]:
    """The other `attitude_axes`; whether they move positions too depends on what the bag holds."""
    if "attitude_axes" not in corrections or not {"attitude_axes", "positions_enu"}.issuperset(corrections):
        return []
    return [{"attitude_axes": axes} for axes in ("ned", "enu") if axes != section.attitude_axes]


FORMAT: Final = NavigationFormat("rosbag", RosbagSection, read, recognise=_is_bag, keys_against=_keys_against)


def _part(bag: Any, path: Path, section: RosbagSection) -> tuple[tuple[Poses, Covariances], bool]:
    """What is read from a bag, and whether its positions are latitude, longitude, height."""
    source = _source(bag, section)
    sbg = source == "fixes" and kinds_of(bag, IMU_KINDS, section.imu_topic)[0].startswith(SBG)
    about = section.attitude_axes or ("ned" if sbg else "enu"), section.orientation_covariance
    if source == "tf":
        return transform_poses(bag, path, section.tf_frames, about[0]), False
    if source == "odometry":
        return whole_poses(bag, path, [ODOMETRY], (section.odometry_topic, "odometry_topic"), *about), False
    if source == "poses":
        return whole_poses(bag, path, POSES, (section.pose_topic, "pose_topic"), *about), False
    if source == "inspva":
        return novatel_poses(bag, path, section.inspva_topic), True
    if source == "applanix":
        return applanix_poses(bag, path, section.applanix_topic), True
    topics = section.fix_topic, section.imu_topic
    return fixes_and_imu(bag, path, topics, section.maximum_fix_gap_s, *about), True


def _source(bag: Any, section: RosbagSection) -> Literal["tf", "odometry", "poses", "inspva", "applanix", "fixes"]:
    """The messages that the keys name, else the first kind that the bag has."""
    if section.tf_frames:
        return "tf"
    if section.odometry_topic:
        return "odometry"
    if section.pose_topic:
        return "poses"
    if section.inspva_topic:
        return "inspva"
    if section.applanix_topic:
        return "applanix"
    if section.fix_topic:
        return "fixes"
    if topics_of(bag, [ODOMETRY]):
        return "odometry"
    if topics_of(bag, [kind for group in FIX_KINDS for kind in group]):
        return "fixes"
    if topics_of(bag, NOVATEL):
        return "inspva"
    if topics_of(bag, APPLANIX):
        return "applanix"
    return "poses" if topics_of(bag, POSES) else "fixes"
