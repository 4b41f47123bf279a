"""Each fault that a record of labelled views may have, to be planted in a copy of the field data."""

import shutil
from pathlib import Path


def with_rows(change):
    """A fault that turns a file's rows, each a list of cells, into others."""

    def plant(path: Path) -> None:
        rows = [row.split(",") for row in path.read_text().splitlines()]
        path.write_text("".join(",".join(row) + "\n" for row in change(rows)))

    return plant


def with_cell(row, column, text):
    """A fault in one cell, counted from 1."""

    def change(rows):
        rows[row - 1][column - 1] = text
        return rows

    return with_rows(change)


def in_seconds(rows):
    return [[row[0][:-6], *row[1:]] for row in rows]


VIEW, COVARIANCES = "view", "covariances"  # the second view file, which is the first that is used
FAULTS = {  # name: file, fault, what is told behind the file's name
    "short": (VIEW, with_rows(lambda rows: [row[:-1] for row in rows]), ", row 1: found 8 columns, expected 9"),
    "text": (VIEW, with_cell(3, 6, "abc"), ", row 3, column 6: found 'abc', expected a number"),
    "seconds": (VIEW, with_rows(in_seconds), ", row 1, column 1: found time 1466040457, expected microseconds"),
    "twice": (VIEW, with_cell(3, 2, "1"), ", row 3, column 2: found point 1 again"),
    "point": (VIEW, with_cell(1, 2, "-1"), ", row 1, column 2: found point '-1'"),
    "pixel": (VIEW, with_cell(3, 3, "648"), ", row 3, column 3: found pixel 648, expected a pixel of the sensor"),
    "nan": (VIEW, with_cell(3, 8, "nan"), ", row 3, pitch_rad: found no number"),
    "empty": (VIEW, lambda path: path.write_text(""), ": found an empty file"),
    "two": (
        COVARIANCES,
        with_rows(lambda rows: [rows[0], [rows[0][0], *rows[1][1:]], *rows[2:]]),
        ", row 2, column 1: found time",
    ),
    "asymmetric": (COVARIANCES, with_cell(9, 14, "0.01"), ", row 9: found covariance"),
    "negative": (COVARIANCES, with_cell(9, 2, "-1e-4"), ", row 9: found a covariance whose correlations have"),
    "gap": (COVARIANCES, with_rows(lambda rows: rows[:10]), ": observation 25, point"),
    "few": (VIEW, None, "labelled_points/*.csv: found 0 spare equations (1 observations"),
}


def planted(name: str, field_data: Path, folder: Path) -> dict[str, object]:
    """Copy the field data to a folder with one of the faults; the keys of the platform's source that it takes."""
    kind, plant, _ = FAULTS[name]
    shutil.copytree(field_data, folder)
    if plant is None:
        return {"first": 50}
    plant(sorted(folder.glob("labelled_points/*.csv"))[1] if kind == VIEW else folder / "nav_covs.csv")
    return {}


def told_of(name: str) -> str:
    """What a fault's line holds: the file's name and what is told behind it."""
    kind, plant, told = FAULTS[name]
    if plant is None:
        return told
    return ("-split_target_points.csv" if kind == VIEW else "nav_covs.csv") + told
