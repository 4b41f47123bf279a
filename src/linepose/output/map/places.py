"""Where the pixels of a scan lie on the map, and how sure that is, for any of its lines."""

from collections.abc import Collection
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.geometry.camera import normalised_from_pixel
from linepose.geometry.rotations import matrix_from_euler
from linepose.inputs.navigation.record import nearest_rows
from linepose.output.map.frame import SurveyMap
from linepose.output.map.ground import Ground
from linepose.output.map.kernel import FOUND, IN_HOLE, MET_TWICE, MISSED, OUTSIDE, on_the_ground
from linepose.output.map.sources import (
    SOURCES,
    MountedCamera,
    Source,
    bend_of,
    by_intrinsics,
    line_covariances,
    line_with_intrinsics,
    normalised_pixels,
    pixel_variances,
    radii_of_95,
)
from linepose.survey.navigation import NavigationCovariances
from linepose.survey.navigation_log import NavigationLog, PoseAt, interpolated_pose

N_PLACE: Final = 3
N_SIGMA: Final = 4
STATES: Final = {"n_missed": MISSED, "n_outside": OUTSIDE, "n_in_hole": IN_HOLE, "n_met_twice": MET_TWICE}
"""What is counted of pixels, and the kernel's number for it."""


_Raw = tuple[Floats, NDArray[np.float32], NDArray[np.uint8]]


@dataclass(frozen=True, eq=False)
class Places:
    """Easting, northing, height (L, 3, P) in m, sigmas (L, 4, P) of them and the radius of 95 %, and states (L, P)."""

    place_m: Floats
    sigma_m: NDArray[np.float32]
    state: NDArray[np.uint8]

    @property
    def is_found(self) -> NDArray[np.bool_]:
        """Whether a pixel has a place; (L, P)."""
        found: NDArray[np.bool_] = (self.state == FOUND) | (self.state == MET_TWICE)
        return found


@dataclass(frozen=True, eq=False)
class Navigation:
    """The body's poses, what is reported of their errors, and how far apart in time both may be."""

    log: NavigationLog
    pose_at: PoseAt
    reported: NavigationCovariances
    maximum_pose_gap_s: float
    maximum_gap_s: float

    def check(self, time_us: NDArray[np.int64], scan: str) -> None:
        """Raise InputError naming the scan where its times (L,) are outside the log, or in a gap of it."""
        known, log = self.log.time_us, self.log
        outside = np.flatnonzero((time_us < known[0]) | (time_us > known[-1]))
        if outside.size:
            raise InputError(
                f"{scan}, line {outside[0]}",
                f"time {time_us[outside[0]]}, as of {outside.size} lines",
                f"a time within the navigation log ({known[0]} to {known[-1]})",
                "complete the navigation log, or correct the clocks",
            )
        after = np.searchsorted(known, time_us).clip(1, len(known) - 1)
        gap_s = (known[after] - known[after - 1]) / 1e6
        self._check_gap(gap_s, self.maximum_pose_gap_s, scan, "a gap of {:.3f} s in the navigation log", log.gap_key)
        rows = nearest_rows(self.reported.time_us, time_us)
        apart_s = np.abs(self.reported.time_us[rows] - time_us) / 1e6
        found = "the nearest covariance {:.3f} s away"
        self._check_gap(apart_s, self.maximum_gap_s, scan, found, "navigation.maximum_gap_s")

    @staticmethod
    def _check_gap(gap_s: Floats, most_s: float, scan: str, found: str, key: str) -> None:
        worst = int(np.argmax(gap_s))
        if gap_s[worst] > most_s:
            remedy = f"complete the log, or raise {key}"
            raise InputError(f"{scan}, line {worst}", found.format(gap_s[worst]), f"at most {most_s:g} s", remedy)


@dataclass(frozen=True, eq=False)
class ScanOnMap:
    """All that the places of a scan's pixels rest on; `time_us` (L,) of its lines.

    `correction` (6,), north, east, down (m), roll, pitch, yaw (rad), is added to the body's poses: what an adjustment
    found there.
    """

    name: str
    time_us: NDArray[np.int64]
    mounted: MountedCamera
    navigation: Navigation
    ground: Ground
    frame: SurveyMap
    correction: Floats

    @property
    def shape(self) -> tuple[int, int]:
        """Lines and pixels."""
        return len(self.time_us), self.mounted.camera.n_pixels

    def bodies(self, first: int, end: int) -> tuple[Floats, Floats, Floats]:
        """Positions (n, 3), Euler angles (n, 3) and reported covariances (n, 6, 6) of the body at these lines."""
        times, reported = self.time_us[first:end], self.navigation.reported
        position, euler = self.navigation.pose_at(self.navigation.log, times)
        covariance = reported.covariance[nearest_rows(reported.time_us, times)]
        return position + self.correction[:3], euler + self.correction[3:], covariance

    def motion(self, first: int, end: int) -> Floats:
        """How the body moves from line to line at these lines: position (m) and Euler angles (rad); (n, 6)."""
        begin, last = max(first - 1, 0), min(end + 1, self.shape[0])
        if last - begin < 2:
            return np.zeros((end - first, 6))
        position, euler = interpolated_pose(self.navigation.log, self.time_us[begin:last])  # the nearest would jump
        pose = np.concatenate([position - position[0], np.unwrap(euler, axis=0)], axis=1)
        return np.asarray(np.gradient(pose, axis=0)[first - begin : end - begin])

    def places(self, first: int, end: int, sources: Collection[Source] = SOURCES) -> Places:
        """The places of all pixels of lines first to end (exclusive), with the sigmas that these sources cause."""
        place, sigma, state = self._in_survey(first, end, sources)
        return Places(self._on_map(place), sigma, state)

    def down_m(self, line: int) -> Floats:
        """How far down, in the survey's own axes, the ground of a line's pixels lies (P,) in m; NaN where none is."""
        return -self._in_survey(line, line + 1, ())[0][0, 2]

    def _in_survey(self, first: int, end: int, sources: Collection[Source]) -> _Raw:
        """East, north, up (n, 3, P) in the survey's own axes, sigmas (n, 4, P) on the map, and states (n, P)."""
        position, euler, reported = self.bodies(first, end)
        body, mounted, ground = matrix_from_euler(euler), self.mounted, self.ground
        centre = position + body @ mounted.pose[:3]
        n, pixels = len(centre), self.shape[1]
        place, sigma = np.empty((n, N_PLACE, pixels)), np.empty((n, N_SIGMA, pixels), dtype=np.float32)
        state = np.empty((n, pixels), dtype=np.uint8)
        normal, offset, grid, corner, cell, extremes = self._ground_for_kernel
        on_the_ground(
            centre,
            body,
            line_covariances(mounted, euler, reported, self.motion(first, end), sources),
            line_with_intrinsics(mounted, euler, sources),
            mounted.turn,
            self._x,
            bend_of(mounted.camera, self._x),
            by_intrinsics(mounted.camera, mounted.intrinsics_names),
            pixel_variances(mounted, sources, ground.sigma_m),
            normal,
            offset,
            grid,
            corner,
            cell,
            extremes,
            self.frame.jacobian(centre[n // 2]),
            radii_of_95(),
            place,
            sigma,
            state,
        )
        return place, sigma, state

    def places_of(self, line: ArrayLike, u_px: ArrayLike) -> Floats:
        """Easting, northing, height (K, 3) at fractional lines (K,) and pixels (K,); NaN where a ray has none."""
        at, mounted = np.asarray(line, dtype=float), self.mounted
        if not len(at):
            return np.empty((0, N_PLACE))
        times = np.rint(np.interp(at, np.arange(self.shape[0]), self.time_us - self.time_us[0])).astype(np.int64)
        position, euler = self.navigation.pose_at(self.navigation.log, times + self.time_us[0])
        body = matrix_from_euler(euler + self.correction[3:])
        centre = position + self.correction[:3] + body @ mounted.pose[:3]
        x = normalised_from_pixel(mounted.camera, u_px)
        bend = bend_of(mounted.camera, x)
        place = np.empty((len(at), N_PLACE, 1))
        nothing = np.zeros((1, 6, 6)), np.zeros((1, 6, 0)), np.zeros((1, 2, 0)), np.zeros((1, 4))
        sigma, state = np.empty((1, N_SIGMA, 1), dtype=np.float32), np.empty((1, 1), dtype=np.uint8)
        normal, offset, grid, corner, cell, extremes = self._ground_for_kernel
        for k in range(len(at)):
            on_the_ground(
                centre[k : k + 1],
                body[k : k + 1],
                nothing[0],
                nothing[1],
                mounted.turn,
                x[k : k + 1],
                bend[k : k + 1],
                nothing[2],
                nothing[3],
                normal,
                offset,
                grid,
                corner,
                cell,
                extremes,
                np.eye(3),
                radii_of_95(),
                place[k : k + 1],
                sigma,
                state,
            )
        return np.asarray(self._on_map(place)[..., 0])

    @property
    def _ground_for_kernel(self) -> tuple[Any, ...]:
        ground = self.ground
        corner, cell = np.array(ground.corner_m), np.array(ground.cell_m)
        return ground.normal, ground.offset, ground.grid, corner, cell, self._extremes_m

    def _on_map(self, place: Floats) -> Floats:
        """Easting, northing, height of east, north, up in the survey's own axes; (n, 3, P)."""
        if not self.frame.is_tangent:
            return place
        east, north, up = np.moveaxis(place, 1, 0)
        local = np.stack([north.ravel(), east.ravel(), -up.ravel()], axis=-1)
        known = np.all(np.isfinite(local), axis=1)
        local[known] = self.frame.places(local[known])
        local[~known] = np.nan
        return np.ascontiguousarray(np.moveaxis(local.reshape(*north.shape, 3), -1, 1))

    @cached_property
    def _x(self) -> Floats:
        return normalised_pixels(self.mounted.camera)

    @cached_property
    def _extremes_m(self) -> Any:
        return self.ground.extremes_m


def count_states(state: NDArray[np.uint8]) -> dict[str, int]:
    """How many pixels (L, P) have no place, and why, or meet the ground more than once."""
    counts = np.bincount(state.ravel(), minlength=5)
    return {name: int(counts[number]) for name, number in STATES.items()}
