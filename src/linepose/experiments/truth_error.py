"""How far an estimate is from the truth of a simulated survey, in metres, radians and its own sigmas."""

import logging
from collections.abc import Mapping
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa
from numpy.typing import ArrayLike

from linepose.arrays import Floats
from linepose.experiments.experiment import Experiment
from linepose.experiments.inputs import Inputs
from linepose.geometry import rotations
from linepose.geometry.pose import N_PARAMETERS, POSE_COLUMNS
from linepose.pipeline.stages import OPTIMA, SAMPLES
from linepose.tables import floats, read_table, texts, whole_numbers

_logger = logging.getLogger(__name__)

POSITION, ROTATION, POSE = "position_m", "rotation_rad", "pose"
_PARTS: Final = {POSITION: slice(0, 3), ROTATION: slice(3, 6), POSE: slice(0, 6)}

TRUTH_ERROR: Final = pa.schema(
    [
        *texts("stage"),
        *whole_numbers("n_observations"),
        *texts("quantity"),
        *floats("error", "sigma", "error_in_sigmas"),
    ]
)


def truth_error_table(optima: pd.DataFrame, samples: Mapping[str, Floats], true_pose: ArrayLike) -> pd.DataFrame:
    """One row a quantity of each stage: parameters, then position, rotation and pose as wholes.

    `optima` has a row a stage, `samples` (S, 6) the draws from its posterior, whose covariance gives the sigmas.
    A whole's error is the distance (m) or the angle between the rotations (rad); in sigmas it is the Mahalanobis
    distance, which for the whole pose, that has no unit, is the error itself. Columns as in
    `TRUTH_ERROR`.
    """
    truth = np.array(true_pose, dtype=float)  # a copy: tables give arrays that may not be written to
    rows = []
    for _, optimum in optima.iterrows():
        stage = {"stage": optimum["stage"], "n_observations": optimum["n_observations"]}
        estimate = optimum[list(POSE_COLUMNS)].to_numpy(dtype=float)
        covariance = np.cov(samples[optimum["stage"]], rowvar=False)
        error, sigma = estimate - truth, np.sqrt(np.diag(covariance))
        rows += [
            stage | {"quantity": name, "error": error[i], "sigma": sigma[i], "error_in_sigmas": error[i] / sigma[i]}
            for i, name in enumerate(POSE_COLUMNS)
        ]
        distance = {name: _mahalanobis(error[part], covariance[part, part]) for name, part in _PARTS.items()}
        spread = {name: float(np.linalg.norm(sigma[part])) for name, part in _PARTS.items()} | {POSE: 1.0}
        whole = {POSITION: float(np.linalg.norm(error[:3])), ROTATION: _angle(estimate, truth), POSE: distance[POSE]}
        rows += [
            stage | {"quantity": name, "error": whole[name], "sigma": spread[name], "error_in_sigmas": distance[name]}
            for name in _PARTS
        ]
    return pd.DataFrame(rows)


def true_pose(truth: pd.DataFrame) -> Floats:
    """The camera's pose (6,) that a table like results/NAME/truth.parquet holds in each row."""
    return truth[list(POSE_COLUMNS)].to_numpy(dtype=float)[0]


def flat_samples(chain: pd.DataFrame) -> Floats:
    """Draws (S, 6) of the pose of a table of samples."""
    return chain[list(POSE_COLUMNS)].to_numpy(dtype=float).reshape(-1, N_PARAMETERS)


def _mahalanobis(error: Floats, covariance: Floats) -> float:
    return float(np.sqrt(error @ np.linalg.solve(covariance, error)))


def _angle(estimate: Floats, truth: Floats) -> float:
    first, second = (rotations.matrix_from_rotation_vector(pose[3:]) for pose in (estimate, truth))
    return float(rotations.rotation_angle_rad(first, second))


def _run(inputs: Inputs) -> dict[str, pd.DataFrame]:
    optima, folder = inputs.table("optima", OPTIMA), Path(inputs.files["samples"])
    samples = {name: flat_samples(read_table(folder / f"{name}.parquet", SAMPLES)) for name in optima["stage"]}
    table = truth_error_table(optima, samples, true_pose(read_table(inputs.files["truth"])))
    whole = table[(table["stage"] == "inliers") & (table["quantity"] == POSE)].iloc[0]
    _logger.info("inliers: Mahalanobis distance to the truth %.2f", whole["error_in_sigmas"])
    return {"truth_error": table}


EXPERIMENT: Final = Experiment(
    name="truth_error",
    title="Error against the truth",
    outputs={"truth_error": TRUTH_ERROR},
    run=_run,
    needs=("optima", "samples", "truth"),
    study=(),
    truth=True,
)
