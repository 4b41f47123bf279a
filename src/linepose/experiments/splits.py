"""Random splits: how far the poses of disjoint halves lie apart, and what that says of the sigmas."""

import logging
from collections.abc import Iterable
from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.errors import EstimationError, InputError
from linepose.estimation.estimator import Estimator
from linepose.experiments.agreement import AGREEMENT, pair_row
from linepose.experiments.estimate import estimate_fields
from linepose.experiments.experiment import Experiment
from linepose.experiments.inputs import Inputs
from linepose.experiments.repeatability import SECTION
from linepose.geometry.pose import N_PARAMETERS
from linepose.pipeline.batches import batch_ranges
from linepose.tables import whole_numbers

_logger = logging.getLogger(__name__)
_BATCH: Final = 2  # a split may take half a minute: progress is told, and cores are busy, to the end

SPLITS: Final = pa.schema([*whole_numbers("split"), *estimate_fields("_1"), *estimate_fields("_2"), *AGREEMENT])


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


def random_splits(estimator: Estimator, start: ArrayLike, size: int, indices: Iterable[int], seed: int) -> pd.DataFrame:
    """One row a random split: the two poses, without samples, and how far they lie apart; start (6,).

    A row depends on the seed and its index alone. Where a subset leaves a direction of the pose open, its sigmas and
    the distance in sigmas are NaN.
    """
    rows = []
    for index in indices:
        halves = split_numbers(estimator.survey.number, size, seed, index)
        first, second = (estimator.select(half).estimate(start) for half in halves)
        rows.append({"split": index, **pair_row(first, second)})
    return pd.DataFrame(rows)


def known_distances(splits: pd.DataFrame) -> Floats:
    """Distances in sigmas (K,) of the splits that determine both poses.

    `splits` as in `SPLITS`; raises EstimationError where there is none.
    """
    distance = splits["mahalanobis"].to_numpy(dtype=float)
    known = distance[np.isfinite(distance)]
    if not known.size:
        raise EstimationError(
            "random splits: none determines both poses; lower repeatability.split_size is no remedy, "
            "more observations are"
        )
    return known


def sigma_factor(splits: pd.DataFrame) -> float:
    """By how much the sigmas would have to grow for the splits' median distance to be what right sigmas give."""
    from scipy.stats import chi  # slow to import

    return float(np.median(known_distances(splits)) / chi.median(N_PARAMETERS))


def _run(inputs: Inputs) -> dict[str, pd.DataFrame]:
    settings, estimator = inputs.required(SECTION), inputs.data.accepted
    size = settings.split_size or estimator.survey.n_observations // 2
    ranges = batch_ranges(settings.n_splits, _BATCH)
    start, seed = inputs.reference.pose, inputs.seed
    table = inputs.in_batches(
        lambda name: random_splits(estimator, start, size, ranges[name], seed), list(ranges), SPLITS
    )
    _logger.info("%d splits, %.0f %% with p < 0.05", len(table), 100 * (table["p_value"] < 0.05).mean())
    return {"splits": table}


EXPERIMENT: Final = Experiment(
    name="splits",
    title="Random disjoint subsets",
    outputs={"splits": SPLITS},
    run=_run,
    section=SECTION,
    wanted=lambda settings: settings and settings.n_splits,
    cores=None,
)
