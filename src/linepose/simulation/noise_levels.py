"""How noisy a simulated survey truly is."""

from typing import Self

from pydantic import Field, NonNegativeFloat, PositiveFloat, model_validator

from linepose.settings import Settings, SettingsError


class NoiseLevels(Settings):
    """True noise of a survey: navigation errors in reported sigmas, intrinsics in the camera's sigmas.

    Navigation errors are the sum of one constant in a view, one white from point to point, and a Gauss-Markov process;
    or what the platform's own file says they are.
    """

    shared_level: NonNegativeFloat = Field(0.0, description="Navigation error constant in a view (reported sigmas).")
    white_level: NonNegativeFloat = Field(
        0.0, description="Navigation error independent from point to point (reported sigmas)."
    )
    correlated_level: NonNegativeFloat = Field(0.0, description="Gauss-Markov navigation error (reported sigmas).")
    correlation_time_s: PositiveFloat = Field(60.0, description="Correlation time of the Gauss-Markov error (s).")
    attitude_level: NonNegativeFloat = Field(
        1.0, description="What the attitude's errors are multiplied by besides: 0.4 where they are reported too large."
    )
    platform_error: bool = Field(
        False, description="Navigation error as the platform's file says, in place of these levels."
    )
    intrinsics_level: NonNegativeFloat = Field(
        1.0, description="Deviation of the true principal point and focal length (the camera's sigmas)."
    )

    @model_validator(mode="after")
    def _one_of_two(self) -> Self:
        if self.platform_error and (self.shared_level or self.white_level or self.correlated_level):
            raise SettingsError("levels and platform_error", "one of them", "leave one out")
        return self
