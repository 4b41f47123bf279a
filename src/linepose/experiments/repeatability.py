"""Repeatability: whether two disjoint sets of observations give the same pose (section 4.5, Table 5).

Beyond the paper, which compares two subsets by eye: the distance of the two poses in sigmas with its p-value.
"""

import logging
from collections.abc import Mapping, Sequence
from typing import Final, Self

import pandas as pd
import pyarrow as pa
from numpy.typing import ArrayLike
from pydantic import Field, PositiveInt, model_validator

from linepose.errors import InputError
from linepose.estimation.estimator import Estimator
from linepose.experiments.accepted import Accepted
from linepose.experiments.agreement import AGREEMENT, agreement
from linepose.experiments.estimate import estimate_fields, estimate_row, observation_list
from linepose.experiments.experiment import Experiment
from linepose.experiments.inputs import Inputs
from linepose.experiments.section import Section
from linepose.experiments.subsets import SubsetSettings, chosen_subsets
from linepose.settings import Settings, SettingsError
from linepose.tables import texts

_logger = logging.getLogger(__name__)

REPEATABILITY: Final = pa.schema([*texts("subset"), *estimate_fields(), *AGREEMENT])


class RepeatabilitySettings(Settings):
    """Whether disjoint sets of observations give the same pose."""

    first: SubsetSettings | None = Field(None, description="The first of two disjoint subsets.")
    second: SubsetSettings | None = Field(None, description="The second one.")
    n_splits: int = Field(200, ge=0, le=1_000_000, description="Random splits into two disjoint subsets.")
    split_size: PositiveInt | None = Field(None, description="Observations in each; half of the accepted ones if null.")

    @model_validator(mode="after")
    def _both_or_none(self) -> Self:
        if (self.first is None) != (self.second is None):
            given, lacks = ("first", "second") if self.second is None else ("second", "first")
            raise SettingsError(f"{given} without {lacks}", "both, or neither", f"add {lacks}")
        return self


SECTION: Final = Section("repeatability", RepeatabilitySettings, RepeatabilitySettings(), "Disjoint subsets.")


def named_pair(data: Accepted, settings: RepeatabilitySettings | None, file: str) -> dict[str, Sequence[int]]:
    """Observation numbers of the two disjoint subsets that a platform's file names; none where it names none."""
    if settings is None or settings.first is None or settings.second is None:
        return {}
    pair = {"subset_1": settings.first, "subset_2": settings.second}
    return chosen_subsets(data, pair, f"{file}: experiments.{SECTION.key}")


def check_disjoint(first: Sequence[int], second: Sequence[int], place: str) -> None:
    """Raise InputError, naming `place`, where two subsets share an observation: then they are not independent."""
    shared = sorted(set(first) & set(second))
    if shared:
        raise InputError(
            place, f"observation {observation_list(shared)} in both subsets", "disjoint subsets", "remove it from one"
        )


def compare_subsets(
    estimator: Estimator, subsets: Mapping[str, Sequence[int]], start: ArrayLike, seed: int, place: str
) -> pd.DataFrame:
    """One row for each of two named subsets, with sampled sigmas; both tell how far apart the two are; start (6,).

    Raises InputError, naming `place`, for subsets that overlap.
    """
    first, second = subsets.values()
    check_disjoint(first, second, place)
    estimates = [estimator.select(list(numbers)).estimate(start, seed) for numbers in (first, second)]
    apart = agreement(*estimates)
    rows = [
        {"subset": name, **estimate_row(estimate), **apart} for name, estimate in zip(subsets, estimates, strict=True)
    ]
    return pd.DataFrame(rows)


def _run(inputs: Inputs) -> dict[str, pd.DataFrame]:
    pair = named_pair(inputs.data, inputs.required(SECTION), inputs.file)
    place, start = f"{inputs.file}: experiments.{SECTION.key}", inputs.platform.start_pose()
    table = compare_subsets(inputs.data.accepted, pair, start, inputs.seed, place)
    _logger.info("%.2f sigmas apart, p = %.2f", table["mahalanobis"].iloc[0], table["p_value"].iloc[0])
    return {"repeatability": table}


EXPERIMENT: Final = Experiment(
    name="repeatability",
    title="Two disjoint subsets",
    outputs={"repeatability": REPEATABILITY},
    run=_run,
    section=SECTION,
    wanted=lambda settings: settings and settings.first,
    needs=("observations", "outliers"),
    cores=2,
)
