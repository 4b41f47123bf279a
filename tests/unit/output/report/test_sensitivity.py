"""What the pose depends on: how far it moves, from the tables of the experiments that were run."""

import numpy as np
import pandas as pd
import pytest

from linepose.experiments.sensitivity import SENSITIVITY
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from linepose.output.report.sensitivity import influence_section
from linepose.pipeline.calibration import Calibration
from linepose.tables import write_table
from unit import made_up


@pytest.fixture
def results(tmp_path):
    made_up.write_results(tmp_path / "made-up")
    return Calibration.from_results(tmp_path / "made-up", made_up.platform())


def sensitivity():
    rows = []
    for change, moved_m in (("nominal", 0.0), ("focal length + 1 sigma", 0.04)):
        pose = made_up.OPTIMUM + np.array([moved_m, 0, 0, 0, 0, 0])
        rows.append({"change": change, **dict(zip(POSE_COLUMNS, pose, strict=True)), "distance_m": moved_m})
    table = pd.DataFrame(rows).assign(n_observations=4, observations="1", n_evaluations=1, neg_log_likelihood=1.0)
    return table.assign(angle_rad=0.0, mahalanobis=2.5, **dict.fromkeys(SIGMA_COLUMNS, 0.1))


def test_changes_are_told_in_millimetres_and_the_estimate_itself_is_no_change(results):
    write_table(sensitivity(), results.results.path("sensitivity"), SENSITIVITY)
    section = influence_section(results)
    assert "focal length + 1 sigma moves the camera most: by 40 mm and 0.00°" in section.text
    settings = section.tables[0]
    assert settings.rows == [["focal length + 1 sigma", "4", "+40", "+0", "+0", "0.00", "2.5"]]


def test_the_most_influential_observation_comes_first(results):
    (table,) = influence_section(results).tables
    assert [row[0] for row in table.rows] == ["without 3", "without 2", "without 1", "without 4"]
    assert table.rows[0][-1] == "1.5"


def test_a_platform_without_these_experiments_has_no_section(results):
    results.results.path("leave_one_out").unlink()
    assert influence_section(results) is None
