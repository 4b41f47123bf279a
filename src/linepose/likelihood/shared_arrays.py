"""A survey laid out for the shared-error kernels: observed points only, one row each, view after view."""

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.geometry import rotations
from linepose.survey.observations import Survey

NEGATIVE_EIGENVALUE: Final = 1e-9  # of the largest of the same kind: rounding in a file, not an invalid covariance


class SharedArrays(NamedTuple):
    """N views, K points that at least two views have, L lines: observed points of those, in order of the views.

    view_first (N + 1,): first line of each view, and L; line_view, line_point (L,): the view and the point of each;
    u_px (L,); position_m (L, 3); world_from_body (L, 3, 3); euler_axes (L, 3, 3): small rotation in the world by roll,
    pitch, yaw; covariance (L, 6, 6): as reported; shared_root (N, 6, 6): F with `F F^T` the view's mean covariance.
    motion (L, 7): what the body moves (m, rad) while the point crosses one pixel, and how far along the line that is
    allowed for (px); NaN where the body's motion does not matter.
    """

    view_first: NDArray[np.int64]
    line_view: NDArray[np.int64]
    line_point: NDArray[np.int64]
    u_px: Floats
    position_m: Floats
    world_from_body: Floats
    euler_axes: Floats
    covariance: Floats
    shared_root: Floats
    motion: Floats


def observed_lines(survey: Survey) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Row and point (L,) of every line of a point that at least two observations have.

    A point on a single ray can follow any pose without error: it says nothing, and is left out.
    """
    seen = np.isfinite(survey.u_px)
    row, point = np.nonzero(seen & (seen.sum(axis=0) >= 2))
    return row.astype(np.int64), point.astype(np.int64)


def shared_arrays(survey: Survey) -> tuple[SharedArrays, NDArray[np.int64]]:
    """The survey's lines, and the pattern points (K,) that they see.

    Raises InputError where no point has two rays, or a used body pose or covariance is not usable.
    """
    row, point = observed_lines(survey)
    if len(row) == 0:
        raise InputError(
            "observations",
            "no point that two observations have",
            "at least one",
            "select more observations of the same pattern",
        )
    points, line_point = np.unique(point, return_inverse=True)
    position, euler, covariance = (a[row, point] for a in (survey.position_m, survey.euler_rad, survey.covariance))
    for name, values in (("body position", position), ("body angles", euler), ("covariance", covariance)):
        _check_finite(survey, row, point, name, values)
    roots = np.stack(
        [
            _root(covariance[row == view].mean(axis=0) if np.any(row == view) else np.zeros((6, 6)), int(number))
            for view, number in enumerate(survey.number)
        ]
    )
    for line, matrix in enumerate(covariance):
        _root(matrix, int(survey.number[row[line]]))
    arrays = SharedArrays(
        view_first=np.searchsorted(row, np.arange(survey.n_observations + 1)).astype(np.int64),
        line_view=row,
        line_point=line_point.astype(np.int64),
        u_px=np.ascontiguousarray(survey.u_px[row, point]),
        position_m=np.ascontiguousarray(position),
        world_from_body=np.ascontiguousarray(rotations.matrix_from_euler(euler)),
        euler_axes=np.ascontiguousarray(rotations.small_rotation_by_euler(euler)),
        covariance=np.ascontiguousarray(covariance),
        shared_root=roots,
        motion=np.full((len(row), 7), np.nan),
    )
    return arrays, points


def _check_finite(survey: Survey, row: NDArray[np.int64], point: NDArray[np.int64], name: str, values: Floats) -> None:
    bad = np.nonzero(~np.isfinite(values).reshape(len(values), -1).all(axis=1))[0]
    if len(bad):
        raise InputError(
            f"observation {survey.number[row[bad[0]]]}, point {point[bad[0]]}",
            f"a {name} that is not finite",
            "finite numbers for every observed point",
            "correct the navigation record or leave the point out",
        )


def _root(covariance: Floats, number: int) -> Floats:
    """F (6, 6) with `F F^T` the covariance, which may be singular or zero but not negative.

    Positions and angles differ in unit: scaled to a unit diagonal before the eigenvalues are looked at.
    """
    variance = np.diagonal(covariance)
    scale = np.sqrt(np.maximum(variance, 0.0))
    safe = np.where(scale > 0, scale, 1.0)
    values, vectors = np.linalg.eigh((covariance / safe / safe[:, None] + (covariance / safe / safe[:, None]).T) / 2)
    if np.any(variance < 0) or values[0] < -NEGATIVE_EIGENVALUE * max(values[-1], 1.0):
        raise InputError(
            f"observation {number}",
            f"a covariance with variances {variance.tolist()} that is not positive semidefinite",
            "a symmetric matrix without negative eigenvalues",
            "check which columns of the navigation record are read",
        )
    return scale[:, None] * vectors * np.sqrt(np.maximum(values, 0.0))
