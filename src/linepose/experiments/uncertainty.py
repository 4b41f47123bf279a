"""Uncertainty against the number of observations, at each stage of the outlier removal (Fig. 9)."""

from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa

from linepose.experiments.experiment import Experiment
from linepose.experiments.inputs import Inputs
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from linepose.pipeline.stages import LAPLACE_SIGMA_COLUMNS, OPTIMA, POSE
from linepose.tables import floats, texts, whole_numbers

METHODS = ("mcmc", "laplace")
UNCERTAINTY: Final = pa.schema(
    [*texts("stage", "method"), *whole_numbers("n_observations"), *floats(*POSE_COLUMNS, *SIGMA_COLUMNS)]
)


def uncertainty_by_stage(optima: pd.DataFrame, poses: pd.DataFrame) -> pd.DataFrame:
    """Two rows a stage, `mcmc` and `laplace`: its pose and the sigma of each number; most observations first.

    `optima` as in `OPTIMA` has the sigmas of the curvature, `poses` as in `POSE` the sampled ones.
    """
    sampled = poses.set_index("stage").loc[optima["stage"], list(SIGMA_COLUMNS)].to_numpy()
    curved = optima[list(LAPLACE_SIGMA_COLUMNS)].to_numpy()
    parts = []
    for method, sigmas in zip(METHODS, (sampled, curved), strict=True):
        part = optima[["stage", "n_observations", *POSE_COLUMNS]].assign(method=method)
        part[list(SIGMA_COLUMNS)] = np.asarray(sigmas)
        parts.append(part)
    table = pd.concat(parts).sort_values(["n_observations", "method"], ascending=False, kind="stable")
    return table.reset_index(drop=True)


def _run(inputs: Inputs) -> dict[str, pd.DataFrame]:
    return {"uncertainty": uncertainty_by_stage(inputs.table("optima", OPTIMA), inputs.table("pose", POSE))}


EXPERIMENT: Final = Experiment(
    name="uncertainty",
    title="Uncertainty against observations",
    outputs={"uncertainty": UNCERTAINTY},
    run=_run,
    needs=("optima", "pose"),
    study=(),
    removal=True,
)
