"""The study's configuration: which platforms, where their data are, and the settings of every stage."""

from pathlib import Path
from typing import Any

import numpy as np
from pydantic import Field, NonNegativeInt, PositiveFloat

from linepose.config.coverage import CoverageSection
from linepose.config.platform import read_yaml
from linepose.config.schema import Section, validated
from linepose.estimation.optimise import Search
from linepose.estimation.sampling import IndependenceSettings, SamplingSettings
from linepose.likelihood.names import sampling_section


class DatasetSection(Section):
    """A public data set: where it can be had, and the sums of its files."""

    base_url: str = Field(description="Address below which the files stand.")
    sha256: dict[str, str] = Field(description="SHA-256 of each file, by its path in the data set.")
    urls: dict[str, str] = Field(default_factory=dict, description="Addresses of files that stand elsewhere.")

    def address(self, file: str) -> str:
        """Where a file of the data set can be downloaded from."""
        return self.urls.get(file, self.base_url + file)


class SearchSection(Section):
    """Powell's method from the hand-measured pose."""

    half_width_m: PositiveFloat = Field(2.0, description="Each coordinate is searched within +- this (m).")
    half_width_deg: PositiveFloat = Field(180.0, description="Each rotation component within +- this (deg).")
    x_tolerance: PositiveFloat = Field(1e-5, description="Powell's relative tolerance of the parameters.")
    f_tolerance: PositiveFloat = Field(1e-8, description="Powell's relative tolerance of -log L.")

    def settings(self) -> Search:
        """As the library takes it, angles in rad."""
        return Search(self.half_width_m, float(np.deg2rad(self.half_width_deg)), self.x_tolerance, self.f_tolerance)


class OutliersSection(Section):
    """Iterative removal of the worst observation."""

    threshold_px: PositiveFloat = Field(5.0, description="Accepted when every observation's mean error is below (px).")
    minimum_observations: int = Field(10, ge=3, description="Removal goes on, for the figures, down to this many.")


class SamplingSection(Section):
    """Sampling of the posterior."""

    n_walkers: int = Field(250, ge=4, description="Walkers of the ensemble.")
    n_burn_in: NonNegativeInt = Field(100, description="Steps thrown away.")
    n_steps: int = Field(100, ge=4, description="Steps kept.")
    stretch_scale: float = Field(2.5, gt=1, description="Scale a of the stretch move.")
    start_sigma_m: PositiveFloat = Field(0.1, description="Walkers start around the optimum with this sigma (m).")
    start_sigma_rad: PositiveFloat = Field(0.01, description="The same for the rotation vector (rad).")

    def settings(self) -> SamplingSettings:
        """As the library takes it."""
        return SamplingSettings(**self.model_dump())


class IndependenceSamplingSection(Section):
    """Sampling where the noise model infers its levels: proposals from the fitted posterior."""

    n_walkers: int = Field(24, ge=24, description="Walkers of the ensemble, two a parameter or more.")
    n_burn_in: int = Field(160, ge=20, description="Steps that fit the proposals, thrown away.")
    n_steps: int = Field(1000, ge=4, description="Steps kept.")
    independent_share: float = Field(
        0.9, gt=0, lt=1, description="Share of proposals from the fit; the rest are differential evolution."
    )

    def settings(self) -> IndependenceSettings:
        """As the library takes it."""
        return IndependenceSettings(**self.model_dump())


def sampling_settings(values: dict[str, Any]) -> SamplingSettings | IndependenceSettings:
    """The settings that one of the two sections describes, all of its keys given."""
    section = SamplingSection if "stretch_scale" in values else IndependenceSamplingSection
    return section.model_validate(values).settings()


class Study(Section):
    """config/config.yaml."""

    platforms: list[str] = Field(min_length=1, description="Platforms to run: files of config/platforms.")
    platforms_folder: str = Field("config/platforms", description="Folder of the platform files.")
    published: str = Field("config/published.yaml", description="File of the numbers to regress on.")
    data_folders: list[str] = Field(
        ["data", "../shared"], min_length=1, description="Folders searched for data sets, in this order."
    )
    datasets: dict[str, str] = Field(default_factory=dict, description="Data sets, name to file of their sums.")
    seed: NonNegativeInt = Field(2017, description="Seed from which every random number is derived.")
    search: SearchSection = Field(SearchSection(), description="Optimisation.")
    outliers: OutliersSection = Field(OutliersSection(), description="Outlier removal.")
    sampling: SamplingSection = Field(SamplingSection(), description="MCMC of the published noise model.")
    independence_sampling: IndependenceSamplingSection = Field(
        IndependenceSamplingSection(), description="MCMC of the noise models shared, balanced and robust."
    )
    coverage: CoverageSection = Field(CoverageSection(), description="Coverage study; not part of the main job.")

    def sampling_of(self, noise_model: str) -> SamplingSection | IndependenceSamplingSection:
        """The sampling section for a noise model."""
        section = getattr(self, sampling_section(noise_model))
        assert isinstance(section, SamplingSection | IndependenceSamplingSection)
        return section


def load_dataset(path: Path) -> DatasetSection:
    """The data set that a file of config/datasets describes."""
    return validated(DatasetSection, read_yaml(path), str(path))


def check_study(values: dict[str, Any], place: str = "config/config.yaml") -> Study:
    """The study that these values describe; raises InputError for the first that is wrong."""
    return validated(Study, values, place)
