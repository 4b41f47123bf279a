"""Uncertainty against the number of observations, at each stage of the outlier removal (Fig. 9)."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from linepose.errors import EstimationError
from linepose.likelihood.base import Likelihood
from linepose.optimise import laplace_covariance
from linepose.outliers import RejectionStage
from linepose.pose import N_PARAMETERS, POSE_COLUMNS, SIGMA_COLUMNS
from linepose.sampling import Chain


def uncertainty_by_stage(
    likelihood: Likelihood, stages: Sequence[RejectionStage], chains: Sequence[Chain]
) -> pd.DataFrame:
    """Two rows a stage, `mcmc` and `laplace`: the pose there and one standard deviation of each of its numbers.

    `likelihood` is that of all observations; `chains` holds the samples of each stage. The Laplace sigmas of a stage
    whose observations leave a direction of the pose open are NaN.
    """
    rows = []
    for stage, chain in zip(stages, chains, strict=True):
        remaining = likelihood.select(stage.number.tolist())
        try:
            laplace = np.sqrt(np.diag(laplace_covariance(remaining, stage.optimum.parameters)))
        except EstimationError:
            laplace = np.full(likelihood.n_parameters, np.nan)
        for method, sigma in (("mcmc", chain.sigma()), ("laplace", laplace)):
            rows.append(
                {
                    "n_observations": len(stage.number),
                    "method": method,
                    **dict(zip(POSE_COLUMNS, stage.optimum.parameters[:N_PARAMETERS], strict=True)),
                    **dict(zip(SIGMA_COLUMNS, sigma[:N_PARAMETERS], strict=True)),
                }
            )
    return pd.DataFrame(rows)
