"""Whether disjoint observations agree as the sigmas of a noise model promise.

Two independent estimates of one pose differ by a Mahalanobis distance whose square is chi-square distributed with six
degrees of freedom, if the covariances are right; if they are too small, it is larger.
"""

import logging
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.estimation.noise_models import PUBLISHED, SHARED, likelihood_of
from linepose.estimation.optimise import Search
from linepose.experiments.agreement import AGREEMENT, pair_row
from linepose.experiments.estimate import Estimate, estimate_fields, estimate_nearby
from linepose.experiments.experiment import Experiment
from linepose.experiments.inputs import Inputs, log_rows
from linepose.experiments.noise_models import INLIERS, NOISE_MODELS, SECTION
from linepose.experiments.repeatability import SECTION as REPEATABILITY_SECTION
from linepose.experiments.repeatability import named_pair
from linepose.experiments.splits import split_numbers
from linepose.geometry.camera import Camera
from linepose.geometry.pose import N_PARAMETERS, POSE_COLUMNS
from linepose.likelihood.base import Likelihood
from linepose.pipeline.batches import batch_ranges
from linepose.survey.observations import Survey
from linepose.tables import optional_floats, texts, whole_numbers

_logger = logging.getLogger(__name__)
NAMED_SUBSETS: Final = "the two named subsets"
MINIMUM_OBSERVATIONS: Final = 4

CONSISTENCY: Final = pa.schema(
    [
        *texts("noise_model", "comparison"),
        *whole_numbers("split"),
        *estimate_fields("_1"),
        *estimate_fields("_2"),
        *AGREEMENT,
    ]
)
CONSISTENCY_SUMMARY: Final = pa.schema(
    [
        *texts("noise_model", "comparison"),
        *whole_numbers("n_splits", "n_open"),
        *optional_floats("median_distance", "sigma_factor", "share_beyond_68", "share_beyond_95"),
        *optional_floats("kolmogorov", "largest_distance"),
    ]
)


@dataclass(frozen=True)
class Group:
    """Observations under one noise model: the likelihood, and the optimum (P,) of them all, where searches start."""

    likelihood: Likelihood
    optimum: Floats


@dataclass(frozen=True)
class Comparisons:
    """What is compared: groups of observations by noise model and name, the platform's own first in each model.

    `subsets` are two disjoint sets of observation numbers of the first group, or none; the search's range lies around
    the start pose (6,).
    """

    groups: Mapping[str, Mapping[str, Group]]
    subsets: Sequence[Sequence[int]]
    start: Floats
    seed: int
    search: Search = field(default_factory=Search)

    def parts(self, n_splits: int, batch_size: int) -> dict[str, Callable[[], pd.DataFrame]]:
        """All the work in parts that do not depend on each other, by a name that is a file's.

        Raises InputError for a group of too few observations for two halves.
        """
        work: dict[str, Callable[[], pd.DataFrame]] = {}
        for noise_model, groups in self.groups.items():
            if len(groups) > 1 or self.subsets:
                work[f"{noise_model}-pairs"] = partial(self.pairs, noise_model)
            for name, group in groups.items():
                _check_halves(name, group.likelihood.survey.n_observations)
                for place, indices in batch_ranges(n_splits, batch_size).items():
                    work[f"{noise_model}-{name}-{place}"] = partial(self.random_halves, noise_model, name, indices)
        return work

    def pairs(self, noise_model: str) -> pd.DataFrame:
        """One row a pair: the first group against each other one, and the two subsets."""
        groups = self.groups[noise_model]
        names = list(groups)
        rows = []
        if len(names) > 1:
            whole = {name: self._estimate(group, group.likelihood.survey.number) for name, group in groups.items()}
            rows += [
                _compared(noise_model, f"{names[0]} against {other}", 0, whole[names[0]], whole[other])
                for other in names[1:]
            ]
        if self.subsets:
            first, second = (self._estimate(groups[names[0]], numbers) for numbers in self.subsets)
            rows.append(_compared(noise_model, NAMED_SUBSETS, 0, first, second))
        return pd.DataFrame(rows)

    def random_halves(self, noise_model: str, name: str, indices: Iterable[int]) -> pd.DataFrame:
        """One row a random split of a group into disjoint halves; the seed and the index alone decide it."""
        group = self.groups[noise_model][name]
        number = group.likelihood.survey.number
        rows = []
        for index in indices:
            halves = split_numbers(number, len(number) // 2, self.seed, index)
            first, second = (self._estimate(group, half) for half in halves)
            rows.append(_compared(noise_model, f"random halves of {name}", index, first, second))
        return pd.DataFrame(rows)

    def _estimate(self, group: Group, numbers: ArrayLike) -> Estimate:
        selected = group.likelihood.select([int(number) for number in np.asarray(numbers)])
        return estimate_nearby(selected, group.optimum, self.start, self.search)


def _check_halves(name: str, n_observations: int) -> None:
    if n_observations < MINIMUM_OBSERVATIONS:
        raise InputError(
            f"experiments.noise_models: {name}",
            f"{n_observations} accepted observations",
            f"at least {MINIMUM_OBSERVATIONS}, two in each half",
            "leave the experiment out, or raise outliers.threshold_px",
        )


def _compared(noise_model: str, comparison: str, split: int, first: Estimate, second: Estimate) -> dict[str, object]:
    row = {"noise_model": noise_model, "comparison": comparison, "split": split}
    return row | pair_row(first, second)


def groups_of(
    surveys: Mapping[str, Survey], sets: Mapping[str, str], camera: Camera, estimates: pd.DataFrame
) -> dict[str, dict[str, Group]]:
    """The published and the shared model of each survey, with its optimum from a table of `noise_model_table`.

    `sets` names the table's set of each survey.
    """
    known = estimates.set_index(["noise_model", "set"])
    groups: dict[str, dict[str, Group]] = {}
    for noise_model in (PUBLISHED.name, SHARED.name):
        groups[noise_model] = {}
        for name, survey in surveys.items():
            estimate = known.loc[(noise_model, sets[name])]
            likelihood = likelihood_of(noise_model, survey, camera, estimate[list(POSE_COLUMNS)].to_numpy(dtype=float))
            row = estimate[list(likelihood.parameter_names)]
            groups[noise_model][name] = Group(likelihood, row.to_numpy(dtype=float))
    return groups


def summarise_consistency(table: pd.DataFrame) -> pd.DataFrame:
    """One row a noise model and comparison: the distances' distribution beside that of right sigmas.

    `sigma_factor` is what the sigmas would have to grow by for the median to fit; `kolmogorov` the largest gap between
    the distances' cumulative distribution and chi's with six degrees of freedom. Splits that leave a direction of the
    pose open count as `n_open` and in nothing else. Columns as in `CONSISTENCY_SUMMARY`.
    """
    from scipy.stats import chi, kstest  # slow to import

    rows = []
    for (noise_model, name), part in table.groupby(["noise_model", "comparison"], sort=False):
        distance = part["mahalanobis"].to_numpy(dtype=float)
        known = distance[np.isfinite(distance)]
        median = float(np.median(known)) if known.size else float("nan")
        rows.append(
            {
                "noise_model": noise_model,
                "comparison": name,
                "n_splits": len(known),
                "n_open": len(distance) - len(known),
                "median_distance": median,
                "sigma_factor": median / float(chi.median(N_PARAMETERS)),
                "share_beyond_68": _beyond(known, 0.68),
                "share_beyond_95": _beyond(known, 0.95),
                "kolmogorov": float(kstest(known, chi(N_PARAMETERS).cdf).statistic) if known.size else float("nan"),
                "largest_distance": float(known.max()) if known.size else float("nan"),
            }
        )
    return pd.DataFrame(rows)


def _beyond(distance: Floats, content: float) -> float:
    from scipy.stats import chi

    return float(np.mean(distance > chi.ppf(content, N_PARAMETERS))) if distance.size else float("nan")


def _run(inputs: Inputs) -> dict[str, pd.DataFrame]:
    platform, data, settings = inputs.platform, inputs.data, inputs.required(SECTION)
    surveys = {inputs.name: data.accepted.survey}
    surveys |= {name: other.accepted.survey for name, other in inputs.other_data.items()}
    sets = {name: name for name in surveys} | {inputs.name: INLIERS}
    comparisons = Comparisons(
        groups_of(surveys, sets, platform.intrinsics(), inputs.table("noise_models", NOISE_MODELS)),
        list(named_pair(data, inputs.settings(REPEATABILITY_SECTION), inputs.file).values()),
        platform.start_pose(),
        inputs.seed,
        inputs.search,
    )
    parts = comparisons.parts(settings.n_splits, settings.batch_size)
    table = inputs.in_batches(lambda name: parts[name](), list(parts), CONSISTENCY)
    summary = summarise_consistency(table)
    log_rows(
        _logger,
        "%s, %s: median %.2f sigmas, sigmas to be multiplied by %.2f",
        summary,
        ("noise_model", "comparison", "median_distance", "sigma_factor"),
    )
    return {"consistency": table, "consistency_summary": summary}


EXPERIMENT: Final = Experiment(
    name="consistency",
    title="Whether disjoint observations agree",
    outputs={"consistency": CONSISTENCY, "consistency_summary": CONSISTENCY_SUMMARY},
    run=_run,
    section=SECTION,
    reads=(REPEATABILITY_SECTION,),
    needs=("observations", "outliers", "noise_models"),
    study=("seed", "search"),
    compares=True,
    every_noise_model=True,
    cores=None,
)
