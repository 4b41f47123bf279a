"""What config.yaml says of the coverage study."""

from typing import Annotated, Self

from pydantic import Field, NonNegativeInt, PositiveInt, model_validator

from linepose.estimation.noise_models import MEANINGS, NOISE_MODELS, NoiseModelName
from linepose.settings import Settings
from linepose.simulation.noise_levels import NoiseLevels


class RegimeSection(NoiseLevels):
    """The true noise of surveys, in units of what is reported, and the noise models that estimate from them."""

    from_prior: bool = Field(
        False, description="Draw shared, white and pixel level for each survey from the model's priors instead."
    )
    noise_models: list[NoiseModelName] = Field(
        [one.name for one in NOISE_MODELS.values() if one.quick],
        min_length=1,
        description=f"The noise models that estimate. {MEANINGS}",
    )

    @model_validator(mode="after")
    def _one_of_two(self) -> Self:
        if self.from_prior and (self.shared_level or self.white_level or self.correlated_level or self.pixel_level):
            raise ValueError("levels, or from_prior, not both")
        return self


class CoverageSection(Settings):
    """Simulated surveys with a known truth: how often the stated regions hold it (snakemake coverage)."""

    platforms: list[str] = Field([], description="Simulated platforms among the study's; all of these if empty.")
    n_surveys: PositiveInt = Field(300, description="Surveys of each platform and regime.")
    n_draws: int = Field(1000, ge=100, description="Draws from each posterior.")
    seed: NonNegativeInt = Field(7, description="Seed of the study's surveys.")
    batch_size: PositiveInt = Field(10, description="Surveys between two savings; no result depends on it.")
    regimes: dict[Annotated[str, Field(pattern="^[A-Za-z0-9-]+$")], RegimeSection] = Field(
        default_factory=dict, description="Regimes of true noise, by name."
    )
