"""From where on a result of the adjustment is not to be trusted, and what a view that is far off is called."""

from typing import Final

TRUSTED_EIGENVALUE: Final = 0.3  # the least one below which the covariance is not to be trusted
TRUSTED_SHAPE: Final = 0.7  # of the Pareto tail, above which the weights cannot be trusted
FEWEST_EFFECTIVE_DRAWS: Final = 20.0
DISAGREEMENT_SIGMAS: Final = 3.0  # of data and hand measurement
CLOCK: Final = "clock"
LABEL: Final = "label"
JUMP: Final = "jump"
DOUBTFUL_WEIGHT: Final = 0.5  # of a view or a measurement: its errors are 1.4 times what the levels say
