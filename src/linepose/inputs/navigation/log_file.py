"""Our own table of body poses, which a path in `source.navigation` names: Parquet, or CSV with a heading."""

from pathlib import Path
from typing import Final

import numpy as np
import pyarrow as pa
import pyarrow.csv as pa_csv
import pyarrow.parquet as pa_parquet

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.inputs.navigation.usable_rows import usable_rows
from linepose.inputs.number_files import check_commas, check_microseconds
from linepose.inputs.text_files import check_text
from linepose.survey.navigation_log import NavigationLog
from linepose.survey.observations import EULER_COLUMNS, POSITION_COLUMNS
from linepose.tables import read_parquet

_COLUMNS: Final = ("time_us", *POSITION_COLUMNS, *EULER_COLUMNS)
_FEWEST_ROWS: Final = 2
_LONGEST_HEADING: Final = 10_000  # characters that are looked at


def read_navigation_log(path: Path) -> NavigationLog:
    """The log of a Parquet file, or a CSV file with a heading: time_us, north_m, east_m, down_m, roll_rad, ...

    Rows out of order are sorted and exact repeats passed over, and both counted. Raises InputError naming the row of a
    second pose at one time, or a value that is no number.
    """
    table = _read_columns(path)
    time_us = table["time_us"].to_numpy()
    check_microseconds(time_us, path)
    position = np.stack([table[name].to_numpy() for name in POSITION_COLUMNS], axis=-1)
    euler = np.stack([table[name].to_numpy() for name in EULER_COLUMNS], axis=-1)
    _check_values(path, np.hstack([position, euler]))
    rows = usable_rows(time_us, np.hstack([position, euler]), str(path))
    for row in np.flatnonzero(np.diff(time_us[rows]) == 0)[:1]:
        place, found = f"{path}, row {rows[row + 1] + 1}, time_us", f"time {time_us[rows[row]]} with another pose"
        raise InputError(place, found, "one pose at a time", "remove one of the rows")
    return NavigationLog(time_us[rows], position[rows], euler[rows], str(path))


def is_own_log(path: Path) -> bool:
    """Whether a file is our own table of poses, by the names of its columns."""
    try:
        if path.suffix == ".parquet":
            names = pa_parquet.read_schema(path).names
        else:
            with path.open(encoding="utf-8-sig") as lines:
                names = [name.strip().strip('"') for name in lines.readline(_LONGEST_HEADING).split(",")]
    except (pa.ArrowException, OSError, ValueError):
        return False
    return set(_COLUMNS) <= set(names)


def _read_columns(path: Path) -> pa.Table:
    if not path.is_file():
        raise InputError(str(path), "no such file", "the navigation log", "restore it, or correct source.navigation")
    types = {name: pa.float64() for name in _COLUMNS} | {"time_us": pa.int64()}
    try:
        if path.suffix == ".parquet":
            table = read_parquet(path)
        else:
            check_text(path, "a CSV table of poses")
            check_commas(path)
            table = pa_csv.read_csv(path, convert_options=pa_csv.ConvertOptions(column_types=types))
        twice = [name for name in _COLUMNS if table.column_names.count(name) > 1]
        if twice:
            expected = f"each of {', '.join(_COLUMNS)} once"
            raise InputError(str(path), f"column {twice[0]} twice", expected, "remove or rename one of them")
        missing = [name for name in _COLUMNS if name not in table.column_names]
        if missing:
            expected = f"columns {', '.join(_COLUMNS)}"
            raise InputError(str(path), f"no column {', '.join(missing)}", expected, "name the columns so")
        table = table.select(list(_COLUMNS)).cast(pa.schema(list(types.items())))
    except (pa.ArrowException, OSError, ValueError) as error:
        found = " ".join(str(error).split())
        raise InputError(str(path), found, "Parquet, or CSV with a heading", "mend the file") from None
    for name in _COLUMNS:
        for row in np.flatnonzero(table[name].is_null().to_numpy())[:1]:
            place = f"{path}, row {row + 1}, {name}"
            raise InputError(place, "nothing", "a number in each row", "remove the row")
    if table.num_rows < _FEWEST_ROWS:
        raise InputError(str(path), f"{table.num_rows} rows", "two or more", "restore the log")
    return table


def _check_values(path: Path, values: Floats) -> None:
    broken = np.argwhere(~np.isfinite(values))
    if len(broken):
        row, column = broken[0]
        raise InputError(
            f"{path}, row {row + 1}, {_COLUMNS[1 + column]}", "no number", "a number in each row", "remove the row"
        )
    far = np.flatnonzero(np.any(np.abs(values[:, 3:]) > 2 * np.pi, axis=1))
    if far.size:
        place = f"{path}, row {far[0] + 1}, {EULER_COLUMNS[0]} to {EULER_COLUMNS[-1]}"
        raise InputError(place, f"angles {values[far[0], 3:].tolist()}", "radians", "convert degrees to radians")
