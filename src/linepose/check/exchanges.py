"""Labels that fit another point than theirs, by the survey's own geometry: two exchanged, or one on another's dot.

The adjustment weighs the few wrong ones down, so that its camera and points are those of the many.
"""

from typing import Final

import numpy as np

from linepose.adjustment.linearise import empty_linearised, linearise
from linepose.adjustment.measurements import Measurements, measurements_from_survey
from linepose.adjustment.reprojection import optics_of
from linepose.adjustment.result import Adjustment
from linepose.arrays import Floats
from linepose.check.finding import Finding, warning
from linepose.geometry.camera import Camera
from linepose.survey.observations import Survey
from linepose.survey.point_names import in_words

_FAR_OFF: Final = 6.0  # times the median error, from which a label is looked at
_FITS: Final = 0.3  # of its error, that the other point leaves
_FEWEST: Final = 4  # labels of a view, whose median error is the body's
_MOST: Final = 5  # of a kind that are named
_MOST_PAIRS: Final = 2_000_000  # that are tried
_SUBJECT: Final = "labels"


def exchange_findings(survey: Survey, camera: Camera, adjusted: Adjustment) -> list[Finding]:
    """Which labels of which observation look exchanged, or lie on another point's dot, of an adjusted survey."""
    measurements = measurements_from_survey(survey, camera)
    error = _errors(measurements, camera, adjusted, np.arange(len(measurements.u_px)), measurements.point)
    common = np.zeros((measurements.n_views, 2))
    for view in range(measurements.n_views):
        mine = error[measurements.view == view]
        common[view] = np.median(mine, axis=0) if len(mine) >= _FEWEST else 0.0
    own = np.linalg.norm(error - common[measurements.view], axis=1)
    far = np.flatnonzero(own > _FAR_OFF * np.median(own))
    far = far[: _MOST_PAIRS // measurements.n_points]
    n_points = measurements.n_points
    rows, others = np.repeat(far, n_points), np.tile(np.arange(n_points), len(far))
    apart = _errors(measurements, camera, adjusted, rows, others) - common[measurements.view[rows]]
    apart = np.nan_to_num(np.linalg.norm(apart, axis=1), nan=np.inf).reshape(len(far), n_points)
    looks_like: dict[tuple[int, int], int] = {}
    for row, distance in zip(far, apart, strict=True):
        best = int(np.argmin(distance))
        if best != measurements.point[row] and distance[best] < _FITS * own[row]:
            looks_like[int(measurements.view[row]), int(measurements.point[row])] = best
    return _told(measurements, survey, looks_like)


def _told(measurements: Measurements, survey: Survey, looks_like: dict[tuple[int, int], int]) -> list[Finding]:
    names, exchanged, landed = survey.names[measurements.points], [], []
    for (view, point), other in looks_like.items():
        number = measurements.number[view]
        if looks_like.get((view, other)) != point:
            landed.append(f"{names[point]} at {names[other]} in observation {number}")
        elif point < other:
            exchanged.append(f"{names[point]} and {names[other]} in observation {number}")
    findings = []
    if exchanged:
        found = f"two points look exchanged: {in_words(exchanged, _MOST)}"
        findings.append(warning(_SUBJECT, found, "look at the scan, and exchange the two labels"))
    if landed:
        found = f"a label lies where another point is expected: {in_words(landed, _MOST)}"
        findings.append(warning(_SUBJECT, found, "look at the scan, and correct or remove the label"))
    return findings


def _errors(
    measurements: Measurements, camera: Camera, adjusted: Adjustment, rows: np.ndarray, points: np.ndarray
) -> Floats:
    """Error (K, 2) in px of measurements (K,) as views of points (K,), at the body poses as reported."""
    optics = optics_of(adjusted, camera)
    out = empty_linearised(len(rows))
    bodies, place = measurements.body_pose[rows], np.ascontiguousarray(adjusted.points_m[measurements.points])
    shifts = measurements.known.shifts
    linearise(measurements.u_px[rows], bodies, np.zeros_like(bodies), points, place, shifts, optics, out)
    return out.residual_px
