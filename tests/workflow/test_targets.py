"""A chessboard in a user's own scans, without any label: from `linepose new` to the pose."""

import sys

import numpy as np
import pytest
import yaml
from tiny_project import ROOT, STUDY, Project

from linepose.experiments.registry import SECTIONS
from linepose.geometry.pose import POSE_COLUMNS
from linepose.simulation.record import write_survey
from linepose.survey.targets.chessboard import ChessboardSection
from linepose.tables import read_table

sys.path.insert(0, str(ROOT / "tests" / "unit"))
from target_scans import CAMERA, survey_of

pytestmark = pytest.mark.workflow
NEW = "--focal-length-mm 8.2 --pixel-pitch-um 7.407407407 --pixels 648 --principal-point-px 323 --position-m 0.2 0 -0.8"
PASSES = (18, 8, 14, 20, 9)


def test_scans_of_a_chessboard_lead_to_the_pose(tmp_path):
    project = Project(tmp_path)
    (tmp_path / "board.yaml").write_text("target:\n  kind: chessboard\n  rows: 7\n  columns: 9\n")
    new = f"{NEW} --euler-deg -56 0 -90 --navigation navigation.parquet --target board.yaml"
    assert project.linepose("new", "mine", *new.split()).returncode == 0
    platform = tmp_path / "config" / "platforms" / "mine.yaml"
    values = yaml.safe_load(platform.read_text())
    platform.write_text(yaml.safe_dump(values | {"experiments": dict.fromkeys(SECTIONS)}))
    config = tmp_path / "config" / "config.yaml"
    config.write_text(yaml.safe_dump(STUDY | yaml.safe_load(config.read_text())))
    write_survey(tmp_path / "data" / "mine", CAMERA, survey_of(ChessboardSection(), PASSES))
    (tmp_path / "data" / "mine" / "labels.csv").unlink()
    (tmp_path / "data" / "mine" / "truth.parquet").replace(tmp_path / "truth.parquet")
    checked = project.linepose("check", "mine")
    assert checked.returncode == 0, checked.stdout
    ran = project.linepose("run", "mine")
    assert ran.returncode == 0, ran.stderr
    points = read_table(tmp_path / "results" / "mine" / "points.parquet")
    assert len(points) == 48 * len(PASSES)
    pose = read_table(tmp_path / "results" / "mine" / "pose.parquet").query("stage == 'inliers'").iloc[0]
    truth = read_table(tmp_path / "truth.parquet").iloc[0]
    error = np.array([pose[name] - truth[name] for name in POSE_COLUMNS])
    sigma = np.array([pose[f"sigma_{name}"] for name in POSE_COLUMNS])
    assert np.all(np.abs(error) < 3 * sigma), error / sigma
