"""Whether labelled points can be right: times, angles, pixels on the sensor, and how many there are of each."""

from typing import Final

import numpy as np
import pandas as pd

from linepose.check.finding import Finding, error, numbers, ok, warning
from linepose.survey.observations import EULER_COLUMNS, POSITION_COLUMNS
from linepose.survey.point_names import in_words

_FEW_POINTS: Final = 4  # of one observation
_USED_SHARE: Final = 0.25  # of the line, below which labels say little of its ends
_DEGREES: Final = 2 * np.pi
_SUBJECT: Final = "labels"


def sensor_findings(points: pd.DataFrame, n_pixels: int) -> list[Finding]:
    """Whether the pixels of points (u_px, place) lie on the sensor and use it."""
    u_px = points["u_px"].to_numpy(dtype=float)
    outside = np.flatnonzero((u_px < -0.5) | (u_px > n_pixels - 0.5))
    if outside.size:
        first = points.iloc[int(outside[0])]
        return [
            error(
                _SUBJECT,
                f"{outside.size} of {len(points)} pixels lie outside the sensor's {n_pixels}; the first is "
                f"{first['u_px']:g} ({first['place']})",
                "correct the labels, or camera.n_pixels; pixels count from 0 along the scan line",
            )
        ]
    used = np.ptp(u_px) / n_pixels
    if used < _USED_SHARE:
        return [
            warning(
                _SUBJECT,
                f"pixels lie between {u_px.min():.0f} and {u_px.max():.0f} of {n_pixels}: "
                f"{100 * used:.0f} % of the line",
                "let the pattern pass through the line's ends too; if it did, check camera.n_pixels",
            )
        ]
    return [ok(_SUBJECT, f"pixels {u_px.min():.0f} to {u_px.max():.0f} of {n_pixels}")]


def count_findings(points: pd.DataFrame, minimum_observations: int | None) -> list[Finding]:
    """How many observations there are, how many points each has, and how often each point was seen.

    `minimum_observations` is that of the outlier removal, None for a noise model that removes none.
    """
    per_view = points.groupby("observation")["point"].nunique()
    per_point = points.groupby("point")["observation"].nunique()
    findings = [
        ok(
            _SUBJECT,
            f"{len(points)} points in {len(per_view)} observations, {per_view.min()} to {per_view.max()} each; "
            f"{len(per_point)} different ones",
        )
    ]
    few = per_view.index[per_view < _FEW_POINTS]
    if len(few):
        findings.append(
            warning(
                _SUBJECT,
                f"observation {numbers(few)}: fewer than {_FEW_POINTS} points",
                "label more of its points, or leave it out: a wrong one cannot be told there",
            )
        )
    alone = per_point.index[per_point < 2]
    if len(alone):
        found = f"point {in_words(alone)}: seen once only, so it says nothing"
        findings.append(warning(_SUBJECT, found, "label it in other observations too, or check its name"))
    if minimum_observations is not None and len(per_view) <= minimum_observations:
        findings.append(
            warning(
                _SUBJECT,
                f"{len(per_view)} observations: none will be removed, for outliers.minimum_observations is "
                f"{minimum_observations}",
                "record more passes (16 or more are a good number), or lower outliers.minimum_observations",
            )
        )
    return findings


def repeated_findings(points: pd.DataFrame) -> list[Finding]:
    """Points that one observation has twice."""
    again = points[points.duplicated(["observation", "point"])]
    if again.empty:
        return []
    first = again.iloc[0]
    found = f"{len(again)} points twice in an observation; the first is point {first['point']} ({first['place']})"
    return [error(_SUBJECT, found, "keep one row for each point of a view, and check the points' names")]


def pose_findings(points: pd.DataFrame) -> list[Finding]:
    """Units of the body poses that came with the points: angles in degrees, positions in degrees."""
    findings = []
    angles = points[list(EULER_COLUMNS)].abs().to_numpy(dtype=float)
    wrong = np.flatnonzero((angles > _DEGREES).any(axis=1))
    if wrong.size:
        first = points.iloc[int(wrong[0])]
        worst = float(first[list(EULER_COLUMNS)].abs().max())
        found = (
            f"{wrong.size} of {len(points)} rows have angles beyond 2 pi; the first is {worst:.4g} ({first['place']})"
        )
        findings.append(error("body pose", found, "convert roll, pitch and yaw from degrees to radians"))
    elif angles.max() == 0:
        findings.append(warning("body pose", "all angles are 0", "check that the columns are roll, pitch, yaw"))
    findings += position_findings(points[list(POSITION_COLUMNS)].to_numpy(dtype=float))
    return findings


def position_findings(position_m: np.ndarray, may_be_geodetic: bool = True) -> list[Finding]:
    """Whether positions (P, 3) north, east, down can be metres: latitude and longitude hardly change at all.

    They cannot be those where they were made of latitude and longitude.
    """
    if len(position_m) > 1 and np.all(np.ptp(position_m, axis=0) == 0):
        advice = "check which columns hold north, east, down" if may_be_geodetic else "bring the log of the drive"
        return [error("body pose", "all positions are the same", advice)]
    extent = np.ptp(position_m[:, :2], axis=0)
    in_degrees = np.all(np.abs(position_m[:, :2]) <= [90.0, 180.0]) and np.all(extent < 1e-3)
    if may_be_geodetic and in_degrees and len(position_m) > 1:
        north, east = position_m[0, :2]
        return [
            error(
                "body pose",
                f"positions ({north:.6g}, {east:.6g}, ...) stay within {extent.max():.2g} of each other: they look "
                "like latitude and longitude",
                "convert them to north and east in metres (a local frame, or UTM)",
            )
        ]
    return []
