"""The results of one platform as figures ask for them: read once, checked against their schema."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa

from linepose.arrays import Floats
from linepose.config.platform import Platform
from linepose.estimation.outliers import OUTLIERS
from linepose.geometry.pose import POSE_COLUMNS
from linepose.output.figures.checks import accepted_rows, stage_rows, usable_rows
from linepose.pipeline.stages import POSE, SAMPLES
from linepose.survey.observations import OBSERVATIONS, POSITION_COLUMNS, Survey, survey_from_table
from linepose.tables import read_table


@dataclass(frozen=True)
class PlatformResults:
    """What figures know of a platform: its file, the folder of its results, and the folder of its data."""

    name: str
    platform: Platform
    folder: Path
    threshold_px: float
    data_folder: Path | None = None
    _read: dict[str, pd.DataFrame] = field(default_factory=dict)

    @property
    def noise_model(self) -> str:
        """Name of the platform's noise model."""
        return self.platform.noise_model

    @property
    def true_pose(self) -> Floats | None:
        """The true pose (6,) of a simulated platform."""
        simulation = self.platform.simulation
        return None if simulation is None else np.array(simulation.true_pose)

    @property
    def true_points_m(self) -> Floats | None:
        """The pattern's true points (M, 3) in map coordinates, of a simulated platform."""
        if not self.has("truth"):
            return None
        columns = [f"point_{name}" for name in POSITION_COLUMNS]
        truth = self.table("truth", pa.schema([pa.field(name, pa.float64()) for name in ("point", *columns)]))
        return np.array(truth.groupby("point")[columns].first())

    def table(self, name: str, schema: pa.Schema) -> pd.DataFrame:
        """A result by its name below the folder.

        Raises InputError where it is missing, lacks columns or rows, or has a gap in a column that may have none.
        """
        if name not in self._read:
            whole = [field.name for field in schema if not field.nullable]
            table = read_table(self.folder / f"{name}.parquet", schema)
            self._read[name] = usable_rows(table, whole, f"{self.name}/{name}.parquet")
        return self._read[name]

    def has(self, name: str) -> bool:
        """Whether this result was made."""
        return (self.folder / f"{name}.parquet").is_file()

    def survey(self) -> Survey:
        """All observations."""
        return survey_from_table(self.table("observations", OBSERVATIONS))

    def accepted(self) -> list[int]:
        """Numbers of the accepted observations."""
        return accepted_rows(self.table("outliers", OUTLIERS))["observation"].astype(int).tolist()

    def samples(self) -> pd.DataFrame:
        """The chain of the accepted observations."""
        return self.table("mcmc/inliers", SAMPLES)

    def pose(self, stage: str) -> Floats:
        """The pose (6,) of a stage, such as `inliers` or `hand_measured`."""
        rows = stage_rows(self.table("pose", POSE), stage, POSE_COLUMNS, "pose.parquet")
        return np.array(rows[list(POSE_COLUMNS)].iloc[0], dtype=float)

    def marked_poses(self) -> Mapping[str, Floats]:
        """The poses (6,) that figures mark, by the name in the legend."""
        marked = {"optimum": self.pose("inliers"), "hand measured": self.pose("hand_measured")}
        truth = self.true_pose
        return marked if truth is None else {**marked, "truth": truth}
