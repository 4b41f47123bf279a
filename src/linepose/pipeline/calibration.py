"""What a calibration gives: the pose, how sure it is, and everything it rests on."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import pandas as pd
import pyarrow as pa

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.estimation.noise_models import noise_model
from linepose.estimation.outliers import OUTLIERS, OutlierSettings, removal_order
from linepose.geometry.camera import Camera
from linepose.geometry.pose import POSE_COLUMNS, euler_covariance, euler_pose
from linepose.geometry.pose_with_covariance import PoseWithCovariance
from linepose.pipeline.adjusted_intrinsics import INTRINSICS, AdjustedIntrinsics, intrinsics_from_table
from linepose.pipeline.adjusted_schemas import ADJUSTED, LEVELS, MEASUREMENTS, VIEWS
from linepose.pipeline.exports.options import ExportOptions
from linepose.pipeline.exports.write import export_calibration
from linepose.pipeline.residual_tables import ESTIMATED_POINTS, RESIDUALS
from linepose.pipeline.results import Results
from linepose.pipeline.stages import DIAGNOSTICS, OPTIMA, POSE, SAMPLES
from linepose.pipeline.table_checks import accepted_rows, stage_rows, usable_chain
from linepose.survey.hand_measured import HandMeasured
from linepose.survey.observations import OBSERVATIONS, POSITION_COLUMNS, Survey, survey_from_table
from linepose.tables import floats, point_column, with_parameters, write_table

if TYPE_CHECKING:
    from linepose.config.platform import Platform
    from linepose.pipeline.verdict import Verdict

INLIERS: Final = "inliers"
HAND_MEASURED: Final = "hand_measured"
TABLES: Final = {
    "observations": OBSERVATIONS,
    "outliers": OUTLIERS,
    "optima": OPTIMA,
    "mcmc/inliers": SAMPLES,
    "diagnostics": DIAGNOSTICS,
    "pose": POSE,
    "residuals": RESIDUALS,
    "estimated_points": ESTIMATED_POINTS,
}
_TRUE_POINT_COLUMNS: Final = [f"point_{name}" for name in POSITION_COLUMNS]


@dataclass(frozen=True, eq=False)
class Calibration:
    """The camera's pose on the vehicle and how sure it is; what `calibrate` returns and a results folder holds.

    `pose` (6,) is the camera in the body frame (m) and its rotation vector (rad), `covariance` (6, 6) its covariance,
    `matrix` (4, 4) takes points of the camera to the body. All is read from the tables when it is first asked for; one
    that cannot be used then raises InputError.

    Parameters
    ----------
    results : Results
        The tables that it rests on, in memory or as files of results/NAME.
    hand_measured : HandMeasured
        The pose by tape measure (m, deg), where the search started.
    camera : Camera
        Intrinsic parameters as they were given; `own_camera` has those that were estimated.
    threshold_px : float
        Of the outlier removal (px), where the noise model has one.
    noise_model : str
        The model by which the pose was estimated.
    stage : str
        Of which the pose is: `inliers`, `all`, `hand_measured`, or `observations_N`.
    platform : Platform, optional
        The platform's file, where there is one.
    data_folder : Path, optional
        What the platform recorded.

    Examples
    --------
    >>> calibration = linepose.calibrate_platform("myrobot")
    >>> calibration.pose.shape, calibration.covariance.shape, calibration.stage
    ((6,), (6, 6), 'inliers')
    """

    results: Results
    hand_measured: HandMeasured
    camera: Camera
    threshold_px: float
    noise_model: str
    stage: str = INLIERS
    platform: "Platform | None" = field(default=None, repr=False)
    data_folder: Path | None = None

    @classmethod
    def from_results(
        cls,
        folder: Path | str,
        platform: "Platform",
        threshold_px: float = OutlierSettings().threshold_px,
        stage: str = INLIERS,
        data_folder: Path | None = None,
    ) -> "Calibration":
        """The calibration of a platform whose results stand in a folder, results/NAME.

        `threshold_px` is that of the outlier removal, for the verdict.
        """
        results = Results(Path(folder).name, Path(folder))
        hand, camera = platform.hand_measured, platform.intrinsics()
        return cls(results, hand, camera, threshold_px, platform.noise_model, stage, platform, data_folder)

    def __str__(self) -> str:
        """The pose for people: one number a line with its sigma, then what it rests on and the verdict."""
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
        return "\n".join([*lines, self._observations_in_words(), self.verdict().sentence])

    def _observations_in_words(self) -> str:
        if not noise_model(self.noise_model).removes_outliers:
            return f"observations used: all {len(self.inliers)}, each with its weight"
        return f"observations removed: {', '.join(map(str, self.outliers)) or 'none'}"

    @property
    def name(self) -> str:
        """Name of the platform."""
        return self.results.name

    @property
    def platform_file(self) -> "Platform":
        """What the platform's file says; raises InputError for a calibration of arrays alone."""
        if self.platform is None:
            raise InputError(self.name, "no platform file", "a calibration of a platform", "use calibrate_platform")
        return self.platform

    @cached_property
    def estimate(self) -> PoseWithCovariance:
        """The stage's pose with its covariance: that of the samples, or of the hand measurement."""
        if self.stage == HAND_MEASURED:
            return PoseWithCovariance(self.pose_of(self.stage), self.hand_measured.covariance)
        self.pose_of(self.stage)  # a stage that is unknown is told before samples are missed
        samples = self.results.table(f"mcmc/{self.stage}", SAMPLES)
        return PoseWithCovariance(self.pose_of(self.stage), np.cov(usable_chain(samples).T))

    @property
    def pose(self) -> Floats:
        """Position in the body frame (m) and rotation vector, camera to body (rad); (6,)."""
        return self.estimate.pose

    @property
    def covariance(self) -> Floats:
        """Covariance (6, 6) of the pose, m and rad."""
        return self.estimate.covariance

    @property
    def covariance_from(self) -> str:
        """What the covariance rests on, in words."""
        if self.stage == HAND_MEASURED:
            return "sigmas of the hand measurement"
        return f"{len(self.results.table(f'mcmc/{self.stage}', SAMPLES))} samples"

    @property
    def is_adjusted(self) -> bool:
        """Whether the pose is an adjustment's, with which intrinsics, levels and corrections were found."""
        return self.stage == INLIERS and not noise_model(self.noise_model).removes_outliers

    @cached_property
    def intrinsics(self) -> AdjustedIntrinsics | None:
        """Principal point and focal length that were estimated with the pose; None where the pose is not adjusted."""
        return (
            intrinsics_from_table(self.results.table("adjusted_intrinsics", INTRINSICS)) if self.is_adjusted else None
        )

    @property
    def own_camera(self) -> Camera:
        """The camera that belongs to the pose: with the adjusted principal point and focal length where there are."""
        return self.camera if self.intrinsics is None else self.intrinsics.camera(self.camera)

    @property
    def n_observations(self) -> int:
        """How many observations the stage has."""
        return int(self._row_of(self.stage)["n_observations"])

    @property
    def position_m(self) -> Floats:
        """The camera in the body frame: forward, right, down (3,)."""
        return self.pose[:3]

    @property
    def sigma(self) -> Floats:
        """One standard deviation of each number of the pose (6,), m and rad."""
        return self.estimate.sigma

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
        return self.estimate.quaternion_wxyz

    @property
    def matrix(self) -> Floats:
        """Homogeneous transform (4, 4) that takes points of the camera frame to the body frame (m)."""
        return self.estimate.matrix

    @property
    def true_pose(self) -> Floats | None:
        """The true pose (6,) of a simulated platform."""
        return None if self.platform is None else self.platform.true_pose

    @property
    def true_points_m(self) -> Floats | None:
        """The pattern's true points (M, 3) in map coordinates, of a simulated platform."""
        from_the_air = self.platform is not None and self.platform.flight is not None
        if from_the_air or not self.results.has("truth"):
            return None
        truth = self.results.table("truth", pa.schema([point_column(), *floats(*_TRUE_POINT_COLUMNS)]))
        return np.array(truth.groupby("point")[_TRUE_POINT_COLUMNS].first())

    @property
    def inliers(self) -> list[int]:
        """Numbers of the observations that the pose rests on."""
        return accepted_rows(self.outlier_removal)["observation"].astype(int).tolist()

    @property
    def outliers(self) -> list[int]:
        """Numbers of the observations that were removed, in that order; the adjustment removes none."""
        return removal_order(self.outlier_removal)

    @property
    def neg_log_likelihood(self) -> float:
        """-log L at the pose."""
        return float(self._row_of(self.stage)["neg_log_likelihood"])

    @property
    def reduced_chi_square(self) -> float:
        """Near one where the reported sigmas are right."""
        return float(
            stage_rows(self.optima, self.stage, [], f"{self.name}/optima.parquet")["reduced_chi_square"].iloc[0]
        )

    @property
    def observations(self) -> pd.DataFrame:
        """Every observed point; columns as in `OBSERVATIONS`."""
        return self.results.table("observations", OBSERVATIONS)

    @property
    def outlier_removal(self) -> pd.DataFrame:
        """The stages of the outlier removal; columns as in `OUTLIERS`."""
        return self.results.table("outliers", OUTLIERS)

    @property
    def optima(self) -> pd.DataFrame:
        """The optimum of each stage; columns as in `OPTIMA`."""
        return self.results.table("optima", OPTIMA)

    @property
    def samples(self) -> pd.DataFrame:
        """The chain of the accepted observations; columns as in `SAMPLES`."""
        return self.results.table("mcmc/inliers", SAMPLES)

    @property
    def diagnostics(self) -> pd.DataFrame:
        """The chain's length and mixing; columns as in `DIAGNOSTICS`."""
        return self.results.table("diagnostics", DIAGNOSTICS)

    @property
    def poses(self) -> pd.DataFrame:
        """The pose of each stage, the hand-measured one first; columns as in `POSE`."""
        return self.results.table("pose", POSE)

    @property
    def residuals(self) -> pd.DataFrame:
        """What is left over of each point; columns as in `RESIDUALS`."""
        return self.results.table("residuals", RESIDUALS)

    @property
    def levels(self) -> pd.DataFrame:
        """The scales of the errors that the adjustment found; columns as in `LEVELS`."""
        return self.results.table("levels", LEVELS)

    @property
    def adjusted_views(self) -> pd.DataFrame:
        """Weight, mean correction and fault of each observation of an adjustment; columns as in `VIEWS`."""
        return self.results.table("adjusted_views", VIEWS)

    @property
    def adjusted_measurements(self) -> pd.DataFrame:
        """Correction, weight and normalised residual of each measurement; columns as in `MEASUREMENTS`."""
        return self.results.table("adjusted_measurements", MEASUREMENTS)

    @property
    def points(self) -> pd.DataFrame:
        """The pattern's estimated points; columns as in `ESTIMATED_POINTS`."""
        return self.results.table("estimated_points", ESTIMATED_POINTS)

    def survey(self) -> Survey:
        """All observations as arrays."""
        return survey_from_table(self.observations)

    def pose_of(self, stage: str) -> Floats:
        """The pose (6,) of a stage, such as `inliers` or `hand_measured`; raises InputError for an unknown one."""
        return np.array(self._row_of(stage)[list(POSE_COLUMNS)], dtype=float)

    def marked_poses(self) -> Mapping[str, Floats]:
        """The poses (6,) that figures mark, by the name in the legend."""
        marked = {"optimum": self.pose_of(INLIERS), "hand measured": self.pose_of(HAND_MEASURED)}
        truth = self.true_pose
        return marked if truth is None else {**marked, "truth": truth}

    def verdict(self) -> "Verdict":
        """Whether to trust the pose: a level, a sentence, and each check with what it found and what to do."""
        from linepose.pipeline.evidence import gather_evidence
        from linepose.pipeline.verdict import judge

        return judge(gather_evidence(self))

    def tables(self) -> dict[str, pd.DataFrame]:
        """Every table by the name of the workflow's result."""
        schemas = TABLES | {name: schema for name, schema in ADJUSTED.items() if self.results.has(name)}
        return {name: self.results.table(name, schema) for name, schema in schemas.items()}

    def write(self, folder: Path | str) -> None:
        """Write every table into a folder as the workflow does: Parquet, whole or not at all."""
        for name, table in self.tables().items():
            schema = (TABLES | ADJUSTED)[name]
            own = tuple(column for column in table.columns if column not in schema.names)
            write_table(table, Path(folder) / f"{name}.parquet", with_parameters(schema, own))

    def export(self, format: str, path: Path | str, **options: Any) -> Path:
        """Write the pose, or the points that it maps, as a robot or a map reads them; the path that was written.

        `format` is one of `linepose export --list`; `path` a file, or a folder in which one is named after platform and
        format. `options` are the fields of `ExportOptions`: parent_frame, child_frame,
        body_axes, scan. Raises InputError for an unknown format, and for results that it needs and that are missing.
        """
        return export_calibration(self, format, Path(path), ExportOptions(**options))

    def _row_of(self, stage: str) -> "pd.Series[Any]":
        rows = self.poses.set_index("stage")
        if stage not in rows.index:
            known = ", ".join(rows.index)
            raise InputError(f"stage of {self.name}", repr(stage), f"one of {known}", "name one of them")
        return rows.loc[stage]
