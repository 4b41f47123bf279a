"""From where on a result of the adjustment is not to be trusted, and what a view that is far off is called."""

from typing import Final

TRUSTED_EIGENVALUE: Final = 0.3  # the least one below which the covariance is not to be trusted
TRUSTED_SHAPE: Final = 0.7  # of the Pareto tail, above which the weights cannot be trusted
FEWEST_EFFECTIVE_DRAWS: Final = 20.0
OPEN_SHARE: Final = 0.9  # of a prior's sigma, above which the data have said nothing
DISAGREEMENT_SIGMAS: Final = 3.0  # of data and hand measurement
MISFIT_SIGMAS: Final = 4.0  # of a board's known geometry, from which on it is not used
CLOCK: Final = "clock"
LABEL: Final = "label"
JUMP: Final = "jump"
UNCLEAR: Final = "unclear"
CAUSES: Final = {
    CLOCK: "its clock",
    LABEL: "labels",
    JUMP: "a jump of the navigation",
    UNCLEAR: "too few points tell why",
}
DEGREES_OF_FREEDOM: Final = 4.0  # of the Student-t tails
MEASUREMENT_DIMENSION: Final = 2
DOUBTFUL_WEIGHT: Final = 0.25  # of a view or a measurement: its errors are twice what the levels say
