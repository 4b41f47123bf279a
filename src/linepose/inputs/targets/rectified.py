"""Finding a target in a scan that is rectified with the pose at hand, as chessboards and markers are found in pictures.

What is found is carried back to raw pixels and lines, and refined there. From the points, the target's own plane is
found; the scan is rectified on it, and the target sought again.
"""

import logging
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np
from scipy import ndimage
from scipy.signal import savgol_filter

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.geometry.camera import Camera
from linepose.inputs.rectified.rectify import LinePoses, Rectified, line_poses, rectify
from linepose.inputs.rectified.surface import Surface
from linepose.inputs.scans.scan_files import Scan
from linepose.inputs.targets.board_in_scan import fit_board
from linepose.inputs.targets.board_pose import BoardPose, fit_board_pose
from linepose.inputs.targets.completed import completed
from linepose.inputs.targets.detect import Detection
from linepose.inputs.targets.surfaces import candidate_surfaces, distances_m, farthest_m
from linepose.survey.navigation_log import NavigationLog, interpolated_pose
from linepose.survey.targets.base import Found, Picture, RectifiedSection

log = logging.getLogger(__name__)

_FEWEST_POINTS: Final = 6
_ENOUGH: Final = 0.5  # of a target's points, with which the search for its plane ends
_LARGEST_MISFIT: Final = 0.2  # of the spacing
_CLEAR_TURN: Final = 0.5  # cosine between the ways a target is turned in two scans
_SMOOTH_LINES: Final = 51  # over which the log is smoothed, by parabolas
_ORDER: Final = 2
_PERCENTILES: Final = (1.0, 99.0)  # of the light, which the picture's black and white are set to


@dataclass(frozen=True)
class HandView:
    """The camera, its hand-measured pose in the body (6,), the body's log, and the target's distance, if known."""

    camera: Camera
    pose: Floats
    log: NavigationLog
    range_m: float | None = None


@dataclass
class RectifiedDetector:
    """What finds a target in scan after scan; it remembers where it was found last, and which way it was turned.

    A target that looks alike when it is turned is numbered as in the first scan: the same way round in the world.
    """

    target: RectifiedSection
    view: HandView
    refines: bool = True
    _last: tuple[int, int] | None = None
    _along: Floats | None = field(default=None)

    def __call__(self, scan: Scan) -> Detection:
        """The target's points in a scan; none, with the reason, where it is not found or does not look as described."""
        lines, poses = lines_within_log(scan, self.view)
        scan = Scan(scan.intensity[lines], scan.time_us[lines], scan.name)
        best = self._searched(scan, poses)
        if best is None:
            return _nothing(*self._not_found(scan, poses))
        found, position, surfaces = best
        board_m = self.target.points()[:, :2]
        pose = fit_board_pose(board_m[found.row], position, poses, self.view.camera, surfaces)
        again = None if pose is None else self._seen_on(scan, poses, _plane_of(pose))
        if pose is not None and again is not None and len(again[0].row) >= len(found.row):
            found, position = again
            pose = fit_board_pose(board_m[found.row], position, poses, self.view.camera, [*surfaces, _plane_of(pose)])
        spacing_px = self._spacing_px(found, position)
        if pose is None or np.median(pose.misfit_px) > _LARGEST_MISFIT * spacing_px:
            remedy = "exchange target.rows and target.columns, or correct target"
            return _nothing(f"a {self.target.kind} whose points do not lie as target describes", remedy)
        return self._named(scan, lines.start, found, position, pose)

    def _searched(self, scan: Scan, poses: LinePoses) -> tuple[Found, Floats, list[Surface]] | None:
        """What is found on the first plane that shows half of the target, else on the one that shows most of it."""
        range_m = self.view.range_m
        distance = distances_m(self.target, self.view.camera) if range_m is None else np.array([range_m])
        candidates = dict(candidate_surfaces(poses, distance))
        order = sorted(candidates, key=lambda one: (one != self._last, one))
        best: tuple[Found, Floats, list[Surface]] | None = None
        for key in order:
            seen = self._seen_on(scan, poses, candidates[key])
            if seen is None or (best is not None and len(seen[0].row) <= len(best[0].row)):
                continue
            same_distance = [one for (_, number), one in candidates.items() if number == key[1]]
            best = (*seen, same_distance)
            self._last = key
            if len(seen[0].row) >= _ENOUGH * len(self.target.points()):
                break
        return best

    def _seen_on(self, scan: Scan, poses: LinePoses, surface: Surface) -> tuple[Found, Floats] | None:
        """Points found on a plane, and their raw positions (n, 2); None where they are too few."""
        try:
            rectified = rectify(scan.intensity, poses, self.view.camera, surface)
        except InputError:  # a plane that this scan does not look at
            return None
        found = self.target.find(_picture(rectified))
        if found is None:
            return None
        position = _raw(rectified, found.place)
        seen = np.isfinite(position).all(axis=1)
        found, position = Found(found.row[seen], found.place[seen]), position[seen]
        return (found, position) if len(position) >= min(_FEWEST_POINTS, len(self.target.points())) else None

    def _spacing_px(self, found: Found, position: Floats) -> float:
        in_scan = fit_board(self.target.points()[found.row, :2], position)
        jacobian = in_scan.jacobian(self.target.points()[found.row, :2])
        return float(np.median(np.linalg.norm(jacobian[:, 0], axis=-1))) * self.target.spacing

    def _named(self, scan: Scan, first_line: int, found: Found, position: Floats, pose: BoardPose) -> Detection:
        """Points with their ids, refined in the raw scan, ordered by id."""
        numbering = self._numbering(pose)
        if numbering is None:
            return replace(_nothing("the way it is turned is open, and with it the ids"), board_found=True)
        board_m = self.target.points()[:, :2]
        row = numbering[found.row]
        if self.refines:
            detected = row
            row, position = completed(scan.intensity, self.target, detected, position)
            if len(row) < min(_FEWEST_POINTS, len(board_m)):
                return replace(_nothing("the print around the points does not fit the light"), board_found=True)
            n_lost, n_more = len(np.setdiff1d(detected, row)), len(np.setdiff1d(row, detected))
            if n_lost:
                log.info("%s: %d of %d points are left out: the print does not fit", scan.name, n_lost, len(detected))
            if n_more:
                log.info("%s: %d more points are found beside those %d", scan.name, n_more, len(detected))
        order = np.argsort(row, kind="stable")
        ids = np.array(self.target.ids(), dtype=np.int64)[row[order]]
        return Detection(ids, position[order, 0], position[order, 1] + first_line)

    def _numbering(self, pose: BoardPose) -> np.ndarray | None:
        """Which of the target's points is at each place: of ways that look alike, that turned as in the first scan."""
        board_m = self.target.points()[:, :2]
        world = pose.world(board_m)
        ways = self.target.symmetries()
        along = np.array([_unit((board_m[way, 0] - board_m[:, 0].mean()) @ world) for way in ways])
        if self._along is None:
            self._along = along[0]
        alike = along @ self._along
        best = int(np.argmax(alike))
        return ways[best] if len(ways) == 1 or alike[best] > _CLEAR_TURN else None

    def _not_found(self, scan: Scan, poses: LinePoses) -> tuple[str, str]:
        """Why there is no target, and what helps, as well as can be told."""
        kind, (farthest, range_m) = self.target.kind, (farthest_m(self.target, self.view.camera), self.view.range_m)
        detail = min(self.target.details(), key=lambda one: one.size_m / one.n_pixels)
        seen = f"{detail.name} takes {detail.n_pixels:g} pixels up to {farthest:.1f} m away"
        if range_m is not None and range_m > farthest:
            found = f"no {kind}: too small to be seen from {range_m:g} m, {seen}"
            return found, "print it larger or come closer, or correct source.target_range_m"
        turned = self._with_rows_for_columns()
        if turned is not None and turned._searched(scan, poses) is not None:
            return f"a {kind} with rows and columns exchanged", "exchange target.rows and target.columns"
        remedy = "check hand_measured and the navigation's axes, or set source.target_range_m"
        return (
            f"no {kind} that is large enough ({seen})",
            f"{remedy}; if none is there, leave the scan out (source.left_out)",
        )

    def _with_rows_for_columns(self) -> "RectifiedDetector | None":
        target = self.target
        if target.rows == target.columns or len(target.symmetries()) > 1:  # found either way
            return None
        exchanged = target.model_copy(update={"rows": target.columns, "columns": target.rows})
        return RectifiedDetector(exchanged, self.view)


def _nothing(doubt: str, remedy: str = "") -> Detection:
    return Detection(np.zeros(0, dtype=np.int64), np.zeros(0), np.zeros(0), doubt, board_found=False, remedy=remedy)


def lines_within_log(scan: Scan, view: HandView) -> tuple[slice, LinePoses]:
    """The scan's lines that the navigation log covers, and the camera's poses at them."""
    first, end = np.searchsorted(scan.time_us, [view.log.time_us[0], view.log.time_us[-1] + 1]).tolist()
    if end - first < 2:
        expected = f"lines within the navigation log ({view.log.time_us[0]} to {view.log.time_us[-1]})"
        found = f"lines from {scan.time_us[0]} to {scan.time_us[-1]}"
        raise InputError(scan.name, found, expected, "complete the navigation log, or correct the clocks")
    lines = slice(first, end)
    position, euler = interpolated_pose(view.log, scan.time_us[lines])
    return lines, line_poses(_smooth(position), _smooth(np.unwrap(euler, axis=0)), view.pose)


def _smooth(values: Floats) -> Floats:
    """Values (L, 3) of successive lines without the log's jitter, which would tear the map apart between lines."""
    window = min(_SMOOTH_LINES, len(values))
    return savgol_filter(values, window, min(_ORDER, window - 1), axis=0)


def _picture(rectified: Rectified) -> Picture:
    """The map's light in 256 steps; what the scan did not see is grey."""
    light = rectified.intensity
    seen = np.isfinite(light)
    dark, bright = np.percentile(light[seen], _PERCENTILES) if seen.any() else (0.0, 1.0)
    scaled = (light - dark) / max(float(bright - dark), 1e-9)
    return (255 * np.where(seen, scaled, 0.5).clip(0, 1)).astype(np.uint8)


def _raw(rectified: Rectified, place: Floats) -> Floats:
    """Raw u and line (n, 2) of places (n, 2), column and row of the map; NaN where it is empty."""
    at = place.T[::-1]
    values = [ndimage.map_coordinates(one, at, order=1, cval=np.nan) for one in (rectified.u_px, rectified.line)]
    return np.stack(values, axis=-1).astype(float)


def _plane_of(pose: BoardPose) -> Surface:
    return Surface(pose.origin_m, pose.matrix[:, :2].T)


def _unit(vector: Floats) -> Floats:
    return np.asarray(vector / np.linalg.norm(vector))
