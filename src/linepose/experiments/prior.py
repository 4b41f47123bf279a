"""Whether data or prior decided each parameter: how far the data narrow what was known before them.

The measure is the data's weight where both are Gaussian, `1 - (posterior / prior variance)` with the prior counted in:
1 where the data decide, 0 where the prior does. Without a prior in the estimate it is the weight that the data would
have beside the hand measurement. Rotations are turns about the body's axes, which mean something to a reader.
"""

import logging
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.estimation.identifiability import in_body_axes
from linepose.experiments.experiment import Experiment
from linepose.experiments.inputs import Inputs, log_rows
from linepose.geometry.pose import N_PARAMETERS
from linepose.likelihood.prior import PosePrior
from linepose.pipeline.stages import SAMPLES
from linepose.tables import flags, floats, read_table, texts

_logger = logging.getLogger(__name__)

DATA: Final = "data"
PRIOR: Final = "prior"
BOTH: Final = "data and prior"
_DECIDING: Final = 0.75  # of the weight; the sigma is then half the prior's or less

PRIOR_TABLE: Final = pa.schema(
    [
        *texts("parameter"),
        *floats("difference", "sigma", "prior_sigma", "data_weight"),
        *flags("prior_counted_in"),
        *texts("decided_by"),
    ]
)


def prior_table(
    names: Sequence[str],
    parameters: ArrayLike,
    covariance: ArrayLike,
    hand: PosePrior,
    others: Mapping[str, tuple[float, float]],
    counted_in: bool,
) -> pd.DataFrame:
    """One row a parameter: estimate minus prior, the sigma of each, the data's weight, and who decided.

    `names`, `parameters` (P,) and `covariance` (P, P) are the estimate's; `hand` is the hand measurement, in the
    estimate as a prior or not, as `counted_in` says. `others` has centre and sigma of the prior that a noise model
    brings for parameters beyond the pose; ones without are left out. Columns as in `PRIOR_TABLE`.
    """
    vector = np.asarray(parameters, dtype=float)
    turned_names, turned = in_body_axes(names, vector, covariance)
    sigma = np.sqrt(np.diag(turned))
    differences = hand.difference(vector[:N_PARAMETERS])
    rows = [_row(turned_names[k], differences[k], sigma[k], hand.sigma()[k], counted_in) for k in range(N_PARAMETERS)]
    for k, name in enumerate(names):
        if name in others:
            centre, prior_sigma = others[name]
            rows.append(_row(name, vector[k] - centre, sigma[k], prior_sigma, True))
    return pd.DataFrame(rows)


def data_weight(sigma: ArrayLike, prior_sigma: ArrayLike, counted_in: bool) -> Floats:
    """The data's share of the information, 0 to 1, of a parameter whose sigma has the prior counted in, or has not."""
    ratio = np.square(np.asarray(sigma, dtype=float) / np.asarray(prior_sigma, dtype=float))
    return np.clip(1 - ratio, 0.0, 1.0) if counted_in else 1 / (1 + ratio)


def _row(name: str, difference: float, sigma: float, prior_sigma: float, counted_in: bool) -> dict[str, object]:
    weight = float(data_weight(sigma, prior_sigma, counted_in))
    return {
        "parameter": name,
        "difference": float(difference),
        "sigma": float(sigma),
        "prior_sigma": float(prior_sigma),
        "data_weight": weight,
        "prior_counted_in": counted_in,
        "decided_by": _decider(weight) if counted_in else DATA,
    }


def _decider(weight: float) -> str:
    if weight >= _DECIDING:
        return DATA
    return PRIOR if weight <= 1 - _DECIDING else BOTH


def _run(inputs: Inputs) -> dict[str, pd.DataFrame]:
    platform, likelihood = inputs.platform, inputs.data.accepted
    names = likelihood.parameter_names
    samples = read_table(Path(inputs.files["samples"]) / "inliers.parquet", SAMPLES)[list(names)]
    table = prior_table(
        names,
        inputs.reference.parameters,
        np.cov(samples.to_numpy().T),
        platform.hand_measurement(),
        likelihood.parameter_priors(),
        platform.pose_prior() is not None,
    )
    log_rows(_logger, "%s: decided by %s, weight of the data %.2f", table, ("parameter", "decided_by", "data_weight"))
    return {"prior": table}


EXPERIMENT: Final = Experiment(name="prior", title="Decided by data or prior", outputs={"prior": PRIOR_TABLE}, run=_run)
