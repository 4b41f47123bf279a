"""How noisy a simulated survey truly is."""

from pydantic import Field, NonNegativeFloat, PositiveFloat

from linepose.settings import Settings


class NoiseLevels(Settings):
    """True noise of a survey: navigation errors in reported sigmas, pixels and intrinsics in the camera's sigmas.

    Navigation errors are the sum of one constant in a view, one white from point to point, and a Gauss-Markov process.
    """

    shared_level: NonNegativeFloat = Field(0.0, description="Navigation error constant in a view (reported sigmas).")
    white_level: NonNegativeFloat = Field(
        0.0, description="Navigation error independent from point to point (reported sigmas)."
    )
    correlated_level: NonNegativeFloat = Field(0.0, description="Gauss-Markov navigation error (reported sigmas).")
    correlation_time_s: PositiveFloat = Field(60.0, description="Correlation time of the Gauss-Markov error (s).")
    pixel_level: NonNegativeFloat | None = Field(
        None, description="Noise of points (the camera's sigmas); as in the platform's extraction if null."
    )
    intrinsics_level: NonNegativeFloat = Field(
        1.0, description="Deviation of the true principal point and focal length (the camera's sigmas)."
    )
