"""Basin of attraction: from how far away a search still finds the optimum (sections 3.8 and 4.7).

A uniform grid over distance and angle from the reference pose; in each cell one start, with the cell's distance in a
random direction and the cell's angle about a random axis.
"""

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike
from scipy.stats import binomtest

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.estimation.optimise import Search
from linepose.estimation.optimisers import optimiser
from linepose.geometry.distance import mahalanobis_distance
from linepose.geometry.pose import N_PARAMETERS, POSE_COLUMNS
from linepose.geometry.rotations import matrix_from_rotation_vector, rotation_vector_from_matrix
from linepose.likelihood.base import Likelihood

START_COLUMNS = tuple(f"start_{name}" for name in POSE_COLUMNS)


@dataclass(frozen=True)
class BasinGrid:
    """Cells of equal size over distance and angle; cell `i * n_angles + j` is the i-th in distance, j-th in angle."""

    maximum_distance_m: float = 2.0
    maximum_angle_rad: float = float(np.pi / 3)
    n_distances: int = 30
    n_angles: int = 30

    def __post_init__(self) -> None:
        for key, size in (("n_distances", self.n_distances), ("n_angles", self.n_angles)):
            if size < 1:
                raise InputError(f"basin.{key}", f"{size}", "at least one cell", "raise it")
        for key, extent in (("maximum_distance", self.maximum_distance_m), ("maximum_angle", self.maximum_angle_rad)):
            if not extent > 0:
                raise InputError(f"basin.{key}", f"{extent:g}", "a number above zero", "raise it")

    @property
    def n_cells(self) -> int:
        """Number of cells, each with one start."""
        return self.n_distances * self.n_angles

    def offset(self, cell: int) -> tuple[float, float]:
        """Distance (m) and angle (rad) from the reference at a cell's centre."""
        i, j = divmod(cell, self.n_angles)
        return (
            (i + 0.5) * self.maximum_distance_m / self.n_distances,
            (j + 0.5) * self.maximum_angle_rad / self.n_angles,
        )


@dataclass(frozen=True)
class Region:
    """The triangle that the paper claims: `distance / distance_m + angle / angle_rad < 1`."""

    distance_m: float = 0.5
    angle_rad: float = float(np.radians(20.0))

    def holds(self, distance_m: ArrayLike, angle_rad: ArrayLike) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
        """Whether starts at these distances and angles lie inside; (...) each to (...)."""
        share = np.asarray(distance_m) / self.distance_m + np.asarray(angle_rad) / self.angle_rad
        return np.asarray(share < 1)


def start_pose(grid: BasinGrid, reference: ArrayLike, seed: int, cell: int) -> Floats:
    """The start (6,) of one cell around a reference pose (6,): a function of the seed and the cell alone."""
    pose = np.asarray(reference, dtype=float)[:N_PARAMETERS]
    distance_m, angle_rad = grid.offset(cell)
    random = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(cell,)))
    direction, axis = (vector / np.linalg.norm(vector) for vector in random.standard_normal((2, 3)))
    turned = matrix_from_rotation_vector(angle_rad * axis) @ matrix_from_rotation_vector(pose[3:])
    return np.concatenate([pose[:3] + distance_m * direction, rotation_vector_from_matrix(turned)])


@dataclass(frozen=True)
class Sweep:
    """A search from every cell: by which likelihood, around which reference pose (6,) with its covariance (6, 6).

    Success is a Mahalanobis distance to the reference below the threshold.
    """

    likelihood: Likelihood
    reference: Floats
    covariance: Floats
    grid: BasinGrid
    seed: int
    search: Search = field(default_factory=Search)
    threshold: float = 0.1

    def attempt(self, optimiser_name: str, cell: int) -> dict[str, object]:
        """One row: a cell's start, where the search from it ended, and whether that is the reference."""
        distance_m, angle_rad = self.grid.offset(cell)
        start = start_pose(self.grid, self.reference, self.seed, cell)
        found = optimiser(optimiser_name)(self.likelihood, start, self.search)
        pose = found.parameters[:N_PARAMETERS]
        mahalanobis = float(mahalanobis_distance(pose, self.reference, self.covariance))
        return {
            "optimiser": optimiser_name,
            "cell": cell,
            "distance_m": distance_m,
            "angle_rad": angle_rad,
            **dict(zip(START_COLUMNS, start, strict=True)),
            **dict(zip(POSE_COLUMNS, pose, strict=True)),
            "neg_log_likelihood": found.neg_log_likelihood,
            "n_evaluations": found.n_evaluations,
            "mahalanobis": mahalanobis,
            "success": mahalanobis < self.threshold,
        }

    def rows(self, optimiser_name: str, cells: Iterable[int]) -> pd.DataFrame:
        """One row a cell; each depends on its cell alone, not on which others are swept with it."""
        return pd.DataFrame([self.attempt(optimiser_name, cell) for cell in cells])


def summarise(sweep: pd.DataFrame, region: Region) -> pd.DataFrame:
    """Success rates inside the region, outside it and of the whole grid, with 95 % Wilson intervals; one row each."""
    inside = region.holds(sweep["distance_m"], sweep["angle_rad"])
    rows = []
    for name, rows_of in (("inside", inside), ("outside", ~inside), ("all", np.full(len(sweep), True))):
        part = sweep[rows_of]
        successes = int(part["success"].sum())
        low, high = wilson_interval(successes, len(part))
        rows.append(
            {
                "region": name,
                "n_starts": len(part),
                "n_successes": successes,
                "success_rate": successes / len(part) if len(part) else np.nan,
                "success_rate_low": low,
                "success_rate_high": high,
                "median_n_evaluations": float(part["n_evaluations"].median()),
            }
        )
    return pd.DataFrame(rows)


def wilson_interval(successes: int, trials: int, confidence: float = 0.95) -> tuple[float, float]:
    """Wilson's interval of a rate; (NaN, NaN) without trials."""
    if trials == 0:
        return (float("nan"), float("nan"))
    interval = binomtest(successes, trials).proportion_ci(confidence, method="wilson")
    return (float(interval.low), float(interval.high))
