"""What an experiment is: one entry, from which the configuration, the workflow and the reference page take all."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final

import pandas as pd
import pyarrow as pa

from linepose.config.platform import Platform
from linepose.estimation.noise_models import noise_model
from linepose.experiments.inputs import Inputs
from linepose.experiments.section import Section

ESTIMATE: Final = ("observations", "outliers", "optima", "samples")  # what most experiments start from
SETTINGS: Final = ("seed", "search", "sampling", "adjustment")  # what of config.yaml an estimate takes


@dataclass(frozen=True)
class Experiment:
    """An experiment on a platform's accepted observations.

    `outputs` are its results by the name of their file, each with its schema, or with a function that takes the table
    to its schema; `run` makes their tables. `section` says whether and how it is run, None where every platform has it;
    `wanted` whether a section that is there asks for it. `reads` are further sections that it takes settings from.
    `needs` names results of the platform: ones of `pipeline` by their rule inputs, ones of other experiments by file.
    `study` names the keys of config.yaml that it takes. An experiment that `compares` has a section with a list
    `platforms`: their observations and outliers are read too. `log`: it needs the raw navigation log. `truth`: it is
    run for simulated platforms only. `removal`: for those only whose noise model removes observations. `noise_model`:
    the one that it evaluates, by name; the platform's own if None. `cores`: how many it can use; None for all there
    are, in batches that a killed run need not make again.
    """

    name: str
    title: str
    outputs: Mapping[str, pa.Schema | Callable[[pd.DataFrame], pa.Schema]]
    run: Callable[[Inputs], Mapping[str, pd.DataFrame]]
    section: Section[Any] | None = None
    wanted: Callable[[Any], object] = bool
    reads: tuple[Section[Any], ...] = ()
    needs: tuple[str, ...] = ESTIMATE
    study: tuple[str, ...] = SETTINGS
    compares: bool = False
    log: bool = False
    truth: bool = False
    removal: bool = False
    noise_model: str | None = None
    cores: int | None = 1

    @property
    def module(self) -> str:
        """Name of the module that this entry stands in."""
        return self.run.__module__

    @property
    def sections(self) -> tuple[Section[Any], ...]:
        """All sections that it takes settings from."""
        return (*((self.section,) if self.section else ()), *self.reads)

    @property
    def in_batches(self) -> bool:
        """Whether finished parts are kept until the whole is done."""
        return self.cores is None

    def is_wanted(self, platform: Platform) -> bool:
        """Whether this experiment is run for a platform."""
        if self.truth and platform.true_pose is None:
            return False
        if self.removal and not noise_model(platform.noise_model).removes_outliers:
            return False
        return self.section is None or bool(self.wanted(self.section.of(platform)))

    def compared_with(self, platform: Platform) -> list[str]:
        """Names of the platforms that it compares this one with."""
        value = self.section.of(platform) if self.compares and self.section else None
        return [] if value is None else list(value.platforms)

    def schema(self, name: str, table: pd.DataFrame) -> pa.Schema:
        """The schema of an output."""
        schema = self.outputs[name]
        return schema if isinstance(schema, pa.Schema) else schema(table)
