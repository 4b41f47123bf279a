"""What was measured: every observation of the pattern's points, with the body pose and its covariance.

An observation is one view of the points, numbered from 1 as the paper does. Points have names; inside, each is a
column of the survey, in the order of the names. A point that an observation lacks is NaN in `u_px`, and everything else
of it is ignored. Positions are local: the survey origin is subtracted
on reading, because map coordinates of 6e6 m leave too few digits for arithmetic.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.survey.point_names import Names, point_names
from linepose.survey.rows import checked_rows
from linepose.tables import floats, point_column, whole_numbers

POSITION_COLUMNS: Final = ("north_m", "east_m", "down_m")
EULER_COLUMNS: Final = ("roll_rad", "pitch_rad", "yaw_rad")
AXES: Final = ("north", "east", "down", "roll", "pitch", "yaw")
COVARIANCE_INDICES: Final = tuple((i, j) for i in range(6) for j in range(i, 6))
POSITION_COVARIANCE_INDICES: Final = tuple((i, j) for i in range(3) for j in range(i, 3))
COVARIANCE_COLUMNS: Final = tuple(f"covariance_{AXES[i]}_{AXES[j]}" for i, j in COVARIANCE_INDICES)
VARIANCE_COLUMNS: Final = tuple(COVARIANCE_COLUMNS[COVARIANCE_INDICES.index((i, i))] for i in range(6))
POINT_FIELDS: Final = [
    *whole_numbers("observation"),
    point_column(),
    *whole_numbers("time_us"),
    *floats("u_px", *POSITION_COLUMNS, *EULER_COLUMNS),
]
OBSERVATIONS: Final = pa.schema([*POINT_FIELDS, *floats(*COVARIANCE_COLUMNS, "nav_gap_s")])
_LARGEST_GRID: Final = 4_000_000  # observations times points, of 450 bytes each
_RAYS_PER_POINT: Final = 2


@dataclass(frozen=True)
class Survey:
    """All observations of one platform; N observations of M points.

    number (N,), time_us (N, M) int64, u_px (N, M), position_m (N, M, 3) north, east, down from `origin_m` (3,),
    euler_rad (N, M, 3) roll, pitch, yaw, covariance (N, M, 6, 6) of position and angles, nav_gap_s (N, M); names (M,):
    of the points, 0 to M - 1 if not given.
    """

    number: NDArray[np.int64]
    time_us: NDArray[np.int64]
    u_px: Floats
    position_m: Floats
    euler_rad: Floats
    covariance: Floats
    nav_gap_s: Floats
    origin_m: Floats
    names: Names = field(default_factory=lambda: np.arange(0))

    def __post_init__(self) -> None:
        """Points without names are numbered."""
        if not len(self.names):
            object.__setattr__(self, "names", np.arange(self.n_points))

    @property
    def n_observations(self) -> int:
        """Number of observations N."""
        return len(self.number)

    @property
    def n_points(self) -> int:
        """Number of points M."""
        return int(self.u_px.shape[1])

    def select(self, numbers: Sequence[int]) -> "Survey":
        """The survey of these observation numbers, in the given order; raises InputError for one that is not here."""
        rows = {int(number): row for row, number in enumerate(self.number)}
        missing = [int(number) for number in numbers if int(number) not in rows]
        if missing:
            raise InputError(
                "observations",
                f"number {', '.join(map(str, missing))}",
                f"numbers among {sorted(rows)}",
                "remove it from the selection",
            )
        index = [rows[int(number)] for number in numbers]
        return replace(
            self,
            number=self.number[index],
            time_us=self.time_us[index],
            u_px=self.u_px[index],
            position_m=self.position_m[index],
            euler_rad=self.euler_rad[index],
            covariance=self.covariance[index],
            nav_gap_s=self.nav_gap_s[index],
        )


def survey_from_table(table: pd.DataFrame) -> Survey:
    """The survey that a table like results/NAME/observations.parquet holds, one row an observed point.

    The origin is the mean position rounded to whole metres; points are in the order of their names. Raises InputError
    for rows that `checked_rows` refuses, and where observations times points are too many.
    """
    table = checked_rows(table, OBSERVATIONS.names)
    numbers = np.sort(table["observation"].unique()).astype(np.int64)
    unique, column = np.unique(point_names(table["point"]), return_inverse=True)
    shape = (len(numbers), len(unique))
    if shape[0] * shape[1] > _LARGEST_GRID:
        raise InputError(
            "observations",
            f"{shape[0]} observations of {shape[1]} different points",
            f"at most {_LARGEST_GRID} of one times the other",
            "leave out points that are seen in few observations",
        )
    row = np.searchsorted(numbers, table["observation"].to_numpy())
    origin = np.round(table[list(POSITION_COLUMNS)].to_numpy().mean(axis=0))

    def gridded(values: NDArray[np.float64], trailing: tuple[int, ...] = ()) -> Floats:
        grid = np.full((*shape, *trailing), np.nan)
        grid[row, column] = values
        return grid

    time_us = np.zeros(shape, dtype=np.int64)
    time_us[row, column] = table["time_us"].to_numpy()
    return Survey(
        number=numbers,
        time_us=time_us,
        u_px=gridded(table["u_px"].to_numpy()),
        position_m=gridded(table[list(POSITION_COLUMNS)].to_numpy() - origin, (3,)),
        euler_rad=gridded(table[list(EULER_COLUMNS)].to_numpy(), (3,)),
        covariance=gridded(covariance_matrices(table), (6, 6)),
        nav_gap_s=gridded(table["nav_gap_s"].to_numpy()),
        origin_m=origin,
        names=point_names(unique),
    )


def covariance_matrices(table: pd.DataFrame) -> Floats:
    """The covariances (K, 6, 6) of the body poses in the rows of a table of observations."""
    upper = table[list(COVARIANCE_COLUMNS)].to_numpy(dtype=float)
    covariance = np.zeros((len(table), 6, 6))
    for k, (i, j) in enumerate(COVARIANCE_INDICES):
        covariance[:, i, j] = covariance[:, j, i] = upper[:, k]
    return covariance


def table_from_survey(survey: Survey) -> pd.DataFrame:
    """One row an observed point, ordered by observation and point: the inverse of `survey_from_table`."""
    row, column = np.nonzero(np.isfinite(survey.u_px))
    covariance = survey.covariance[row, column]
    columns: dict[str, Floats | Names] = {
        "observation": survey.number[row],
        "point": survey.names[column],
        "time_us": survey.time_us[row, column],
        "u_px": survey.u_px[row, column],
    }
    position = survey.position_m[row, column] + survey.origin_m
    columns |= {name: position[:, i] for i, name in enumerate(POSITION_COLUMNS)}
    columns |= {name: survey.euler_rad[row, column, i] for i, name in enumerate(EULER_COLUMNS)}
    columns |= {name: covariance[:, i, j] for name, (i, j) in zip(COVARIANCE_COLUMNS, COVARIANCE_INDICES, strict=True)}
    columns["nav_gap_s"] = survey.nav_gap_s[row, column]
    return pd.DataFrame(columns)


def check_determined(survey: Survey, n_parameters: int, place: str = "observations") -> None:
    """Raise InputError, naming `place`, where the views are too few for the pose's `n_parameters` that are not known.

    Each view of a point gives 2 equations, each point takes 3 unknowns. Where the hand measurement is a prior, none of
    the pose's parameters is unknown; one spare equation is then enough.
    """
    needed = max(n_parameters, 1)
    views = np.isfinite(survey.u_px).sum(axis=0)
    used = views[views >= _RAYS_PER_POINT]
    spare = int(2 * used.sum() - 3 * len(used))
    if spare < needed:
        raise InputError(
            place,
            f"{spare} spare equations ({survey.n_observations} observations, {len(used)} points in two or more)",
            f"at least {needed}",
            "add observations, or label more points",
        )
