from pathlib import Path

import numpy as np
import pytest

from linepose.config.platform import Platform
from linepose.geometry.pose import POSE_COLUMNS
from linepose.geometry.rotations import matrix_from_rotation_vector
from linepose.pipeline.calibration import Calibration
from unit import made_up


class Made:
    """The made-up platform's results, exported at will, and what its pose and covariance are."""

    def __init__(self, results: Path, platform: Platform) -> None:
        self.results, self.platform = results, platform
        self.covariance = np.cov(made_up.samples()[list(POSE_COLUMNS)].to_numpy().T)
        self.matrix = np.eye(4)
        self.matrix[:3, :3] = matrix_from_rotation_vector(made_up.OPTIMUM[3:])
        self.matrix[:3, 3] = made_up.OPTIMUM[:3]

    def export(self, format: str, output: Path, stage: str = "inliers", **options) -> Path:
        calibration = Calibration.from_results(self.results / "made-up", self.platform, stage=stage)
        return calibration.export(format, output, **options)


@pytest.fixture(scope="session")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("results")
    made_up.write_results(folder / "made-up")
    return folder


@pytest.fixture
def made(results):
    """The made-up platform in UTM zone 56 south."""
    return Made(results, made_up.platform(map_frame={"crs": "EPSG:32756"}))
