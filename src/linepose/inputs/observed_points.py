"""From scans to observed points: by labels that are refined, or by detection without any."""

import logging
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.inputs.labels.labels import check_within
from linepose.inputs.patterns import matching
from linepose.inputs.scans.scan_files import LineTimes, Scan, read_scan
from linepose.inputs.targets.detect import Detection, Detector
from linepose.inputs.targets.refine import Refine, refine_points
from linepose.survey.point_names import Names
from linepose.tables import floats, point_column, whole_numbers

SCAN_POINTS: Final = pa.schema(
    [*whole_numbers("observation"), point_column(), *whole_numbers("time_us"), *floats("u_px", "line")]
)
_FEWEST_OBSERVATIONS: Final = 2
_MANY: Final = 0.5  # share of the scans from which on they share the reason of having no board

log = logging.getLogger(__name__)


def select_scans(folder: Path, pattern: str, left_out: Sequence[int]) -> dict[int, Path]:
    """Scan files by observation number: those of the folder in the order of their names, counted from 1."""
    paths = matching(folder, pattern)
    if not paths:
        remedy = "correct source.scans, or put the scans there"
        raise InputError(str(folder / pattern), "no file", "one scan an observation", remedy)
    unknown = sorted(set(left_out) - set(range(1, len(paths) + 1)))
    if unknown:
        raise InputError("source.left_out", f"observation {unknown[0]}", f"1 to {len(paths)}", "remove it")
    return {number: path for number, path in enumerate(paths, start=1) if number not in left_out}


def refined_points(
    scans: Mapping[int, Path],
    labels: pd.DataFrame,
    refine: Refine,
    n_pixels: int,
    line_times: LineTimes | None = None,
) -> pd.DataFrame:
    """Points of every labelled scan, refined from the labels; columns as in `SCAN_POINTS`.

    Raises InputError naming a label outside its image, or one with no dot near it.
    """
    tables = []
    for number, path in scans.items():
        mine = labels[labels["observation"] == number]
        if mine.empty:
            log.warning("%s: no label: left out", path)
            continue
        scan = read_scan(path, line_times, n_pixels)
        check_within(mine, scan, str(path))
        found = refine_points(refine, scan.intensity, mine[["u_px", "line"]])
        for row in np.flatnonzero(np.isnan(found[:, 0]))[:1]:
            label = mine.iloc[row]
            raise InputError(
                f"{path}: label of observation {number}, point {mine['point'].iloc[row]}",
                f"no dot near pixel {label['u_px']:g}, line {label['line']:g}",
                "a bright dot on dark print",
                "correct or remove the label",
            )
        tables.append(scan_points(number, scan, mine["point"].to_numpy(), found))
    return _joined(tables, scans)


def detected_points(
    scans: Mapping[int, Path], detector: Detector, n_pixels: int, line_times: LineTimes | None = None
) -> pd.DataFrame:
    """Points of every scan in which the board and its ids are found; columns as in `SCAN_POINTS`.

    A scan whose ids are in doubt is left out with a warning. Raises InputError naming all scans without a board.
    """
    tables, without = [], dict[int, Detection]()
    for number, path, scan, found in detected_in(scans, detector, n_pixels, line_times):
        if not found.board_found:
            without[number] = found
            continue
        if found.doubt:
            log.warning("observation %d (%s) is left out: %s", number, path.name, found.doubt)
            continue
        tables.append(scan_points(number, scan, found.point, found.position))
    if without:
        raise _without_board(scans, without)
    return _joined(tables, scans)


def _without_board(scans: Mapping[int, Path], without: Mapping[int, Detection]) -> InputError:
    """The error of scans without a board: where most are without, the reason is one that they share."""
    number, first = next(iter(without.items()))
    named = ", ".join(map(str, without))
    leave_out = f"add {named} to source.left_out, or label the scan{'s' if len(without) > 1 else ''}"
    is_many = len(without) >= _MANY * len(scans)
    remedy = first.remedy if is_many and first.remedy else leave_out
    if len(without) == 1:
        return InputError(str(scans[number]), first.doubt, "a scan of the board", remedy)
    found = f"{len(without)} of {len(scans)} scans without the board: observation {named}; the first: {first.doubt}"
    if is_many and not first.remedy:
        remedy = f"check target, or {leave_out}"
    return InputError(str(scans[number].parent), found, "scans of the board", remedy)


def detected_in(
    scans: Mapping[int, Path], detector: Detector, n_pixels: int, line_times: LineTimes | None = None
) -> Iterator[tuple[int, Path, Scan, Detection]]:
    """Each scan's number, path, lines and what is detected in it, one after the other."""
    for number, path in scans.items():
        scan = read_scan(path, line_times, n_pixels)
        yield number, path, scan, detector(scan)


def scan_points(number: int, scan: Scan, point: Names, position: Floats) -> pd.DataFrame:
    """Points (n,) of one observation at positions (n, 2) of u and line; columns as in `SCAN_POINTS`."""
    return pd.DataFrame(
        {
            "observation": number,
            "point": point,
            "time_us": scan.time_at(position[:, 1]),
            "u_px": position[:, 0],
            "line": position[:, 1],
        }
    )


def _joined(tables: list[pd.DataFrame], scans: Mapping[int, Path]) -> pd.DataFrame:
    tables = [table for table in tables if len(table)]
    if len(tables) < _FEWEST_OBSERVATIONS:
        raise InputError(
            str(next(iter(scans.values())).parent) if scans else "source.scans",
            f"{len(tables)} of {len(scans)} scans with known points",
            f"at least {_FEWEST_OBSERVATIONS}",
            "add scans of the whole board, or label them",
        )
    return pd.concat(tables, ignore_index=True)
