"""What every reader of a navigation log returns, and the way there from what the devices write."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.inputs import gps_time
from linepose.inputs.axes import turned, turned_angles
from linepose.inputs.local_frame import (
    LocalFrame,
    check_is_near,
    geodetic_from_local,
    local_from_geodetic,
    projected_frame,
    tangent_frame,
    utm_crs,
)
from linepose.inputs.navigation.format import GeodeticSection, NavigationFormatSection, correct_keys
from linepose.inputs.navigation.poses import (
    Poses,
    check_increasing,
    check_numbers,
    check_places,
    check_poses,
    placed_poses,
    usable_poses,
)
from linepose.survey.corrected import corrected_covariances, corrected_poses
from linepose.survey.navigation import NavigationCovariances
from linepose.survey.navigation_log import NavigationLog

_FEWEST: Final = 2
_POSES_AT_ONCE: Final = 50_000


@dataclass(frozen=True)
class NavigationRecord:
    """A navigation log in our frames and units.

    `log`: body poses, position north, east, down (m), roll, pitch, yaw (rad), Unix time (us). `covariances`: of those,
    or None where the log has none and a file of their own is needed. `crs` and `origin`: the projected CRS of north and
    east ("EPSG:32633"), or "EPSG:4979" and the latitude, longitude (deg) and ellipsoidal height (m) from which north,
    east, down are counted; both None where the log does not say. `is_turned`: whether the angles were about true north
    at each place, and were turned into that frame.
    """

    log: NavigationLog
    covariances: NavigationCovariances | None
    crs: str | None = None
    origin: tuple[float, float, float] | None = None
    is_turned: bool = False

    @property
    def frame(self) -> LocalFrame | None:
        """The frame that leads back to latitude and longitude, where it is known."""
        return None if self.crs is None else LocalFrame(self.crs, self.origin)


@dataclass(frozen=True)
class Covariances:
    """Covariances (C, 6, 6) of north, east, down (m), roll, pitch, yaw (rad) at times (C,); C may be 0."""

    time_us: NDArray[np.int64]
    covariance: Floats
    place: str


def local_record(
    poses: Sequence[Poses], covariances: Sequence[Covariances], section: NavigationFormatSection | None = None
) -> NavigationRecord:
    """The record of files with positions in metres; raises InputError naming a broken record.

    `section`: the keys of the format, of which those that may mend a record are named.
    """
    for one in poses:
        check_numbers(one)
    both = _joined_poses([usable_poses(one) for one in poses], section)
    log = _log(both, both.position, both.euler_rad)
    return NavigationRecord(log, _joined_covariances(covariances, section))


def geodetic_record(
    poses: Sequence[Poses], covariances: Sequence[Covariances], section: GeodeticSection
) -> NavigationRecord:
    """The record of files with latitude, longitude, height, taken to the section's frame.

    Angles and covariances, which are about true north at each place, are turned into the frame with the positions.
    Raises InputError naming a broken record.
    """
    poses = [usable_poses(one) for one in poses]
    for one in poses:
        check_places(one)
    both = _joined_poses([placed_poses(one) for one in poses], section)
    frame = _frame(section, both.position[0])
    position, euler = _in_frame(frame, both)
    if not np.all(np.isfinite(position)):
        place = both.place_of(int(np.flatnonzero(~np.all(np.isfinite(position), axis=1))[0]))
        raise InputError(place, f"a place outside {frame.crs}", "one inside it", "correct source.navigation.crs")
    at_poses = _joined_covariances(covariances, section)
    if at_poses is not None:
        at_poses = NavigationCovariances(at_poses.time_us, _turned(frame, both, at_poses), at_poses.source)
    log = _log(both, position, euler)
    return NavigationRecord(log, at_poses, frame.crs, frame.origin, is_turned=True)


def corrected_record(record: NavigationRecord, corrections: Sequence[str]) -> NavigationRecord:
    """The record with navigation.corrections made of its poses and covariances.

    Angles that were turned into a frame are corrected as they were before.
    """
    if not corrections:
        return record
    position, euler = record.log.position_m.copy(), record.log.euler_rad.copy()
    frame = record.frame if record.is_turned else None
    for first in range(0, len(position), _POSES_AT_ONCE):
        part = slice(first, first + _POSES_AT_ONCE)
        if frame is None:
            position[part], euler[part] = corrected_poses(position[part], euler[part], corrections)
            continue
        _, turn = local_from_geodetic(frame, geodetic_from_local(frame, position[part]))
        at_place = turned_angles(np.swapaxes(turn, -1, -2), euler[part])
        position[part], at_place = corrected_poses(position[part], at_place, corrections)
        euler[part] = turned_angles(turn, at_place)
    log = replace(record.log, position_m=position, euler_rad=euler)
    reported = record.covariances
    return replace(
        record, log=log, covariances=None if reported is None else corrected_covariances(reported, corrections)
    )


def _in_frame(frame: LocalFrame, poses: Poses) -> tuple[Floats, Floats]:
    """Positions (K, 3) and angles (K, 3) in a frame, part after part: the matrices of all poses take much memory."""
    position, euler = np.empty_like(poses.position), np.empty_like(poses.euler_rad)
    for first in range(0, len(position), _POSES_AT_ONCE):
        part = slice(first, first + _POSES_AT_ONCE)
        position[part], turn = local_from_geodetic(frame, poses.position[part])
        euler[part] = turned_angles(turn, poses.euler_rad[part])
    return position, euler


def _turned(frame: LocalFrame, poses: Poses, reported: NavigationCovariances) -> Floats:
    """Covariances (C, 6, 6) in a frame, of those about true north at the nearest poses, part after part."""
    covariance = np.empty_like(reported.covariance)
    for first in range(0, len(covariance), _POSES_AT_ONCE):
        part = slice(first, first + _POSES_AT_ONCE)
        row = nearest_rows(poses.time_us, reported.time_us[part])
        _, turn = local_from_geodetic(frame, poses.position[row])
        _, covariance[part] = turned(reported.covariance[part], turn, poses.euler_rad[row])
    return covariance


def _log(poses: Poses, position: Floats, euler_rad: Floats) -> NavigationLog:
    log = NavigationLog(poses.time_us, position, euler_rad)
    return log if poses.gap_key is None else replace(log, gap_key=poses.gap_key)


def _frame(section: GeodeticSection, first: Floats) -> LocalFrame:
    """The frame that the keys name, of a log whose first place (3,) is this."""
    latitude, longitude, height = (float(one) for one in first)
    if section.frame == "projected":
        frame = projected_frame(section.crs or utm_crs(latitude, longitude))
        check_is_near(frame, latitude, longitude, "source.navigation.crs")
        return frame
    return tangent_frame(section.origin or (latitude, longitude, height))


def nearest_rows(time_us: NDArray[np.int64], wanted_us: NDArray[np.int64]) -> NDArray[np.int64]:
    """Rows of increasing times (K,) that are nearest to others (C,); (C,)."""
    after = np.searchsorted(time_us, wanted_us).clip(1, max(len(time_us) - 1, 1))
    before = after - 1
    after = after.clip(max=len(time_us) - 1)
    return np.where(np.abs(time_us[after] - wanted_us) < np.abs(time_us[before] - wanted_us), after, before)


def _joined_poses(parts: Sequence[Poses], section: NavigationFormatSection | None) -> Poses:
    for part in parts:
        check_poses(part, section)
    ordered = sorted(parts, key=lambda part: int(part.time_us[0]))
    gps_time.tell_lost_weeks(int(ordered[0].time_us[0]), ordered[0].place)
    for before, after in pairwise(ordered):
        if after.time_us[0] <= before.time_us[-1]:
            raise InputError(
                after.place,
                f"a log that begins at {after.time_us[0]} us",
                f"one that begins after the end of {before.place} ({before.time_us[-1]} us)",
                "remove the log that is there twice",
            )
    joined = Poses(
        np.concatenate([part.time_us for part in ordered]),
        np.concatenate([part.position for part in ordered]),
        np.concatenate([part.euler_rad for part in ordered]),
        ordered[0].place,
        next((part.gap_key for part in ordered if part.gap_key), None),
        np.concatenate([part.numbers for part in ordered]),
    )
    if len(joined.time_us) < _FEWEST:
        raise InputError(joined.place, f"{len(joined.time_us)} poses", "two or more", "restore the log")
    return joined


def _not_repeated(time_us: NDArray[np.int64], values: Floats) -> NDArray[np.bool_]:
    """Which of times (K,) and values (K, ...) differ from those before them; (K,)."""
    same = np.all(values[1:] == values[:-1], axis=tuple(range(1, values.ndim)))
    kept: NDArray[np.bool_] = np.ones(len(time_us), dtype=bool)
    kept[1:] = ~(same & (np.diff(time_us) == 0))
    return kept


def _joined_covariances(
    parts: Sequence[Covariances], section: NavigationFormatSection | None
) -> NavigationCovariances | None:
    filled = sorted((part for part in parts if len(part.time_us)), key=lambda part: int(part.time_us[0]))
    if not filled:
        return None
    first, *others = filled
    time_us, covariance = first.time_us, first.covariance
    if others:
        time_us = np.concatenate([part.time_us for part in filled])
        covariance = np.concatenate([part.covariance for part in filled])
    if np.any(np.diff(time_us) < 0):  # copies of all matrices take much memory
        order = np.argsort(time_us, kind="stable")
        time_us, covariance = time_us[order], covariance[order]
    kept = _not_repeated(time_us, covariance)
    if not kept.all():
        time_us, covariance = time_us[kept], covariance[kept]
    check_increasing(time_us, f"{filled[0].place}, covariances")
    lowest = np.min(np.diagonal(covariance, axis1=1, axis2=2), axis=1)
    for row in np.flatnonzero(~np.all(np.isfinite(covariance), axis=(1, 2)) | (lowest < 0))[:1]:
        place, found = f"{filled[0].place}, covariance {row + 1}", "a sigma or variance that is negative or no number"
        remedy = correct_keys(section, ["columns"], "remove the record")
        raise InputError(place, found, "36 finite numbers, variances at least 0", remedy)
    return NavigationCovariances(time_us, covariance, ", ".join(dict.fromkeys(part.place for part in filled)))
