"""What a platform file says of its experiments."""

from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field, NonNegativeInt, PositiveFloat, PositiveInt, model_validator

from linepose.experiments.basin import BasinGrid, Region
from linepose.experiments.subsets import AngleRule
from linepose.settings import Settings

OptimiserName = Literal["powell", "powell_in_front", "wide"]


class RuleSection(Settings):
    """Draw observations whose body angle is in a range."""

    angle: Literal["roll", "pitch", "yaw"] = Field(description="The body angle, averaged over an observation's points.")
    minimum_deg: Annotated[float, Field(ge=0)] = Field(0.0, description="The angle's size is this or more (deg).")
    maximum_deg: PositiveFloat = Field(180.0, description="The angle's size is below this (deg).")
    count: PositiveInt = Field(description="How many observations are drawn.")

    def rule(self) -> AngleRule:
        """As the library takes it, angles in rad."""
        low, high = np.deg2rad([self.minimum_deg, self.maximum_deg])
        return AngleRule(self.angle, float(low), float(high), self.count)


class SubsetSection(Settings):
    """Accepted observations, by number or by rules on body angles."""

    observations: list[int] = Field([], description="Observation numbers; or give rules.")
    rules: list[RuleSection] = Field([], description="Draw at random, for each rule in turn, none twice.")
    seed: NonNegativeInt = Field(0, description="Seed of the draw.")

    @model_validator(mode="after")
    def _one_of_two(self) -> Self:
        if bool(self.observations) == bool(self.rules):
            raise ValueError("a subset needs either observations or rules")
        return self


class RepeatabilitySection(Settings):
    """Whether disjoint sets of observations give the same pose."""

    first: SubsetSection | None = Field(None, description="The first of two disjoint subsets.")
    second: SubsetSection | None = Field(None, description="The second one.")
    n_splits: NonNegativeInt = Field(200, description="Random splits into two disjoint subsets.")
    split_size: PositiveInt | None = Field(None, description="Observations in each; half of the accepted ones if null.")

    @model_validator(mode="after")
    def _both_or_none(self) -> Self:
        if (self.first is None) != (self.second is None):
            raise ValueError("repeatability needs both first and second, or neither")
        return self


class BasinSection(Settings):
    """From how far away the optimum is found. One start in each cell of a grid over distance and angle."""

    maximum_distance_m: PositiveFloat = Field(2.0, description="The grid reaches this far from the optimum (m).")
    maximum_angle_deg: float = Field(60.0, gt=0, le=180, description="The grid reaches this angle from it (deg).")
    n_distances: PositiveInt = Field(30, description="Cells over the distance.")
    n_angles: PositiveInt = Field(30, description="Cells over the angle.")
    optimisers: list[OptimiserName] = Field(
        ["powell", "wide"],
        min_length=1,
        description="Searches to compare on the same starts. powell: on the paper's equations, where points behind the "
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

    def grid(self) -> BasinGrid:
        """As the library takes it, angles in rad."""
        angle = float(np.deg2rad(self.maximum_angle_deg))
        return BasinGrid(self.maximum_distance_m, angle, self.n_distances, self.n_angles)

    def region(self) -> Region:
        """As the library takes it, angles in rad."""
        return Region(self.region_distance_m, float(np.deg2rad(self.region_angle_deg)))


class MappingSection(Settings):
    """The observed points projected onto the pattern's plane."""

    perturbation_deg: PositiveFloat = Field(1.0, description="Turn about each body axis of the perturbed pose (deg).")


class ClockOffsetSection(Settings):
    """The camera's clock against the navigation's, one parameter beside the pose; needs a raw navigation log."""

    maximum_s: PositiveFloat = Field(0.1, description="The clocks differ by no more than this (s).")


class SensitivitySection(Settings):
    """The pose under other choices."""

    platforms: list[str] = Field(
        [],
        description="Platform files of the same camera with other data choices (covariance columns, views), whose pose "
        "is held against this one; they are run as far as the outlier removal.",
    )


class NoiseModelsSection(Settings):
    """The pose under each noise model, side by side, and whether disjoint observations agree under each."""

    platforms: list[str] = Field(
        [],
        description="Platform files with other views of the same pattern by the same camera, such as the forward "
        "passes; they are run as far as the outlier removal.",
    )
    n_splits: PositiveInt = Field(200, description="Random splits of each platform's accepted observations.")
    robust_steps: int = Field(
        400, ge=4, description="Steps kept of the robust model's chains, ten times as dear as the shared model's."
    )
    batch_size: PositiveInt = Field(20, description="Splits between two savings; no result depends on it.")


class ExperimentsSection(Settings):
    """Which experiments are run on the accepted observations; null leaves one out."""

    subsets: dict[str, SubsetSection] = Field({}, description="Subsets whose poses are compared, by name.")
    repeatability: RepeatabilitySection | None = Field(RepeatabilitySection(), description="Disjoint subsets.")
    basin: BasinSection | None = Field(BasinSection(), description="Basin of attraction.")
    mapping: MappingSection | None = Field(MappingSection(), description="Mapping.")
    sensitivity: SensitivitySection | None = Field(SensitivitySection(), description="Other choices.")
    noise_models: NoiseModelsSection | None = Field(None, description="All noise models side by side.")
    clock_offset: ClockOffsetSection | None = Field(
        None, description="Clock offset, of platforms with scans and a raw navigation log only."
    )

    def other_platforms(self) -> list[str]:
        """Platform files that an experiment compares with."""
        named = [name for one in (self.sensitivity, self.noise_models) if one for name in one.platforms]
        return list(dict.fromkeys(named))
