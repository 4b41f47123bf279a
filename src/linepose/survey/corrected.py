"""Tables, logs and covariances with `navigation.corrections` made."""

from collections.abc import Sequence
from dataclasses import replace

import pandas as pd

from linepose.arrays import Floats
from linepose.survey.navigation import NavigationCovariances
from linepose.survey.navigation_corrections import CORRECTIONS
from linepose.survey.observations import EULER_COLUMNS, POSITION_COLUMNS


def corrected_poses(position_m: Floats, euler_rad: Floats, names: Sequence[str]) -> tuple[Floats, Floats]:
    """Positions (K, 3) and roll, pitch, yaw (K, 3) with these corrections, made one after the other."""
    for name in names:
        position_m, euler_rad = CORRECTIONS[name].of_positions(position_m), CORRECTIONS[name].of_angles(euler_rad)
    return position_m, euler_rad


def corrected_points(points: pd.DataFrame, names: Sequence[str]) -> pd.DataFrame:
    """A table of points with body poses, these corrected."""
    if not names:
        return points
    columns = [*POSITION_COLUMNS, *EULER_COLUMNS]
    values = points[columns].to_numpy(dtype=float)
    position, euler = corrected_poses(values[:, :3], values[:, 3:], names)
    return points.assign(**dict(zip(columns, [*position.T, *euler.T], strict=True)))


def corrected_covariances(reported: NavigationCovariances, names: Sequence[str]) -> NavigationCovariances:
    """Covariances of a log with these corrections, made one after the other."""
    covariance = reported.covariance
    for name in names:
        covariance = CORRECTIONS[name].of_covariances(covariance)
    return replace(reported, covariance=covariance) if names else reported
