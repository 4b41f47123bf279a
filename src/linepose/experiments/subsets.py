"""Angular diversity: what the pose and its sigma owe to the body angles of the observations (section 4.4, Table 4)."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.estimation.optimise import Search
from linepose.estimation.sampling import IndependenceSettings, SamplingSettings
from linepose.experiments.estimate import estimate_by_sampling, observation_list
from linepose.likelihood.base import Likelihood
from linepose.survey.observations import EULER_COLUMNS, Survey

_RAYS_PER_POINT: Final = 2
BODY_ANGLES: Final = tuple(name.removesuffix("_rad") for name in EULER_COLUMNS)


@dataclass(frozen=True)
class AngleRule:
    """Draw `count` observations for which `minimum_rad <= |angle| < maximum_rad`; angle: roll, pitch or yaw."""

    angle: str
    minimum_rad: float
    maximum_rad: float
    count: int

    def __str__(self) -> str:
        low, high = np.degrees([self.minimum_rad, self.maximum_rad])
        return f"{low:g} <= |{self.angle}| < {high:g} deg"


def body_angles_rad(survey: Survey) -> Floats:
    """Mean roll, pitch, yaw of each observation over the points it has; (N, 3)."""
    return np.asarray(
        np.arctan2(np.nanmean(np.sin(survey.euler_rad), axis=1), np.nanmean(np.cos(survey.euler_rad), axis=1))
    )


def draw_by_rules(survey: Survey, rules: Sequence[AngleRule], seed: int, place: str) -> tuple[int, ...]:
    """Observation numbers, ascending, drawn at random for each rule in turn, none twice.

    Raises InputError, naming `place`, for a rule that finds too few.
    """
    random = np.random.default_rng(seed)
    size = np.abs(body_angles_rad(survey))
    chosen: list[int] = []
    for rule in rules:
        angle = size[:, BODY_ANGLES.index(rule.angle)]
        within = survey.number[(angle >= rule.minimum_rad) & (angle < rule.maximum_rad)]
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


def subset_estimates(
    likelihood: Likelihood,
    subsets: Mapping[str, Sequence[int]],
    start: ArrayLike,
    seed: int,
    search: Search | None = None,
    settings: SamplingSettings | IndependenceSettings | None = None,
) -> pd.DataFrame:
    """One row a named subset: its observations, pose, sampled sigmas and -log L; start pose (6,)."""
    rows = []
    for name, numbers in subsets.items():
        estimate = estimate_by_sampling(likelihood.select(list(numbers)), start, seed, search, settings)
        rows.append({"subset": name, **estimate.row()})
    return pd.DataFrame(rows)
