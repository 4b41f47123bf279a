"""What estimates a pose from a survey, under either noise model: what experiments repeat under another condition."""

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from linepose.adjustment.known_points import KnownPoints
from linepose.adjustment.settings import AdjustmentSection
from linepose.arrays import Floats
from linepose.estimation.optimise import Search
from linepose.estimation.sampling import SamplingSettings
from linepose.geometry.camera import Camera
from linepose.survey.hand_measured import HandMeasured
from linepose.survey.observations import Survey


@dataclass(frozen=True)
class Estimate:
    """A pose (6,) with its covariance (6, 6), the observations (n,) it rests on, and -log L there.

    Under the adjustment -log L is half of chi squared, and an evaluation a pass over the measurements.
    """

    number: NDArray[np.int64]
    pose: Floats
    covariance: Floats
    neg_log_likelihood: float
    n_evaluations: int

    def sigma(self) -> Floats:
        """One standard deviation of each number of the pose (6,)."""
        return np.sqrt(np.diag(self.covariance))


@dataclass(frozen=True)
class Conditions:
    """What is known beside a survey, and how it is estimated from.

    `prior`: whether the hand measurement counts as a prior of the pose, or is but the search's start; known_points: of
    the survey's points, if something is known of them.
    """

    camera: Camera
    hand_measured: HandMeasured
    prior: bool = True
    search: Search = field(default_factory=Search)
    sampling: SamplingSettings = field(default_factory=SamplingSettings)
    adjustment: AdjustmentSection = field(default_factory=AdjustmentSection)
    known_points: KnownPoints | None = None


class Estimator(ABC):
    """A noise model with a survey and all that is known beside it."""

    survey: Survey
    camera: Camera

    @abstractmethod
    def select(self, numbers: Sequence[int]) -> Self:
        """The same with these observations only."""

    @abstractmethod
    def estimate(self, start: ArrayLike, seed: int | None = None) -> Estimate:
        """The pose from a start pose (6,), with its covariance: of samples where a seed is given.

        The covariance is NaN where the observations leave a direction of the pose open.
        """

    @abstractmethod
    def searches(self) -> tuple[str, ...]:
        """Names of the searches whose basins of attraction can be swept, the usual ones first."""

    @abstractmethod
    def search_by(self, name: str, start: ArrayLike) -> Estimate:
        """The pose that the search of this name finds from a start pose (6,), without a covariance."""

    def variations(self) -> "Mapping[str, Estimator]":
        """The same under other choices of the model itself, by what the choice is."""
        return {}
