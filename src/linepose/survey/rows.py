"""Whether the rows of a table of observations are what a survey is made of: numbers, and each point once a view."""

from collections.abc import Sequence
from typing import Final

import numpy as np
import pandas as pd

from linepose.errors import InputError
from linepose.survey.point_names import WHAT, nameless, point_names

_WHOLE: Final = ("observation", "time_us")
_ANGLES: Final = ("roll_rad", "pitch_rad", "yaw_rad")
_LARGEST_ANGLE: Final = 2 * np.pi + 1e-9
_LARGEST_WHOLE: Final = 2.0**63
_FASTEST_M_S: Final = 500.0  # that a body with a line-scan camera moves
_TOLD: Final = 3


def checked_rows(observations: pd.DataFrame, columns: Sequence[str]) -> pd.DataFrame:
    """The table with these columns as numbers, names of points as `point_names` has them, and a row index from 0.

    Raises InputError for a missing column, a table without rows, and the first row with something else than a number of
    its kind, an angle in degrees, or a point of a view that stands in a row before it.
    """
    missing = [name for name in columns if name not in observations.columns]
    if missing:
        raise InputError(
            "observations",
            f"no column {', '.join(missing[:_TOLD])}"
            + (f" and {len(missing) - _TOLD} more" if len(missing) > _TOLD else ""),
            "observation, point, u_px, the body's pose and its covariance",
            "make the table with linepose.observations_from_arrays",
        )
    if observations.empty:
        raise InputError("observations", "no row", "one row a point seen", "add observations")
    given = observations.reset_index(drop=True)
    of_numbers = [name for name in columns if name != "point"]
    numbers = pd.DataFrame({name: _numbers(given[name]) for name in of_numbers})
    wrong = np.column_stack([_wrong(name, numbers[name].to_numpy(dtype=float)) for name in of_numbers])
    faults = [(int(row), "point") for row in nameless(given["point"])[:1]]
    faults += [(int(row), of_numbers[column]) for row, column in np.argwhere(wrong)[:1]]
    for row, name in sorted(faults)[:1]:
        raise _fault(row, name, given[name].iloc[row])
    checked = given.assign(
        point=point_names(given["point"]), **{name: _typed(name, numbers[name]) for name in of_numbers}
    )
    for row in np.flatnonzero(checked.duplicated(["observation", "point"]))[:1]:
        found = f"point {checked['point'].iloc[row]} of observation {checked['observation'].iloc[row]} again"
        raise InputError(f"observations, row {row}", found, "each point once a view", "remove one of the rows")
    return checked


def check_time_units(observations: pd.DataFrame) -> None:
    """Raise InputError where most views are so short that the body would fly: seconds or milliseconds were given."""
    views = observations.groupby("observation")
    extent = views[["north_m", "east_m", "down_m"]].agg(np.ptp).to_numpy(dtype=float)
    duration_s = views["time_us"].agg(np.ptp).to_numpy(dtype=float) * 1e-6
    lasts = duration_s > 0
    if not np.any(lasts):
        return
    speed = float(np.median(np.linalg.norm(extent[lasts], axis=1) / duration_s[lasts]))
    if speed > _FASTEST_M_S:
        raise InputError(
            "time_us",
            f"times at which the body moves at {speed:.3g} m/s within a view",
            f"below {_FASTEST_M_S:g} m/s",
            "give microseconds, or leave the times out",
        )


def _numbers(values: "pd.Series[float]") -> "pd.Series[float]":
    """As numbers, NaN for what is none; dates are none, for their unit is not said."""
    if pd.api.types.is_datetime64_any_dtype(values.dtype) or pd.api.types.is_complex_dtype(values.dtype):
        return pd.Series(np.full(len(values), np.nan))
    return pd.to_numeric(values, errors="coerce")


def _wrong(name: str, column: np.ndarray) -> np.ndarray:
    wrong = ~np.isfinite(column)
    if name in _WHOLE:
        wrong |= (column != np.floor(column)) | (np.abs(column) >= _LARGEST_WHOLE)
    if name == "observation":
        wrong |= column < 0
    if name in _ANGLES:
        wrong |= np.abs(column) > _LARGEST_ANGLE
    return np.asarray(wrong)


def _fault(row: int, name: str, found: object) -> InputError:
    place, told = f"observations, row {row}", f"{name} {found}"
    if name == "point":
        return InputError(place, told, WHAT, "correct or remove the row")
    if name == "observation":
        return InputError(place, told, "a whole number, not negative", "correct or remove the row")
    if name == "time_us":
        return InputError(place, told, "a whole number of microseconds", "correct the times, or leave them out")
    if name in _ANGLES and isinstance(found, int | float) and np.isfinite(found):
        return InputError(place, told, "radians", "convert degrees with numpy.radians")
    return InputError(place, told, "a finite number", "correct or remove the row")


def _typed(name: str, column: "pd.Series[float]") -> np.ndarray:
    return column.to_numpy(dtype=np.int64 if name in _WHOLE else float)
