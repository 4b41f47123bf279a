"""What config.yaml says of the coverage study."""

from typing import Annotated, Self

from pydantic import Field, NonNegativeInt, PositiveFloat, PositiveInt, model_validator

from linepose.estimation.noise_models import MEANINGS, NOISE_MODELS, NoiseModelName
from linepose.experiments.coverage_survey import NoiseLevels
from linepose.settings import Settings

Level = Annotated[float, Field(ge=0)]


class RegimeSection(Settings):
    """The true noise of surveys, in units of what is reported, and the noise models that estimate from them."""

    shared_level: Level = Field(0.0, description="Navigation error constant in a view (reported sigmas).")
    white_level: Level = Field(0.0, description="Navigation error independent from point to point (reported sigmas).")
    correlated_level: Level = Field(0.0, description="Gauss-Markov navigation error (reported sigmas).")
    correlation_time_s: PositiveFloat = Field(60.0, description="Correlation time of the Gauss-Markov error (s).")
    pixel_level: Level | None = Field(
        None, description="Noise of points (the camera's sigmas); as in the platform's extraction if null."
    )
    intrinsics_level: Level = Field(
        1.0, description="Deviation of the true principal point and focal length (the camera's sigmas)."
    )
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

    def levels(self) -> NoiseLevels | None:
        """As the library takes it; None where they are drawn."""
        return (
            None
            if self.from_prior
            else NoiseLevels(
                self.shared_level,
                self.white_level,
                self.correlated_level,
                self.correlation_time_s,
                self.pixel_level,
                self.intrinsics_level,
            )
        )


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
