"""The compiled likelihood: Eq. 11-22 for one pose, and for many poses on all cores."""

import hashlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numba import config as numba_config
from numba import get_thread_id, njit, prange  # type: ignore[attr-defined]

from linepose.arrays import Floats
from linepose.compiling import kernels
from linepose.compiling.kernels import FUSED_ARITHMETIC, kernel_part
from linepose.likelihood import layout as at
from linepose.likelihood.estimate import accumulate_pairs, solve_points
from linepose.likelihood.layout import LANES
from linepose.likelihood.pairs import intersect
from linepose.likelihood.rays import camera_axes, propagate_covariances, trace_rays
from linepose.likelihood.reprojection import reproject

MAXIMUM_THREADS: int = numba_config.NUMBA_NUM_THREADS  # type: ignore[attr-defined]
_SOURCES = ("estimate", "kernel", "layout", "pairs", "rays", "reprojection")


@dataclass(frozen=True)
class Workspace:
    """Scratch arrays for `count` evaluations at a time, N observations.

    rays (count, N, RAY_COLUMNS), sums (count, N, SUM_COLUMNS), points (count, POINT_COLUMNS), residuals
    (count, N, RESIDUAL_COLUMNS); the last two hold the results of the block that was evaluated last.
    """

    rays: Floats
    sums: Floats
    points: Floats
    residuals: Floats


def workspace(n_observations: int, count: int) -> Workspace:
    """Scratch arrays for `count` evaluations at a time."""
    return Workspace(
        rays=np.zeros((count, n_observations, at.RAY_COLUMNS)),
        sums=np.zeros((count, n_observations, at.SUM_COLUMNS)),
        points=np.zeros((count, at.POINT_COLUMNS)),
        residuals=np.zeros((count, n_observations, at.RESIDUAL_COLUMNS)),
    )


@kernel_part
def _evaluate(
    survey: Floats,
    pose: Floats,
    rays: Floats,
    sums: Floats,
    points: Floats,
    residuals: Floats,
    max_behind_camera: float,
) -> float:
    axes = np.empty((3, 3))
    scores = np.zeros(2 * LANES)
    camera_axes(pose, axes)
    for block in range(survey.shape[0]):
        rows = survey[block]
        trace_rays(rows, pose, axes, rays)
        propagate_covariances(rows, pose, axes, rays)
        intersect(rays, rays, sums, sums)
        accumulate_pairs(rays, sums, points)
        solve_points(points)
        reproject(rows, pose, axes, rays, points, residuals, scores)
    total, behind = 0.0, 0.0
    for lane in range(LANES):
        total += scores[lane]
        behind += scores[LANES + lane]
    return -0.5 * total if behind <= max_behind_camera and total < np.inf else -np.inf


def _digest() -> str:
    folder = Path(__file__).parent
    sources = [Path(kernels.__file__), *(folder / f"{name}.py" for name in _SOURCES)]
    return hashlib.sha256(b"".join(path.read_bytes() for path in sources)).hexdigest()


def _compiled(sources: str) -> tuple[Callable[..., Any], Callable[..., Any]]:
    """The two entry points. `sources` becomes part of the key of the cache on disk, which else knows this file only."""

    @njit(cache=True, error_model="numpy", fastmath=FUSED_ARITHMETIC)
    def evaluate(survey, pose, rays, sums, points, residuals, max_behind_camera):  # type: ignore[no-untyped-def]  # noqa: ANN001, ANN202
        _ = sources
        return _evaluate(survey, pose, rays[0], sums[0], points[0], residuals[0], max_behind_camera)

    @njit(cache=True, parallel=True, error_model="numpy", fastmath=FUSED_ARITHMETIC)
    def evaluate_rows(survey, poses, rays, sums, points, residuals, max_behind_camera, out):  # type: ignore[no-untyped-def]  # noqa: ANN001, ANN202
        _ = sources
        for row in prange(poses.shape[0]):
            own = get_thread_id()
            out[row] = _evaluate(
                survey, poses[row], rays[own], sums[own], points[own], residuals[own], max_behind_camera
            )

    return evaluate, evaluate_rows


evaluate, evaluate_rows = _compiled(_digest())
