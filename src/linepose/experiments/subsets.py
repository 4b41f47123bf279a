"""Angular diversity: what the pose and its sigma owe to the body angles of the observations (section 4.4, Table 4)."""

import logging
from collections.abc import Mapping, Sequence
from typing import Final, Literal, Self

import numpy as np
import pandas as pd
import pyarrow as pa
from numpy.typing import ArrayLike
from pydantic import Field, NonNegativeFloat, NonNegativeInt, PositiveFloat, PositiveInt, model_validator

from linepose.errors import InputError
from linepose.estimation.estimator import Estimator
from linepose.experiments.accepted import Accepted
from linepose.experiments.estimate import estimate_fields, estimate_row, observation_list
from linepose.experiments.experiment import Experiment
from linepose.experiments.inputs import Inputs, log_rows
from linepose.experiments.section import Section
from linepose.settings import Settings, SettingsError
from linepose.survey.body_angles import BODY_ANGLES, body_angles_rad
from linepose.survey.observations import Survey
from linepose.tables import texts

_RAYS_PER_POINT: Final = 2
_logger = logging.getLogger(__name__)


class AngleRule(Settings):
    """Draw observations whose body angle is in a range."""

    angle: Literal["roll", "pitch", "yaw"] = Field(description="The body angle, averaged over an observation's points.")
    minimum_deg: NonNegativeFloat = Field(0.0, description="The angle's size is this or more (deg).")
    maximum_deg: PositiveFloat = Field(180.0, description="The angle's size is below this (deg).")
    count: PositiveInt = Field(description="How many observations are drawn.")

    def __str__(self) -> str:
        return f"{self.minimum_deg:g} <= |{self.angle}| < {self.maximum_deg:g} deg"


class SubsetSettings(Settings):
    """Accepted observations, by number or by rules on body angles."""

    observations: list[int] = Field([], description="Observation numbers; or give rules.")
    rules: list[AngleRule] = Field([], description="Draw at random, for each rule in turn, none twice.")
    seed: NonNegativeInt = Field(0, description="Seed of the draw.")

    @model_validator(mode="after")
    def _one_of_two(self) -> Self:
        if bool(self.observations) == bool(self.rules):
            found = "observations and rules" if self.rules else "neither observations nor rules"
            raise SettingsError(found, "one of them", "give one alone")
        return self


SUBSETS: Final = pa.schema([*texts("subset"), *estimate_fields()])
SECTION: Final = Section("subsets", dict[str, SubsetSettings], {}, "Subsets whose poses are compared, by name.")


def draw_by_rules(survey: Survey, rules: Sequence[AngleRule], seed: int, place: str) -> tuple[int, ...]:
    """Observation numbers, ascending, drawn at random for each rule in turn, none twice.

    Raises InputError, naming `place`, for a rule that finds too few.
    """
    random = np.random.default_rng(seed)
    size = np.abs(body_angles_rad(survey))
    chosen: list[int] = []
    for rule in rules:
        angle = size[:, BODY_ANGLES.index(rule.angle)]
        low, high = np.deg2rad([rule.minimum_deg, rule.maximum_deg])
        within = survey.number[(angle >= low) & (angle < high)]
        left = np.setdiff1d(within, chosen)
        if len(left) < rule.count:
            raise InputError(
                place,
                f"{len(left)} observations with {rule} that no earlier rule took",
                f"at least {rule.count}",
                "widen the range or lower the count",
            )
        chosen += [int(number) for number in random.choice(left, rule.count, replace=False)]
    return tuple(sorted(chosen))


def check_subset(numbers: Sequence[int], accepted: ArrayLike, known: ArrayLike, place: str) -> None:
    """Raise InputError, naming `place`, for a number that was rejected, does not exist or is given twice."""
    expected = f"some of the accepted observations {observation_list(accepted)}"
    unknown = sorted(set(numbers) - set(np.asarray(known).tolist()))
    if unknown:
        raise InputError(place, f"observation {observation_list(unknown)}, which does not exist", expected, "remove it")
    rejected = sorted(set(numbers) - set(np.asarray(accepted).tolist()))
    if rejected:
        found = f"observation {observation_list(rejected)}, which was rejected as an outlier"
        raise InputError(place, found, expected, "remove it or raise outliers.threshold_px")
    repeated = sorted({number for number in numbers if list(numbers).count(number) > 1})
    if repeated:
        raise InputError(place, f"observation {observation_list(repeated)} twice", "each one once", "remove one")
    if len(numbers) < _RAYS_PER_POINT:
        raise InputError(place, f"{len(numbers)} observations", f"at least {_RAYS_PER_POINT}", "name more")


def chosen_subset(data: Accepted, settings: SubsetSettings, place: str) -> tuple[int, ...]:
    """Observation numbers that settings name or draw from the accepted ones; raises InputError, naming `place`."""
    survey = data.accepted.survey
    numbers = tuple(settings.observations) or draw_by_rules(survey, settings.rules, settings.seed, place)
    check_subset(numbers, survey.number, data.all.survey.number, place)
    return numbers


def chosen_subsets(data: Accepted, settings: Mapping[str, SubsetSettings], place: str) -> dict[str, Sequence[int]]:
    """Observation numbers of each subset, by name."""
    return {name: chosen_subset(data, one, f"{place}.{name}") for name, one in settings.items()}


def subset_estimates(
    estimator: Estimator, subsets: Mapping[str, Sequence[int]], start: ArrayLike, seed: int
) -> pd.DataFrame:
    """One row a named subset: its observations, pose, sampled sigmas and -log L; start pose (6,)."""
    rows = []
    for name, numbers in subsets.items():
        estimate = estimator.select(list(numbers)).estimate(start, seed)
        rows.append({"subset": name, **estimate_row(estimate)})
    return pd.DataFrame(rows)


def _run(inputs: Inputs) -> dict[str, pd.DataFrame]:
    subsets = chosen_subsets(inputs.data, inputs.required(SECTION), f"{inputs.file}: experiments.{SECTION.key}")
    table = subset_estimates(inputs.data.accepted, subsets, inputs.platform.start_pose(), inputs.seed)
    log_rows(_logger, "%s: observations %s, -log L %.6f", table, ("subset", "observations", "neg_log_likelihood"))
    return {"subsets": table}


EXPERIMENT: Final = Experiment(
    name="subsets",
    title="Subsets of observations",
    outputs={"subsets": SUBSETS},
    run=_run,
    section=SECTION,
    needs=("observations", "outliers"),
    cores=2,
)
