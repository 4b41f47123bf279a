"""A survey laid out for the adjustment: observed points only, one row a measurement, in order of time."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.adjustment.known_points import KnownPoints, nothing_known
from linepose.adjustment.motion import body_rates, lateness_of_views
from linepose.adjustment.process import ErrorStructure
from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.geometry.camera import Camera
from linepose.survey.covariance_rule import NEGATIVE, correlations
from linepose.survey.observations import Survey

_ONE_CLOCK: Final = "correct the time stamps: those of all views are of one clock"


@dataclass(frozen=True)
class Measurements:
    """L measurements of K points in N views, in order of time.

    row, column (L,): where in the survey each is; number (N,): of the views, in order of time; view (L,), point (L,):
    row of N and K; points (K,): columns of the survey; u_px (L,); body_pose (L, 6): position (m), Euler angles (rad);
    rate (L, 6): of the body poses by time (s), zero where it is not known; timed: whether the measurements have times;
    known: of the K points.
    """

    row: NDArray[np.int64]
    column: NDArray[np.int64]
    number: NDArray[np.int64]
    view: NDArray[np.int64]
    point: NDArray[np.int64]
    points: NDArray[np.int64]
    u_px: Floats
    body_pose: Floats
    rate: Floats
    structure: ErrorStructure
    timed: bool
    known: KnownPoints

    @property
    def n_points(self) -> int:
        """Number of points K."""
        return len(self.points)

    @property
    def n_views(self) -> int:
        """Number of views N that have a measurement."""
        return len(self.number)


def measurements_from_survey(
    survey: Survey, camera: Camera, known: KnownPoints | None = None, line_period_s: float | None = None
) -> Measurements:
    """The measurements of all points that two views have, or of which something is known.

    A point on a single ray can follow any pose without error: it says nothing, and is left out. Raises InputError where
    no point is left, a body pose or covariance is of no use, or the times of two views overlap.
    """
    known = nothing_known(survey.n_points) if known is None else known.checked(survey.n_points)
    seen = np.isfinite(survey.u_px)
    usable = known.usable(seen.sum(axis=0))
    row, column = np.nonzero(seen & usable)
    if len(row) == 0:
        raise InputError(
            "observations",
            f"{survey.n_observations} observations, no point that two of them have",
            "at least one such point",
            "select more observations of the same pattern",
        )
    time_us = survey.time_us[row, column]
    timed = bool(time_us.max() > time_us.min())
    order, view_rows = _in_order_of_time(survey, row, time_us, timed)
    row, column, time_us = row[order], column[order], time_us[order]
    view = _positions(view_rows, survey.n_observations)[row]
    body_pose = np.concatenate([survey.position_m[row, column], survey.euler_rad[row, column]], axis=1)
    covariance = survey.covariance[row, column]
    _check_finite(survey, row, column, body_pose, covariance)
    begins = np.diff(view, prepend=-1) != 0
    rate = body_rates(body_pose, time_us, view)
    motion, late_px = lateness_of_views(rate, time_us, view, camera.sigmas.v_px, line_period_s)
    gap_s = np.diff(time_us.astype(float), prepend=-np.inf) * 1e-6
    points, point = np.unique(column, return_inverse=True)
    structure = ErrorStructure(
        root=symmetric_roots(covariance, survey.number[row]),
        motion=motion,
        late_px=late_px,
        gap_s=gap_s,
        begins=begins,
        view_of=view,
        sigma_u_px=camera.sigmas.u_px,
    )
    return Measurements(
        row=row,
        column=column,
        number=survey.number[view_rows],
        view=view,
        point=point.astype(np.int64),
        points=points.astype(np.int64),
        u_px=np.ascontiguousarray(survey.u_px[row, column]),
        body_pose=body_pose,
        rate=np.nan_to_num(rate, nan=0.0),
        structure=structure,
        timed=timed,
        known=known.select(points),
    )


def symmetric_roots(covariances: Floats, numbers: NDArray[np.int64]) -> Floats:
    """S R^1/2 (L, 6, 6) of covariances, S the sigmas of each and R^1/2 the symmetric root of its correlations.

    The symmetric root is continuous in the covariance, so that one process can run through all of them. A singular or
    zero covariance is allowed; raises InputError that names the observation (L,) of one with negative eigenvalues.
    """
    variance = np.diagonal(covariances, axis1=1, axis2=2)
    sigma = np.sqrt(np.maximum(variance, 0.0))
    scaled = correlations(covariances)
    values, vectors = np.linalg.eigh((scaled + np.swapaxes(scaled, 1, 2)) / 2)
    negative = values[:, 0] < -NEGATIVE
    if np.any(negative):
        first = int(np.argmax(negative))
        raise InputError(
            f"observation {numbers[first]}",
            f"a covariance with variances {', '.join(f'{one:.3g}' for one in variance[first])} whose correlations have "
            f"the eigenvalue {values[first, 0]:.3g}",
            "a symmetric matrix without negative eigenvalues",
            "check which columns of the navigation record are read",
        )
    roots = (vectors * np.sqrt(np.maximum(values, 0.0))[:, None, :]) @ np.swapaxes(vectors, 1, 2)
    return np.ascontiguousarray(sigma[:, :, None] * roots)


def _in_order_of_time(
    survey: Survey, row: NDArray[np.int64], time_us: NDArray[np.int64], timed: bool
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Order (L,) of the measurements, and the rows (N,) of the survey in that order; as given without times."""
    if not timed:
        return np.arange(len(row)), np.unique(row)
    rows, of_row = np.unique(row, return_inverse=True)
    first, last = np.full(len(rows), np.iinfo(np.int64).max), np.full(len(rows), np.iinfo(np.int64).min)
    np.minimum.at(first, of_row, time_us)
    np.maximum.at(last, of_row, time_us)
    by_time = np.lexsort((last, first))
    rows, first, last = rows[by_time], first[by_time], last[by_time]
    overlap = np.flatnonzero(first[1:] < last[:-1])
    if len(overlap):
        one, two = (int(survey.number[rows[k]]) for k in (overlap[0], overlap[0] + 1))
        raise InputError(
            f"observations {one} and {two}",
            "times that repeat or run back from one to the other",
            "one view after the other",
            "correct the time stamps, or leave one of the two out" if len(overlap) == 1 else _ONE_CLOCK,
        )
    rank = _positions(rows, survey.n_observations)[row]
    return np.lexsort((time_us, rank)), rows


def _positions(rows: NDArray[np.int64], n: int) -> NDArray[np.int64]:
    positions = np.full(n, -1, dtype=np.int64)
    positions[rows] = np.arange(len(rows))
    return positions


def _check_finite(
    survey: Survey, row: NDArray[np.int64], column: NDArray[np.int64], body_pose: Floats, covariance: Floats
) -> None:
    for name, values in (("body pose", body_pose), ("covariance", covariance)):
        bad = np.nonzero(~np.isfinite(values).reshape(len(values), -1).all(axis=1))[0]
        if len(bad):
            raise InputError(
                f"observation {survey.number[row[bad[0]]]}, point {survey.names[column[bad[0]]]}",
                f"a {name} that is not finite",
                "finite numbers for every observed point",
                "correct the navigation record or leave the point out",
            )
