"""What a calibration gives: the pose, how sure it is, and everything it rests on."""

from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa

from linepose.arrays import Floats
from linepose.estimation.outliers import OUTLIERS, removal_order, stage_observations
from linepose.geometry.pose import (
    N_PARAMETERS,
    euler_covariance,
    euler_pose,
)
from linepose.geometry.rotations import matrix_from_rotation_vector
from linepose.pipeline.pose_tables import PoseWithCovariance, quaternion, rotation_vector_numbers
from linepose.pipeline.residual_tables import ESTIMATED_POINTS, RESIDUALS
from linepose.pipeline.stages import DIAGNOSTICS, OPTIMA, POSE, SAMPLES
from linepose.pipeline.summary import gather_evidence
from linepose.pipeline.verdict import Verdict, judge
from linepose.survey.hand_measured import HandMeasured
from linepose.survey.observations import OBSERVATIONS, Survey, survey_from_table
from linepose.tables import with_parameters, write_table

_TABLES: Final = {
    "observations": OBSERVATIONS,
    "outliers": OUTLIERS,
    "optima": OPTIMA,
    "mcmc/inliers": SAMPLES,
    "diagnostics": DIAGNOSTICS,
    "pose": POSE,
    "residuals": RESIDUALS,
    "estimated_points": ESTIMATED_POINTS,
}


@dataclass(frozen=True, eq=False)
class Calibration:
    """The camera's pose on the vehicle and how sure it is.

    pose (6,): position in the body frame (m), rotation vector camera to body (rad); covariance (6, 6) of it, sampled.
    The tables have the columns of the workflow's results (`linepose.pipeline.result_schemas`).
    """

    pose: Floats
    covariance: Floats
    hand_measured: HandMeasured
    threshold_px: float
    noise_model: str
    observations: pd.DataFrame = field(repr=False)
    outlier_removal: pd.DataFrame = field(repr=False)
    optima: pd.DataFrame = field(repr=False)
    samples: pd.DataFrame = field(repr=False)
    diagnostics: pd.DataFrame = field(repr=False)
    poses: pd.DataFrame = field(repr=False)
    residuals: pd.DataFrame = field(repr=False)
    points: pd.DataFrame = field(repr=False)

    def __str__(self) -> str:
        """The pose for people: one number a line with its sigma, then what was removed and the verdict."""
        lines = [
            f"{name:8s}{value:10.4f} +- {sigma:.4f} {unit}"
            for name, value, sigma, unit in zip(
                ("forward", "right", "down", "roll", "pitch", "yaw"),
                (*self.position_m, *self.euler_deg),
                (*self.sigma[:3], *self.sigma_euler_deg),
                ("m", "m", "m", "deg", "deg", "deg"),
                strict=True,
            )
        ]
        removed = ", ".join(map(str, self.outliers)) or "none"
        return "\n".join([*lines, f"observations removed: {removed}", self.verdict().sentence])

    @property
    def position_m(self) -> Floats:
        """The camera in the body frame: forward, right, down (3,)."""
        return self.pose[:3]

    @property
    def sigma(self) -> Floats:
        """One standard deviation of each number of the pose (6,), m and rad."""
        return np.sqrt(np.diag(self.covariance))

    @property
    def euler_deg(self) -> Floats:
        """Roll, pitch, yaw, zyx intrinsic, camera to body (3,)."""
        return np.degrees(euler_pose(self.pose)[3:])

    @property
    def sigma_euler_deg(self) -> Floats:
        """One standard deviation of roll, pitch, yaw (3,), to first order."""
        return np.degrees(np.sqrt(np.diag(euler_covariance(self.pose, self.covariance))[3:]))

    @property
    def quaternion_wxyz(self) -> Floats:
        """Unit quaternion (w, x, y, z), camera to body."""
        return quaternion(self.pose)

    @property
    def matrix(self) -> Floats:
        """Homogeneous transform (4, 4) that takes points of the camera frame to the body frame (m)."""
        transform = np.eye(4)
        transform[:3, :3] = matrix_from_rotation_vector(self.pose[3:N_PARAMETERS])
        transform[:3, 3] = self.position_m
        return transform

    @property
    def inliers(self) -> list[int]:
        """Numbers of the observations that the pose rests on."""
        return stage_observations(self.outlier_removal)["inliers"]

    @property
    def outliers(self) -> list[int]:
        """Numbers of the observations that were removed, in that order."""
        return removal_order(self.outlier_removal)

    @property
    def neg_log_likelihood(self) -> float:
        """-log L at the pose."""
        return float(self.optima["neg_log_likelihood"].iloc[0])

    @property
    def reduced_chi_square(self) -> float:
        """Near one where the reported sigmas are right."""
        return float(self.optima["reduced_chi_square"].iloc[0])

    def verdict(self) -> Verdict:
        """Whether to trust the pose: a level, a sentence, and each check with what it found and what to do."""
        hand = PoseWithCovariance(self.hand_measured.pose, self.hand_measured.covariance)
        numbers = rotation_vector_numbers(PoseWithCovariance(self.pose, self.covariance), hand)
        return judge(gather_evidence(_InMemory(self), numbers))

    def tables(self) -> dict[str, pd.DataFrame]:
        """Every table by the name of the workflow's result."""
        return {
            "observations": self.observations,
            "outliers": self.outlier_removal,
            "optima": self.optima,
            "mcmc/inliers": self.samples,
            "diagnostics": self.diagnostics,
            "pose": self.poses,
            "residuals": self.residuals,
            "estimated_points": self.points,
        }

    def write(self, folder: Path | str) -> None:
        """Write every table into a folder as the workflow does: Parquet, whole or not at all."""
        for name, table in self.tables().items():
            schema = _TABLES[name]
            own = tuple(column for column in table.columns if column not in schema.names)
            write_table(table, Path(folder) / f"{name}.parquet", with_parameters(schema, own))


@dataclass(frozen=True)
class _InMemory:
    """A calibration's tables as the report's summary reads them."""

    calibration: Calibration

    @property
    def name(self) -> str:
        """What messages call it."""
        return "calibration"

    @property
    def threshold_px(self) -> float:
        return self.calibration.threshold_px

    @property
    def noise_model(self) -> str:
        return self.calibration.noise_model

    def table(self, name: str, schema: pa.Schema) -> pd.DataFrame:
        return self.calibration.tables()[name][schema.names]

    def has(self, name: str) -> bool:
        return name in self.calibration.tables()

    def survey(self) -> Survey:
        return survey_from_table(self.calibration.observations)

    def accepted(self) -> list[int]:
        return self.calibration.inliers

    def samples(self) -> pd.DataFrame:
        return self.calibration.samples
