"""Python alone gives the numbers of the workflow, to the last bit."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from tiny_project import ROOT

import linepose
from linepose.tables import read_table

pytestmark = pytest.mark.workflow


def test_calibration_from_python_is_that_of_the_workflow(finished):
    calibration = linepose.calibrate_platform("tiny", finished.folder)
    folder = finished.folder / "results" / "tiny"
    for name, table in calibration.tables().items():
        made = read_table(folder / f"{name}.parquet")
        if "stage" in made:
            stages = ["inliers", "hand_measured"] if name == "pose" else ["inliers"]
            made = made[made["stage"].isin(stages)].reset_index(drop=True)
        assert len(made) == len(table), name
        for column in made:
            assert_array_equal(table[column].to_numpy(), made[column].to_numpy(), err_msg=f"{name}.{column}")


def test_covariance_is_that_of_the_workflows_samples(finished):
    calibration = linepose.calibrate_platform("tiny", finished.folder)
    samples = read_table(finished.folder / "results" / "tiny" / "mcmc" / "inliers.parquet").iloc[:, 2:8].to_numpy()
    assert_allclose(calibration.covariance, np.cov(samples.T), rtol=1e-10, atol=1e-15)  # summed in another order


def test_check_reads_scans_of_a_made_survey(finished):
    report = linepose.check_platform("tiny", finished.folder)
    found = " ".join(finding.found for finding in report.findings)
    assert "4 scans of 648 pixels" in found
    assert "60 points in 4 observations" in found
    assert report.level < 2, [finding for finding in report.findings if finding.level == 2]


def test_clone_has_what_the_commands_look_for():
    assert (ROOT / "Snakefile").is_file()
    assert (ROOT / "workflow" / "rules").is_dir()
