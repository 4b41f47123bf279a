"""Basin of attraction: from how far away a search still finds the optimum (sections 3.8 and 4.7).

A uniform grid over distance and angle from the reference pose; in each cell one start, with the cell's distance in a
random direction and the cell's angle about a random axis.
"""

import logging
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np
import pandas as pd
import pyarrow as pa
from numpy.typing import ArrayLike
from pydantic import Field, PositiveFloat, PositiveInt

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.estimation.estimator import Estimator
from linepose.experiments.experiment import Experiment
from linepose.experiments.inputs import Inputs, log_rows
from linepose.experiments.section import Section
from linepose.geometry.distance import mahalanobis_distance
from linepose.geometry.pose import N_PARAMETERS, POSE_COLUMNS
from linepose.geometry.rotations import matrix_from_rotation_vector, rotation_vector_from_matrix
from linepose.pipeline.batches import batch_ranges
from linepose.settings import Settings
from linepose.tables import flags, floats, optional_floats, texts, whole_numbers

_logger = logging.getLogger(__name__)
OptimiserName = Literal["gauss_newton", "powell", "powell_in_front", "wide"]
START_COLUMNS = tuple(f"start_{name}" for name in POSE_COLUMNS)

BASIN: Final = pa.schema(
    [
        *texts("optimiser"),
        *whole_numbers("cell"),
        *floats("distance_m", "angle_rad", *START_COLUMNS),
        *optional_floats(*POSE_COLUMNS, "neg_log_likelihood"),
        *whole_numbers("n_evaluations"),
        *floats("mahalanobis"),
        *flags("success"),
    ]
)
BASIN_SUMMARY: Final = pa.schema(
    [
        *texts("optimiser", "region"),
        *whole_numbers("n_starts", "n_successes"),
        *optional_floats("success_rate", "success_rate_low", "success_rate_high", "median_n_evaluations"),
    ]
)


class BasinSettings(Settings):
    """From how far away the optimum is found. One start in each cell of a grid over distance and angle.

    Cell `i * n_angles + j` is the i-th in distance and the j-th in angle.
    """

    maximum_distance_m: PositiveFloat = Field(2.0, description="The grid reaches this far from the optimum (m).")
    maximum_angle_deg: float = Field(60.0, gt=0, le=180, description="The grid reaches this angle from it (deg).")
    n_distances: int = Field(30, gt=0, le=1_000, description="Cells over the distance.")
    n_angles: int = Field(30, gt=0, le=1_000, description="Cells over the angle.")
    optimisers: list[OptimiserName] = Field(
        [],
        description="Searches to compare on the same starts; the noise model's usual ones if empty. Of the adjustment: "
        "gauss_newton. Of a likelihood: powell: on the paper's equations, where points behind the "
        "camera count as if in front, and with rotation components within +- pi. powell_in_front: as the poses are "
        "found, such points excluded, all ranges centred on the start. wide: rotations first, then least squares, then "
        "Powell.",
    )
    success_threshold: PositiveFloat = Field(
        0.1, description="A success ends nearer to the optimum than this (sigmas)."
    )
    region_distance_m: PositiveFloat = Field(0.5, description="The claimed region is a triangle with this leg (m) ...")
    region_angle_deg: PositiveFloat = Field(20.0, description="... and this one (deg).")
    batch_size: PositiveInt = Field(15, description="Starts between two savings; no result depends on it.")

    @property
    def n_cells(self) -> int:
        """Number of cells, each with one start."""
        return self.n_distances * self.n_angles

    def offset(self, cell: int) -> tuple[float, float]:
        """Distance (m) and angle (rad) from the reference at a cell's centre."""
        i, j = divmod(cell, self.n_angles)
        return (
            (i + 0.5) * self.maximum_distance_m / self.n_distances,
            (j + 0.5) * float(np.deg2rad(self.maximum_angle_deg)) / self.n_angles,
        )

    def region(self) -> "Region":
        """The triangle that is claimed."""
        return Region(self.region_distance_m, float(np.deg2rad(self.region_angle_deg)))


SECTION: Final = Section("basin", BasinSettings, BasinSettings(), "Basin of attraction.")


@dataclass(frozen=True)
class Region:
    """The triangle that the paper claims: `distance / distance_m + angle / angle_rad < 1`."""

    distance_m: float
    angle_rad: float

    def holds(self, distance_m: ArrayLike, angle_rad: ArrayLike) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
        """Whether starts at these distances and angles lie inside; (...) each to (...)."""
        share = np.asarray(distance_m) / self.distance_m + np.asarray(angle_rad) / self.angle_rad
        return np.asarray(share < 1)


def start_pose(grid: BasinSettings, reference: ArrayLike, seed: int, cell: int) -> Floats:
    """The start (6,) of one cell around a reference pose (6,): a function of the seed and the cell alone."""
    pose = np.asarray(reference, dtype=float)[:N_PARAMETERS]
    distance_m, angle_rad = grid.offset(cell)
    random = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(cell,)))
    direction, axis = (vector / np.linalg.norm(vector) for vector in random.standard_normal((2, 3)))
    turned = matrix_from_rotation_vector(angle_rad * axis) @ matrix_from_rotation_vector(pose[3:])
    return np.concatenate([pose[:3] + distance_m * direction, rotation_vector_from_matrix(turned)])


@dataclass(frozen=True)
class Sweep:
    """A search from every cell: by which estimator, around which reference pose (6,) with its covariance (6, 6).

    Success is a Mahalanobis distance to the reference below the threshold.
    """

    estimator: Estimator
    reference: Floats
    covariance: Floats
    grid: BasinSettings
    seed: int
    threshold: float = 0.1

    def attempt(self, optimiser_name: str, cell: int) -> dict[str, object]:
        """One row: a cell's start, where the search from it ended, and whether that is the reference."""
        distance_m, angle_rad = self.grid.offset(cell)
        start = start_pose(self.grid, self.reference, self.seed, cell)
        found = self.estimator.search_by(optimiser_name, start)
        known = np.all(np.isfinite(found.pose))
        mahalanobis = float(mahalanobis_distance(found.pose, self.reference, self.covariance)) if known else np.inf
        return {
            "optimiser": optimiser_name,
            "cell": cell,
            "distance_m": distance_m,
            "angle_rad": angle_rad,
            **dict(zip(START_COLUMNS, start, strict=True)),
            **dict(zip(POSE_COLUMNS, found.pose, strict=True)),
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
    from scipy.stats import binomtest  # slow to import

    interval = binomtest(successes, trials).proportion_ci(confidence, method="wilson")
    return (float(interval.low), float(interval.high))


def chosen_searches(estimator: Estimator, names: Sequence[str], file: str) -> tuple[str, ...]:
    """Names of the searches to sweep; raises InputError, naming the platform's file, for one that there is not."""
    known = estimator.searches()
    unknown = [name for name in names if name not in known]
    if unknown:
        place = f"{file}: experiments.{SECTION.key}.optimisers"
        raise InputError(place, unknown[0], f"of {', '.join(known)}", "correct the name, or leave the key out")
    return tuple(names) or known[:2]


def _run(inputs: Inputs) -> dict[str, pd.DataFrame]:
    settings, reference = inputs.required(SECTION), inputs.reference
    sweep = Sweep(
        inputs.data.accepted,
        reference.pose,
        reference.covariance,
        settings,
        inputs.seed,
        settings.success_threshold,
    )
    ranges = batch_ranges(settings.n_cells, settings.batch_size)
    names = chosen_searches(inputs.data.accepted, settings.optimisers, inputs.file)
    parts = {f"{name}-{part}": (name, cells) for name in names for part, cells in ranges.items()}
    table = inputs.in_batches(lambda part: sweep.rows(*parts[part]), list(parts), BASIN)
    of_each = table.groupby("optimiser", sort=False)
    summary = pd.concat(
        [summarise(rows, settings.region()).assign(optimiser=name) for name, rows in of_each], ignore_index=True
    )
    log_rows(_logger, "%s, %s: %d of %d starts succeed", summary, ("optimiser", "region", "n_successes", "n_starts"))
    return {"basin": table, "basin_summary": summary}


EXPERIMENT: Final = Experiment(
    name="basin",
    title="Basin of attraction",
    outputs={"basin": BASIN, "basin_summary": BASIN_SUMMARY},
    run=_run,
    section=SECTION,
    cores=None,
)
