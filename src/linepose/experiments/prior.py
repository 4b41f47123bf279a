"""Whether data or prior decided each parameter: how far the data narrow what was known before them.

The measure is the data's weight where both are Gaussian, `1 - (posterior / prior variance)` with the prior counted in:
1 where the data decide, 0 where the prior does. Without a prior in the estimate it is the weight that the data would
have beside the hand measurement. Rotations are turns about the body's axes, which mean something to a reader.
"""

import logging
from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa
from numpy.typing import ArrayLike

from linepose.estimation.identifiability import DATA, data_weight, decider, identifiability, in_body_axes
from linepose.experiments.experiment import Experiment
from linepose.experiments.inputs import Inputs, log_rows
from linepose.geometry.pose import N_PARAMETERS, POSE_COLUMNS
from linepose.likelihood.prior import PosePrior
from linepose.tables import flags, floats, texts

_logger = logging.getLogger(__name__)

PRIOR_TABLE: Final = pa.schema(
    [
        *texts("parameter"),
        *floats("difference", "sigma", "prior_sigma", "data_weight"),
        *flags("prior_counted_in"),
        *texts("decided_by"),
    ]
)


IDENTIFIABILITY: Final = pa.schema(
    [
        *texts("parameter"),
        *floats("prior_sigma", "posterior_sigma", "shrinkage", "weakest_direction", "weakest_shrinkage"),
        *texts("weakest_in_words"),
    ]
)


def prior_table(pose: ArrayLike, covariance: ArrayLike, hand: PosePrior, counted_in: bool) -> pd.DataFrame:
    """One row a parameter: estimate minus prior, the sigma of each, the data's weight, and who decided.

    pose (6,) and covariance (6, 6) are the estimate's; `hand` is the hand measurement, in the estimate as a prior or
    not, as `counted_in` says. Columns as in `PRIOR_TABLE`.
    """
    names, turned = in_body_axes(POSE_COLUMNS, pose, covariance)
    sigma, differences = np.sqrt(np.diag(turned)), hand.difference(np.asarray(pose, dtype=float))
    return pd.DataFrame(
        [_row(names[k], differences[k], sigma[k], hand.sigma()[k], counted_in) for k in range(N_PARAMETERS)]
    )


def identifiability_table(pose: ArrayLike, covariance: ArrayLike, hand: PosePrior) -> pd.DataFrame:
    """One row a number of the pose (6,): the hand measurement's sigma against that of the estimate's (6, 6).

    Rotations are turns about the body's axes. Beside them stands the direction that the data narrow least. Columns as
    in `IDENTIFIABILITY`.
    """
    names, posterior = in_body_axes(POSE_COLUMNS, pose, covariance)
    found = identifiability(names, posterior, hand.sigma())
    return pd.DataFrame(
        {
            "parameter": names,
            "prior_sigma": found.prior_sigma,
            "posterior_sigma": found.posterior_sigma,
            "shrinkage": found.shrinkage,
            "weakest_direction": found.weakest_direction,
            "weakest_shrinkage": found.weakest_shrinkage,
            "weakest_in_words": found.weakest_in_words(),
        }
    )


def _row(name: str, difference: float, sigma: float, prior_sigma: float, counted_in: bool) -> dict[str, object]:
    weight = float(data_weight(sigma, prior_sigma, counted_in))
    return {
        "parameter": name,
        "difference": float(difference),
        "sigma": float(sigma),
        "prior_sigma": float(prior_sigma),
        "data_weight": weight,
        "prior_counted_in": counted_in,
        "decided_by": decider(weight) if counted_in else DATA,
    }


def _run(inputs: Inputs) -> dict[str, pd.DataFrame]:
    platform, reference = inputs.platform, inputs.reference
    hand, counted_in = platform.hand_measurement(), platform.pose_prior() is not None
    table = prior_table(reference.pose, reference.covariance, hand, counted_in)
    log_rows(_logger, "%s: decided by %s, weight of the data %.2f", table, ("parameter", "decided_by", "data_weight"))
    identified = identifiability_table(reference.pose, reference.covariance, hand)
    _logger.info("weakest direction: %s", identified["weakest_in_words"].iloc[0])
    return {"prior": table, "identifiability": identified}


EXPERIMENT: Final = Experiment(
    name="prior",
    title="Decided by data or prior",
    outputs={"prior": PRIOR_TABLE, "identifiability": IDENTIFIABILITY},
    run=_run,
    needs=("optima", "samples"),
    study=(),
)
