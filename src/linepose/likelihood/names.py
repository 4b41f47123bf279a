"""The names of the noise models, without what computes them: configuration is read often and must be quick."""

from typing import Final, Literal

NoiseModelName = Literal["published", "shared", "balanced", "robust"]
PUBLISHED: Final = "published"
SHARED: Final = "shared"
BALANCED: Final = "balanced"
ROBUST: Final = "robust"


def sampling_section(noise_model: str) -> str:
    """The section of config.yaml that says how a noise model is sampled."""
    return "sampling" if noise_model == PUBLISHED else "independence_sampling"
