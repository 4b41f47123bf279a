"""Poses of a bag from tf: a chain of frames from the world to the body, each link of which is in the bag."""

import logging
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation, Slerp

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.inputs.navigation.poses import Poses
from linepose.inputs.navigation.record import Covariances
from linepose.inputs.navigation.rosbag_axes import (
    AttitudeAxes,
    euler_of,
    known_orientations,
    position_jacobian,
    quaternion_of,
)
from linepose.inputs.navigation.rosbag_messages import stamp_us, topics_of
from linepose.inputs.navigation.usable_rows import usable_rows

TRANSFORMS: Final = ("tf2_msgs/msg/TFMessage", "tf/msg/tfMessage")
log = logging.getLogger(__name__)

Link = tuple[NDArray[np.int64], Floats, Floats]  # times (K,), translations (K, 3), quaternions (K, 4)


def transform_poses(
    bag: Any, path: Path, frames: Sequence[str], attitude_axes: AttitudeAxes
) -> tuple[Poses, Covariances]:
    """Poses of the last of the frames in the first, at the times of the link that has most of them.

    Links with fewer transforms are interpolated, and one with a single transform is static. Raises InputError where the
    bag has no such link.
    """
    links = _links(bag, path, list(pairwise(frames)))
    time_us = max((times for times, _, _ in links), key=len)
    moving = [times for times, _, _ in links if len(times) > 1]
    first, last = max(times[0] for times in moving or [time_us]), min(times[-1] for times in moving or [time_us])
    inside = (time_us >= first) & (time_us <= last)
    if not inside.all():
        log.warning("%s: %d of %d poses lie outside the other links: left out", path, np.sum(~inside), len(inside))
    time_us = time_us[inside]
    position, turn = np.zeros((len(time_us), 3)), Rotation.identity(len(time_us))
    for link in links:
        translation, rotation = _at(link, time_us)
        position, turn = position + turn.apply(translation), turn * rotation
    world, place = position_jacobian(attitude_axes), f"{path}, tf {' to '.join(frames)}"
    poses = Poses(time_us, position @ world.T, euler_of(turn.as_quat(), attitude_axes), place)
    return poses, Covariances(time_us[:0], np.empty((0, 6, 6)), place)


def _links(bag: Any, path: Path, wanted: list[tuple[str, str]]) -> list[Link]:
    found: dict[tuple[str, str], list[tuple[int, Any]]] = {}
    chosen = [one for one in bag.connections if one.topic in topics_of(bag, TRANSFORMS)]
    for connection, _, raw in bag.messages(connections=chosen):
        for one in bag.deserialize(raw, connection.msgtype).transforms:
            names = one.header.frame_id.lstrip("/"), one.child_frame_id.lstrip("/")
            found.setdefault(names, []).append((stamp_us(one.header), one.transform))
    for names in wanted:
        if names not in found:
            held = ", ".join(f"{parent} to {child}" for parent, child in sorted(found)) or "none"
            expected = f"{names[0]} to {names[1]}"
            raise InputError(f"{path}, tf", f"transforms {held}", expected, "correct source.navigation.tf_frames")
    return [_link(found[names], f"{path}, tf {names[0]} to {names[1]}") for names in wanted]


def _link(rows: list[tuple[int, Any]], place: str) -> Link:
    times = np.array([time for time, _ in rows], dtype=np.int64)
    values = np.array(
        [(one.translation.x, one.translation.y, one.translation.z, *quaternion_of(one.rotation)) for _, one in rows]
    )
    known = np.flatnonzero(known_orientations(values[:, 3:], place))
    kept = known[usable_rows(times[known], values[known], place)]
    later = np.concatenate([[True], np.diff(times[kept]) > 0])
    if not later.all():
        log.warning("%s: %d transforms at the time of the one before are passed over", place, np.sum(~later))
    kept = kept[later]
    return times[kept], values[kept, :3], values[kept, 3:]


def _at(link: Link, time_us: NDArray[np.int64]) -> tuple[Floats, Rotation]:
    """Translations and rotations of a link at times that lie within its own."""
    times, translation, quaternion = link
    if len(times) == 1:
        return np.tile(translation, (len(time_us), 1)), Rotation.from_quat(np.tile(quaternion, (len(time_us), 1)))
    at = (time_us - times[0]) / 1e6
    own = (times - times[0]) / 1e6
    moved = np.stack([np.interp(at, own, axis) for axis in translation.T], axis=-1)
    return moved, Slerp(own, Rotation.from_quat(quaternion))(at)
