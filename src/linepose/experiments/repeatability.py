"""Repeatability: whether disjoint sets of observations give the same pose (section 4.5, Table 5).

Beyond the paper, which compares two subsets by eye: the distance of the two poses in sigmas with its p-value, the
same over many random splits, and what each single observation does to the pose.
"""

from collections.abc import Iterable, Mapping, Sequence

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from linepose.errors import InputError
from linepose.estimation.optimise import Search
from linepose.estimation.sampling import IndependenceSettings, SamplingSettings
from linepose.experiments.estimate import Estimate, estimate_by_curvature, estimate_by_sampling, observation_list
from linepose.geometry.distance import (
    euclidean_distance_m,
    geodesic_angle_rad,
    mahalanobis_between,
    mahalanobis_distance,
    p_value,
)
from linepose.likelihood.base import Likelihood


def check_disjoint(first: Sequence[int], second: Sequence[int], place: str) -> None:
    """Raise InputError, naming `place`, where two subsets share an observation: then they are not independent."""
    shared = sorted(set(first) & set(second))
    if shared:
        raise InputError(
            place, f"observation {observation_list(shared)} in both subsets", "disjoint subsets", "remove it from one"
        )


def consistency(first: Estimate, second: Estimate) -> dict[str, float]:
    """How far two independent estimates lie apart: metres, radians, sigmas, and the p-value of that.

    The last two are NaN where an estimate has no covariance. Raises EstimationError for a singular one.
    """
    known = np.all(np.isfinite(first.covariance + second.covariance))
    distance = (
        mahalanobis_between(first.pose, first.covariance, second.pose, second.covariance) if known else float("nan")
    )
    return {
        "distance_m": float(euclidean_distance_m(first.pose, second.pose)),
        "angle_rad": float(geodesic_angle_rad(first.pose, second.pose)),
        "mahalanobis": distance,
        "p_value": float(p_value(distance)),
    }


def compare_subsets(
    likelihood: Likelihood,
    subsets: Mapping[str, Sequence[int]],
    start: ArrayLike,
    seed: int,
    place: str,
    search: Search | None = None,
    settings: SamplingSettings | IndependenceSettings | None = None,
) -> pd.DataFrame:
    """One row for each of two named subsets, with sampled sigmas; both tell how far apart the two are; start (6,).

    Raises InputError, naming `place`, for subsets that overlap.
    """
    first, second = subsets.values()
    check_disjoint(first, second, place)
    estimates = [
        estimate_by_sampling(likelihood.select(list(numbers)), start, seed, search, settings)
        for numbers in (first, second)
    ]
    agreement = consistency(*estimates)
    rows = [{"subset": name, **estimate.row(), **agreement} for name, estimate in zip(subsets, estimates, strict=True)]
    return pd.DataFrame(rows)


def split_numbers(numbers: ArrayLike, size: int, seed: int, index: int) -> tuple[list[int], list[int]]:
    """Two disjoint random subsets of `size` numbers each, ascending: a function of the seed and the split's index.

    Raises InputError where there are not enough numbers for two subsets.
    """
    available = np.asarray(numbers)
    if size < 1 or 2 * size > len(available):
        raise InputError(
            "repeatability.split_size",
            f"{size}",
            f"1 to {len(available) // 2}, half of the {len(available)} accepted observations",
            "change it",
        )
    random = np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(index,)))
    drawn = random.permutation(available)[: 2 * size]
    return sorted(drawn[:size].tolist()), sorted(drawn[size:].tolist())


def random_splits(
    likelihood: Likelihood, start: ArrayLike, size: int, indices: Iterable[int], seed: int, search: Search | None = None
) -> pd.DataFrame:
    """One row a random split: the two poses, with sigmas from the curvature, and how far they lie apart; start (6,).

    A row depends on the seed and its index alone. Where a subset leaves a direction of the pose open, its sigmas and
    the distance in sigmas are NaN.
    """
    rows = []
    for index in indices:
        halves = split_numbers(likelihood.survey.number, size, seed, index)
        first, second = (estimate_by_curvature(likelihood.select(half), start, search) for half in halves)
        columns = {
            f"{name}_{k}": value
            for k, estimate in enumerate((first, second), 1)
            for name, value in estimate.row().items()
        }
        rows.append({"split": index, **columns, **consistency(first, second)})
    return pd.DataFrame(rows)


def leave_one_out(
    likelihood: Likelihood, pose: ArrayLike, covariance: ArrayLike, search: Search | None = None
) -> pd.DataFrame:
    """One row an observation: the pose without it, and its influence, how far that lies from the full estimate.

    The influence is a distance in sigmas of the full estimate, a pose (6,) with its covariance (6, 6).
    """
    rows = []
    numbers = likelihood.survey.number.tolist()
    for number in numbers:
        rest = likelihood.select([other for other in numbers if other != number])
        without = estimate_by_curvature(rest, pose, search)
        rows.append(
            {
                "left_out": number,
                **without.row(),
                "distance_m": float(euclidean_distance_m(without.pose, pose)),
                "angle_rad": float(geodesic_angle_rad(without.pose, pose)),
                "influence": float(mahalanobis_distance(without.pose, pose, covariance)),
            }
        )
    return pd.DataFrame(rows)
