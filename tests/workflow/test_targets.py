"""Targets in a user's own scans, and stones that were clicked: from `linepose new` to the pose, by commands alone."""

import shutil
import sys
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from tiny_project import ROOT, STUDY, Project

from linepose.experiments.registry import SECTIONS
from linepose.geometry.pose import POSE_COLUMNS
from linepose.simulation.record import write_survey
from linepose.survey.targets.base import TargetSection
from linepose.survey.targets.charuco import CharucoSection
from linepose.survey.targets.chessboard import ChessboardSection
from linepose.survey.targets.rings import RingsSection
from linepose.tables import read_table

sys.path.insert(0, str(ROOT / "tests" / "unit"))
from target_scans import CAMERA, survey_of

pytestmark = pytest.mark.workflow
NEW = (
    "--focal-length-mm 8.2 --pixel-pitch-um 7.407407407 --pixels 648 --principal-point-px 323 --position-m 0.2 0 -0.8 "
    "--euler-deg -56 0 -90 --navigation navigation.parquet"
)
PASSES = (18, 8, 14, 20, 9)
BOARDS: dict[str, TargetSection] = {
    "chessboard": ChessboardSection(),
    "charuco": CharucoSection(),
    "rings": RingsSection.scaled(4, 7, 0.1),
}
POINTS = {"chessboard": 48, "charuco": 48, "rings": 28, "stones": 12}
CLICKED_SIGMA_PX = 1.0


def record_board(data: Path, name: str) -> None:
    """The scans of a board, without labels; the truth beside the data."""
    write_survey(data / name, CAMERA, survey_of(BOARDS[name], PASSES))
    (data / name / "labels.csv").unlink()
    (data / name / "truth.parquet").replace(data / f"{name}.truth")


def record_stones(data: Path) -> None:
    """The scans of the chessboard again, with twelve of its points clicked by hand as if they were stones."""
    shutil.copytree(data / "chessboard", data / "stones")
    truth = pd.read_parquet(data / "chessboard.truth").query("visible and point % 4 == 1")
    noise = CLICKED_SIGMA_PX * np.random.default_rng(7).standard_normal((2, len(truth)))
    labels = pd.DataFrame(
        {
            "observation": truth["observation"],
            "point": [f"stone {point}" for point in truth["point"]],
            "u_px": truth["u_px"] + noise[0],
            "line": truth["line"] + noise[1],
        }
    )
    labels.to_csv(data / "stones" / "labels.csv", index=False)
    (data / "stones.truth").symlink_to(data / "chessboard.truth")


def described(folder: Path, name: str) -> str:
    """What `linepose new --target` is given: the file of a board, or the kind."""
    if name not in BOARDS:
        return "points"
    (folder / f"{name}.yaml").write_text(yaml.safe_dump({"target": BOARDS[name].model_dump(mode="json")}))
    return f"{name}.yaml"


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    """Four platforms of one study, checked and calibrated; the data follow the simulated Ladybird."""
    folder = tmp_path_factory.mktemp("targets")
    made = Project(folder)
    for name in POINTS:
        new = made.linepose("new", name, *NEW.split(), "--target", described(folder, name))
        assert new.returncode == 0, new.stderr
        platform = folder / "config" / "platforms" / f"{name}.yaml"
        values = yaml.safe_load(platform.read_text())
        platform.write_text(yaml.safe_dump(values | {"experiments": dict.fromkeys(SECTIONS)}))
    config = folder / "config" / "config.yaml"
    config.write_text(yaml.safe_dump(STUDY | yaml.safe_load(config.read_text())))
    for name in BOARDS:
        record_board(folder / "data", name)
    record_stones(folder / "data")
    ran = made.linepose("run", "--all")
    assert ran.returncode == 0, ran.stderr
    return made


@pytest.mark.parametrize("name", POINTS)
def test_scans_lead_to_the_pose_within_three_stated_sigmas(project, name):
    checked = project.linepose("check", name)
    assert checked.returncode == 0, checked.stdout
    found = project.folder / "results" / name
    points = read_table(found / "points.parquet")
    assert points["point"].nunique() == POINTS[name]
    assert len(points) > 0.9 * POINTS[name] * len(PASSES)
    pose = read_table(found / "pose.parquet").query("stage == 'inliers'").iloc[0]
    truth = read_table(project.folder / "data" / f"{name}.truth").iloc[0]
    error = np.array([pose[one] - truth[one] for one in POSE_COLUMNS])
    sigma = np.array([pose[f"sigma_{one}"] for one in POSE_COLUMNS])
    assert np.all(np.abs(error) < 3 * sigma), error / sigma
