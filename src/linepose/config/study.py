"""The study's configuration: which platforms, where their data are, and the settings of every stage."""

import re
from pathlib import Path, PurePosixPath
from typing import Annotated, Any

from pydantic import AfterValidator, Field, NonNegativeInt, field_validator

from linepose.adjustment.settings import AdjustmentSection
from linepose.config.coverage import CoverageSection
from linepose.config.yaml_file import read_yaml
from linepose.estimation.optimise import Search
from linepose.estimation.outliers import OutlierSettings
from linepose.estimation.sampling import SamplingSettings
from linepose.inputs.patterns import Dataset
from linepose.settings import Settings, validated


def _is_path(path: str) -> str:
    if not path.strip() or not path.isprintable() or any(sign in path for sign in "{}"):
        raise ValueError("a printable path without braces, in which the workflow would look for its own words")
    return path


WorkflowPath = Annotated[str, AfterValidator(_is_path)]


class DatasetSection(Settings):
    """A public data set: where it can be had, and the sums of its files."""

    base_url: str = Field(description="Address below which the files stand.")
    sha256: dict[str, str] = Field(description="SHA-256 of each file, by its path in the data set.")
    urls: dict[str, str] = Field(default_factory=dict, description="Addresses of files that stand elsewhere.")

    @field_validator("sha256")
    @classmethod
    def _are_below_the_folder(cls, sums: dict[str, str]) -> dict[str, str]:
        for file, found in sums.items():
            path = PurePosixPath(file)
            if path.is_absolute() or ".." in path.parts or not path.parts or "\\" in file or not file.isprintable():
                raise ValueError(f"paths below the data set's folder, not {file!r}")
            if any(sign in file for sign in "{}"):
                raise ValueError(
                    f"names without braces, in which the workflow would look for its own words, not {file!r}"
                )
            if not re.fullmatch("[0-9a-fA-F]{64}", found):
                raise ValueError(f"64 hexadecimal digits for {file}, not {found!r}")
        return sums


class Study(Settings):
    """config/config.yaml."""

    platforms: list[str] = Field(
        min_length=1, description="Platforms to run: files of config/platforms, by name or pattern (`fleet-*`)."
    )
    platforms_folder: str = Field("config/platforms", description="Folder of the platform files.")
    data_folders: list[WorkflowPath] = Field(
        ["data", "../shared"], min_length=1, description="Folders searched for data sets, in this order."
    )
    datasets: dict[Dataset, WorkflowPath] = Field(
        default_factory=dict, description="Data sets, name to file of their sums."
    )
    offline: bool = Field(
        False,
        description="Leave out, with a warning, platforms whose data set is in no data folder, instead of downloading "
        "it.",
    )
    seed: NonNegativeInt = Field(2017, description="Seed from which every random number is derived.")
    search: Search = Field(Search(), description="Optimisation.")
    outliers: OutlierSettings = Field(OutlierSettings(), description="Outlier removal.")
    sampling: SamplingSettings = Field(SamplingSettings(), description="MCMC, of noise models with a likelihood.")
    adjustment: AdjustmentSection = Field(AdjustmentSection(), description="The adjustment.")
    coverage: CoverageSection = Field(CoverageSection(), description="Coverage study; not part of the main job.")


def load_dataset(path: Path) -> DatasetSection:
    """The data set that a file of config/datasets describes."""
    return validated(DatasetSection, read_yaml(path), str(path))


def check_study(values: dict[str, Any], place: str = "config/config.yaml") -> Study:
    """The study that these values describe; raises InputError for the first that is wrong."""
    return validated(Study, values, place)
