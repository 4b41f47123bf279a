"""Approximate labels: where on which scan a person saw which point."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, Final

import numpy as np
import pandas as pd

from linepose.errors import InputError, quoted
from linepose.inputs.number_files import check_cells, check_commas
from linepose.inputs.scans.scan_files import Scan
from linepose.inputs.text_files import check_text
from linepose.survey.point_names import WHAT, nameless, point_names

_COLUMNS: Final = ("observation", "point", "u_px", "line")
HEADING: Final = ",".join(_COLUMNS)


def is_own(head: Any) -> bool:
    """Whether the lines of a CSV up to its heading, as formats of tools get them, end in our own heading."""
    return isinstance(head, tuple) and set(_COLUMNS) <= {name.strip() for name in head[-1].split(",")}


def read_labels(path: Path, numbers: Sequence[int]) -> pd.DataFrame:
    """Labels of a CSV file with the heading observation, point, u_px, line, ordered by observation and point.

    `numbers` are the observations that there are scans of. Raises InputError naming the row of a label that has no
    scan, no name, no number, or is given twice.
    """
    if not path.is_file():
        raise InputError(str(path), "no such file", "approximate labels", "restore it, or set source.points: detection")
    check_text(path, "approximate labels")
    check_commas(path)
    try:
        table = pd.read_csv(path, dtype={"point": str}, skipinitialspace=True)
    except (ValueError, OSError, OverflowError) as error:
        found = " ".join(str(error).split())
        raise InputError(str(path), found, "CSV with a heading", "mend the file") from None
    check_cells(table, path)
    twice = [name for name in _COLUMNS if f"{name}.1" in table]
    if twice:
        raise InputError(str(path), f"column {twice[0]} twice", "each column once", "remove or rename one of them")
    missing = [name for name in _COLUMNS if name not in table]
    if missing:
        expected = f"columns {', '.join(_COLUMNS)}"
        raise InputError(str(path), f"no column {', '.join(missing)}", expected, "name the columns so")
    table = table[list(_COLUMNS)]
    values = table[[name for name in _COLUMNS if name != "point"]].apply(pd.to_numeric, errors="coerce")
    for row, column in np.argwhere(~np.isfinite(values.to_numpy(dtype=float)))[:1]:
        name = values.columns[column]
        raise InputError(f"{path}, row {row + 2}, {name}", quoted(table[name].iloc[row]), "a number", "mend the cell")
    known = values["observation"].isin(set(numbers)).to_numpy()
    for row in np.flatnonzero(~known)[:1]:
        found, remedy = f"{values['observation'].iloc[row]:g}", "correct or remove the label"
        raise InputError(f"{path}, row {row + 2}, observation", found, "the observations with a scan", remedy)
    for row in nameless(table["point"])[:1]:
        place, found = f"{path}, row {row + 2}, point", quoted(table["point"].iloc[row])
        raise InputError(place, found, WHAT, "correct or remove the label")
    values["point"] = point_names(table["point"])
    for row in np.flatnonzero(values.duplicated(["observation", "point"]))[:1]:
        found = f"point {values['point'].iloc[row]} of observation {values['observation'].iloc[row]:g} again"
        raise InputError(f"{path}, row {row + 2}", found, "each point once a scan", "remove one of the rows")
    labels = values[list(_COLUMNS)].astype({"observation": np.int64, "u_px": float, "line": float})
    return labels.sort_values(["observation", "point"], ignore_index=True)


def check_within(labels: pd.DataFrame, scan: Scan, place: str) -> None:
    """Raise InputError naming the first of one scan's labels that lies outside its image."""
    n_lines, n_pixels = scan.intensity.shape
    inside = labels["u_px"].between(-0.5, n_pixels - 0.5) & labels["line"].between(-0.5, n_lines - 0.5)
    for row in np.flatnonzero(~inside.to_numpy())[:1]:
        label = labels.iloc[row]
        raise InputError(
            f"{place}: label of observation {label['observation']:g}, point {labels['point'].iloc[row]}",
            f"pixel {label['u_px']:g}, line {label['line']:g}",
            f"a place within the scan's {n_pixels} pixels and {n_lines} lines",
            "correct or remove the label",
        )
