"""The navigation covariances in a file of their own: rows of time (us) and a row-major 12x12 matrix."""

from collections.abc import Sequence
from pathlib import Path
from typing import Final

import numpy as np

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.inputs.navigation.usable_rows import usable_rows
from linepose.inputs.number_files import check_microseconds, read_numbers
from linepose.survey.covariance_rule import ASYMMETRY, NEGATIVE, correlations, least_eigenvalue
from linepose.survey.navigation import NavigationCovariances

_SIZE: Final = 12


def read_covariances(path: Path, attitude_columns: Sequence[int]) -> NavigationCovariances:
    """Covariances of a file with rows of time (us) and a row-major 12x12 matrix, position in its rows 0-2.

    `attitude_columns` are the three rows and columns of roll, pitch and yaw. Rows out of order are sorted and exact
    repeats passed over, and both counted. Raises InputError naming the row of a second matrix at one time, or of a
    matrix that is not symmetric or not positive semi-definite.
    """
    time_us, numbers = read_numbers(path, 1 + _SIZE * _SIZE, "time (us) and 144 covariances")
    check_microseconds(time_us, path)
    rows = usable_rows(time_us, np.nan_to_num(numbers), str(path))
    for row in np.flatnonzero(np.diff(time_us[rows]) == 0)[:1]:
        place, found = f"{path}, row {rows[row + 1] + 1}, column 1", f"time {time_us[rows[row]]} with another matrix"
        raise InputError(place, found, "one matrix at a time", "remove one of the rows")
    keep = [0, 1, 2, *attitude_columns]
    covariance = numbers.reshape(-1, _SIZE, _SIZE)[:, keep][:, :, keep]
    for row, matrix in enumerate(covariance):
        _check_covariance(matrix, keep, f"{path}, row {row + 1}")
    return NavigationCovariances(time_us[rows], covariance[rows], str(path))


def _check_covariance(matrix: Floats, names: Sequence[int], place: str) -> None:
    """Check a covariance (6, 6), whose rows and columns are `names` in the file's matrix."""
    if not np.all(np.isfinite(matrix)):
        raise InputError(place, "a covariance that is no number", "36 finite numbers", "remove or mend the row")
    correlation = correlations(matrix)
    differing = np.argwhere(np.abs(correlation - correlation.T) > ASYMMETRY)
    if differing.size:
        i, j = differing[0]
        at, mirrored = (names[i], names[j]), (names[j], names[i])
        found = f"covariance {matrix[i, j]:g} at {at} and {matrix[j, i]:g} at {mirrored}"
        raise InputError(place, found, "a symmetric matrix", "check the column order, or remove the row")
    lowest = float(least_eigenvalue(correlation))
    if lowest < -NEGATIVE:
        raise InputError(
            place,
            f"a covariance whose correlations have the eigenvalue {lowest:g}",
            "a positive semi-definite matrix",
            "check navigation.covariance_columns, or remove the row",
        )
