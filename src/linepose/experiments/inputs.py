"""What an experiment is given: the platform, its results, and the settings that it declares."""

import logging
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, TypeVar

import pandas as pd
import pyarrow as pa

from linepose.adjustment.settings import AdjustmentSection
from linepose.config.platform import Platform
from linepose.estimation.estimator import Conditions, Estimator
from linepose.estimation.optimise import Search
from linepose.estimation.sampling import SamplingSettings
from linepose.experiments.accepted import Accepted, Reference, read_accepted, read_reference
from linepose.experiments.section import Section
from linepose.geometry.camera import Camera
from linepose.pipeline.batches import run_batches
from linepose.pipeline.platform_estimator import platform_conditions, platform_estimator
from linepose.tables import read_table

Value = TypeVar("Value")


@dataclass(frozen=True)
class Inputs:
    """What an experiment's entry declares, and nothing else: what it takes undeclared raises a KeyError.

    `files` are its results by name, those of other platforms in their order; `file` is the platform's own, for
    messages. `sections` are the values of the entry's sections and `study` those of config.yaml's keys. `folder` has
    what the platform recorded, and `work` keeps finished batches.
    """

    name: str
    platform: Platform
    file: str
    files: Mapping[str, Any]
    sections: Mapping[str, Any]
    study: Mapping[str, Any]
    others: Mapping[str, Platform]
    folder: Path
    work: Path
    n_processes: int = 1

    @cached_property
    def data(self) -> Accepted:
        """Estimators of all observations, and of the accepted ones."""
        return read_accepted(self.platform, self.conditions, self.files["observations"], self.files["outliers"])

    @cached_property
    def reference(self) -> Reference:
        """The accepted observations' optimum and the pose's sampled covariance."""
        return read_reference(self.files["optima"], self.files["samples"])

    @cached_property
    def other_data(self) -> dict[str, Accepted]:
        """As `data`, of the platforms that this one is compared with, by name, under this one's noise model."""
        files = zip(self.files["other_observations"], self.files["other_outliers"], strict=True)
        return {
            name: read_accepted(self._alike(other), self.conditions_of(self._alike(other)), *pair)
            for (name, other), pair in zip(self.others.items(), files, strict=True)
        }

    def table(self, name: str, schema: pa.Schema) -> pd.DataFrame:
        """A result by the name that the entry's `needs` has for it."""
        return read_table(self.files[name], schema)

    def settings(self, section: Section[Value]) -> Value | None:
        """What the platform's file says under a section's key."""
        return section.read({section.key: self.sections[section.key]})

    def required(self, section: Section[Value]) -> Value:
        """The same of the section that asked for this experiment."""
        value = self.settings(section)
        if value is None:
            raise RuntimeError(f"experiments.{section.key} is null")
        return value

    @property
    def seed(self) -> int:
        """The study's seed."""
        seed: int = self.study["seed"]
        return seed

    @property
    def conditions(self) -> Conditions:
        """What is known of the platform beside its survey."""
        return self.conditions_of(self.platform)

    def conditions_of(self, platform: Platform, camera: Camera | None = None) -> Conditions:
        """The same of another platform, or with another camera."""
        return platform_conditions(
            platform,
            Search.model_validate(self.study["search"]),
            SamplingSettings.model_validate(self.study["sampling"]),
            AdjustmentSection.model_validate(self.study["adjustment"]),
            camera,
        )

    def estimator_with(self, camera: Camera) -> Estimator:
        """The estimator of the accepted observations with another camera than the platform's."""
        conditions = self.conditions_of(self.platform, camera)
        return platform_estimator(self.platform, self.data.accepted.survey, conditions)

    def _alike(self, other: Platform) -> Platform:
        """Another platform with this one's noise model and prior, so that only its observations differ."""
        return other.replaced(noise_model=self.platform.noise_model, prior=self.platform.prior)

    def in_batches(self, task: Callable[[str], pd.DataFrame], names: Sequence[str], schema: pa.Schema) -> pd.DataFrame:
        """The tables of all named batches, one below the other; those that a killed run finished are not made again."""
        return run_batches(task, names, self.work, schema, self.n_processes)


def log_rows(logger: logging.Logger, message: str, table: pd.DataFrame, columns: Sequence[str]) -> None:
    """One message a row of a table, of these columns."""
    for _, row in table.iterrows():
        logger.info(message, *(row[name] for name in columns))
