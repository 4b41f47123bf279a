"""What config.yaml says of the coverage study."""

from typing import Annotated, Self

from pydantic import Field, NonNegativeInt, PositiveInt, model_validator

from linepose.estimation.noise_models import DEFAULT, MEANINGS, NoiseModelName, noise_model
from linepose.settings import Settings, SettingsError
from linepose.simulation.noise_levels import NoiseLevels

RegimeName = Annotated[str, Field(pattern="^[A-Za-z0-9-]+$")]


class RegimeSection(NoiseLevels):
    """The true noise of surveys, in units of what is reported, and the noise models that estimate from them."""

    n_surveys: PositiveInt | None = Field(None, description="Surveys of each platform; as the study has if null.")
    with_faults: bool = Field(False, description="Leave the observations with the platform's planted faults in.")
    hand_measured_prior: bool = Field(
        False, description="Draw the hand measurement from its prior about the truth for each survey, and count it."
    )
    noise_models: list[NoiseModelName] = Field(
        [DEFAULT.name], min_length=1, description=f"The noise models that estimate. {MEANINGS}"
    )

    @model_validator(mode="after")
    def _prior_counts(self) -> Self:
        without = [name for name in self.noise_models if noise_model(name).removes_outliers]
        if self.hand_measured_prior and without:
            found = f"hand_measured_prior with noise_models {', '.join(without)}"
            raise SettingsError(found, "noise models under which it counts", "leave one of them out")
        return self


class CoverageSection(Settings):
    """Simulated surveys with a known truth: how often the stated regions hold it (snakemake coverage)."""

    platforms: list[str] = Field([], description="Simulated platforms among the study's; all of these if empty.")
    n_surveys: int = Field(200, gt=0, le=1_000_000, description="Surveys of each platform and regime.")
    seed: NonNegativeInt = Field(7, description="Seed of the study's surveys.")
    batch_size: PositiveInt = Field(10, description="Surveys between two savings; no result depends on it.")
    regimes: dict[RegimeName, RegimeSection] = Field(
        default_factory=dict, description="Regimes of true noise, by name."
    )
    pools: dict[RegimeName, list[RegimeName]] = Field(
        default_factory=dict, description="Regimes that are also judged together, over all platforms, by a name."
    )

    @model_validator(mode="after")
    def _pools_of_regimes(self) -> Self:
        for pool, regimes in self.pools.items():
            unknown = [name for name in regimes if name not in self.regimes]
            if unknown or not regimes or pool in self.regimes:
                found = ", ".join(unknown) if unknown else "no regime" if not regimes else "the name of a regime"
                raise SettingsError(found, "names of coverage.regimes", "correct it", f"pools.{pool}")
        return self
