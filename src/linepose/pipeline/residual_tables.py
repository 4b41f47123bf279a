"""The residuals and the estimated points behind a pose, as tables: what is left over, and where."""

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa
from numpy.typing import ArrayLike

from linepose.likelihood.base import Likelihood, Residuals
from linepose.survey.observations import POSITION_COLUMNS, POSITION_COVARIANCE_INDICES, Survey
from linepose.tables import floats, optional_floats, point_column, texts, whole_numbers

_AXES = ("north", "east", "down")
POINT_COVARIANCE_COLUMNS = tuple(f"covariance_{_AXES[i]}_{_AXES[j]}_m2" for i, j in POSITION_COVARIANCE_INDICES)

RESIDUALS: Final = pa.schema(
    [
        *texts("stage"),
        *whole_numbers("observation"),
        point_column(),
        *floats("error_px", "error_u_px", "error_v_px", "sigma_px"),
    ]
)
ESTIMATED_POINTS: Final = pa.schema(
    [*texts("stage"), point_column(), *floats(*POSITION_COLUMNS), *optional_floats(*POINT_COVARIANCE_COLUMNS)]
)


def residual_tables(
    likelihood: Likelihood, stages: Mapping[str, Sequence[int]], parameters: Mapping[str, ArrayLike]
) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Residuals of every observed point, and the estimated points, at each stage's parameters (P,).

    Columns as in `RESIDUALS` and `ESTIMATED_POINTS`; points in map coordinates. u is along the scan
    line, v across it, both observed minus reprojected; sigma is in the direction of the error.
    """
    residuals, points = [], []
    for stage, numbers in stages.items():
        selected = likelihood.select(list(numbers))
        survey = selected.survey
        found = selected.residuals(np.asarray(parameters[stage], dtype=float))
        residuals.append(residual_rows(stage, survey, found))
        points.append(point_rows(stage, survey, found))
    return pd.concat(residuals, ignore_index=True), pd.concat(points, ignore_index=True)


def residual_rows(stage: str, survey: Survey, found: Residuals) -> pd.DataFrame:
    """One row an observed point of a survey; columns as in `RESIDUALS`."""
    row, column = np.nonzero(np.isfinite(found.error_px))
    return pd.DataFrame(
        {
            "stage": stage,
            "observation": survey.number[row],
            "point": survey.names[column],
            "error_px": found.error_px[row, column],
            "error_u_px": found.error_uv_px[row, column, 0],
            "error_v_px": found.error_uv_px[row, column, 1],
            "sigma_px": found.sigma_px[row, column],
        }
    )


def point_rows(stage: str, survey: Survey, found: Residuals) -> pd.DataFrame:
    """One row an estimated point of a survey, in map coordinates; columns as in `ESTIMATED_POINTS`."""
    known = np.flatnonzero(np.all(np.isfinite(found.point_m), axis=1))
    position, covariance = found.point_m[known] + survey.origin_m, found.point_covariance[known]
    columns = {name: position[:, k] for k, name in enumerate(POSITION_COLUMNS)}
    columns |= {
        name: covariance[:, i, j]
        for name, (i, j) in zip(POINT_COVARIANCE_COLUMNS, POSITION_COVARIANCE_INDICES, strict=True)
    }
    return pd.DataFrame({"stage": stage, "point": survey.names[known], **columns})


def intraclass_correlation(residuals: pd.DataFrame, column: str) -> float:
    """Share of a residual's variance that all points of an observation have in common: 0 independent, 1 identical.

    The intraclass correlation of one-way analysis of variance; NaN with fewer than two observations of two points.
    """
    groups = residuals.groupby("observation")[column]
    count = groups.count()
    n, total = len(count), int(count.sum())
    if n < 2 or total <= n:
        return float("nan")
    typical = (total - float((count**2).sum()) / total) / (n - 1)
    between = float((count * (groups.mean() - residuals[column].mean()) ** 2).sum()) / (n - 1)
    within = float(((residuals[column] - groups.transform("mean")) ** 2).sum()) / (total - n)
    spread = between + (typical - 1) * within
    return (between - within) / spread if spread > 0 else float("nan")
