"""The names of the noise models, without what computes them: configuration is read often and must be quick."""

from typing import Final, Literal

NoiseModelName = Literal["published", "shared", "robust"]
PUBLISHED: Final = "published"
SHARED: Final = "shared"
ROBUST: Final = "robust"
