"""The scans that figures show: a quick pass, one that the camera made the other way round, and a slow one."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.inputs.observed_points import SCAN_POINTS, select_scans
from linepose.inputs.scans.scan_files import Intensity, read_intensity
from linepose.inputs.source import ScansSection
from linepose.inputs.targets.board_in_scan import BoardInScan, fit_board
from linepose.pipeline.calibration import Calibration
from linepose.pipeline.table_checks import usable_rows
from linepose.survey.pattern import SHEET_M
from linepose.survey.targets.registry import Target
from linepose.survey.targets.rings import RingsSection

_FEWEST_POINTS: Final = 6
_SLOW: Final = 2.5  # times as many lines as the quick pass
_NOT_SLOW: Final = 1.5
_MIRROR: Final = np.diag([1.0, -1.0])  # what the other way round does to pixels and lines


@dataclass(frozen=True)
class ScanExample:
    """One observation's scan lines (L, P), the points found in it (point, u_px, line), and where the sheet lies.

    `sheet_m` is the sheet's size along x and y.
    """

    title: str
    intensity: Intensity
    points: pd.DataFrame
    board: BoardInScan
    sheet_m: tuple[float, float] = SHEET_M

    def outline(self) -> Floats:
        """The sheet's corners (5, 2), u and line, the first again at the end."""
        corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]]) / 2
        return self.board.position(corners * self.sheet_m)


def scan_examples(calibration: Calibration, table: str) -> list[ScanExample]:
    """Up to three accepted observations with the points of a table such as `points`; at least one.

    Raises InputError where the platform has no scans.
    """
    platform, folder = calibration.platform, calibration.data_folder
    source = platform.source if platform else None
    if not isinstance(source, ScansSection) or folder is None:
        raise InputError(calibration.name, "no scans", "scan images", "give source.scans in the platform's file")
    points = usable_rows(
        calibration.results.table(table, SCAN_POINTS), ("observation", "point", "u_px", "line"), f"{table}.parquet"
    )
    views = {number: points[points["observation"] == number] for number in calibration.inliers}
    target = calibration.platform_file.target
    found = {number: board_of(view, target) for number, view in views.items()}
    boards = {number: board for number, board in found.items() if board is not None}
    if not boards:
        expected = f"an accepted observation with {_FEWEST_POINTS} points of the target"
        raise InputError(f"{table}.parquet", "none", expected, "label more points")
    paths = select_scans(folder, source.scans, source.left_out)
    return [
        ScanExample(title, _intensity(paths[number]), views[number], boards[number], sheet_of(target))
        for number, title in chosen(boards).items()
    ]


@lru_cache(maxsize=3)
def _intensity(path: Path) -> Intensity:
    """A scan's lines, read once for all figures."""
    return read_intensity(path)


def board_of(view: pd.DataFrame, target: Target) -> BoardInScan | None:
    """Where the target lies in a scan, from one observation's points; None where too few of them are the target's."""
    place = {name: index for index, name in enumerate(target.ids())} if target.artwork() else {}
    known = view[view["point"].isin(list(place))]
    if len(known) < _FEWEST_POINTS:
        return None
    board_m = target.points()[[place[name] for name in known["point"]], :2]
    return fit_board(board_m, known[["u_px", "line"]].to_numpy())


def sheet_of(target: Target) -> tuple[float, float]:
    """The size of a target's sheet along x and y: of the paper's board A1, of others what is printed."""
    artwork = target.artwork()
    return SHEET_M if artwork is None or target == RingsSection() else (artwork.width_m, artwork.height_m)


def chosen(boards: Mapping[int, BoardInScan]) -> dict[int, str]:
    """Titles of the examples by observation: the quickest, the one most like its mirror image, and a slow one."""
    jacobian = {number: board.jacobian(np.zeros(2)) for number, board in boards.items()}
    lines_per_m = {number: float(np.linalg.norm(matrix[1])) for number, matrix in jacobian.items()}
    quick = min(boards, key=lines_per_m.__getitem__)

    def slowness(number: int) -> float:
        return lines_per_m[number] / lines_per_m[quick]

    def unlike_mirror_image(number: int) -> float:
        return float(np.linalg.norm(_MIRROR @ jacobian[number] - jacobian[quick]))

    mirrored = {number: bool(np.linalg.det(matrix) < 0) for number, matrix in jacobian.items()}
    turned = [number for number in boards if mirrored[number] != mirrored[quick]]
    slow = [number for number in boards if slowness(number) > _NOT_SLOW]
    numbers = [quick, *sorted(turned, key=unlike_mirror_image)[:1]]
    slow = sorted(set(slow) - set(numbers), key=lambda number: abs(np.log(slowness(number) / _SLOW)))
    ways = {number: _way(mirrored[number], number in slow) for number in [*numbers, *slow[:1]]}
    return {number: f"Observation {number}\n{way}" for number, way in ways.items()}


def _way(mirrored: bool, slow: bool) -> str:
    words = [word for word, holds in (("mirrored", mirrored), ("slow", slow)) if holds]
    return ", ".join(words) or "not mirrored"
