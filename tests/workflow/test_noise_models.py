"""The whole pipeline under a noise model with levels, and the noise models side by side."""

import numpy as np
import pandas as pd
import pytest
from tiny_project import STUDY, TINY

from linepose.geometry.pose import POSE_COLUMNS
from linepose.likelihood.shared import LEVEL_NAMES, SHARED_PARAMETERS

pytestmark = pytest.mark.workflow


@pytest.fixture(scope="module")
def balanced(finished, tmp_path_factory):
    """The finished project with its platform under the balanced noise model, run again: the one that needs most."""
    import shutil

    from tiny_project import Project

    folder = tmp_path_factory.mktemp("balanced") / "project"
    shutil.copytree(finished.folder, folder)
    project = Project(folder)
    experiments = TINY["experiments"] | {"noise_models": None, "repeatability": {"n_splits": 2}, "sensitivity": {}}
    project.configure(STUDY, {"tiny": TINY | {"noise_model": "balanced", "experiments": experiments}})
    run = project.run()
    assert run.returncode == 0, run.stderr
    return folder / "results"


def test_models_are_side_by_side(finished):
    results = finished.folder / "results" / "tiny"
    table = pd.read_parquet(results / "noise_models.parquet")
    assert table[["noise_model", "set"]].to_numpy().tolist() == [
        [model, name] for name in ("all", "inliers") for model in ("published", "shared", "balanced", "robust")
    ]
    published = table[table["noise_model"] == "published"].set_index("set")
    own = pd.read_parquet(results / "optima.parquet").set_index("stage")
    np.testing.assert_array_equal(
        published.loc["inliers", list(POSE_COLUMNS)].astype(float), own.loc["inliers", list(POSE_COLUMNS)].astype(float)
    )
    assert table["error_in_sigmas"].notna().all()
    assert len(pd.read_parquet(results / "weights.parquet")) == 60
    assert pd.read_parquet(results / "identifiability.parquet")["parameter"].tolist()[6:9] == list(LEVEL_NAMES)
    summary = pd.read_parquet(results / "consistency_summary.parquet")
    assert set(summary["noise_model"]) == {"published", "shared"}
    assert (summary["n_splits"] + summary["n_open"] == 2).all()
    assert "Which noise model?" in (finished.folder / "results" / "tiny" / "report.html").read_text()


def test_every_stage_runs_under_the_balanced_model(balanced):
    optima = pd.read_parquet(balanced / "tiny" / "optima.parquet")
    assert {*SHARED_PARAMETERS, "laplace_sigma_log_white_level"} <= set(optima.columns)
    samples = pd.read_parquet(balanced / "tiny" / "mcmc" / "inliers.parquet")
    settings = STUDY["independence_sampling"]
    assert len(samples) == settings["n_walkers"] * settings["n_steps"]
    assert set(SHARED_PARAMETERS) <= set(samples.columns)
    made = {path.stem for path in (balanced / "tiny").glob("*.parquet")}
    experiments = {"splits", "leave_one_out", "basin_summary", "mapping_summary", "sensitivity", "residuals"}
    assert experiments <= made
    assert "residual in pixels" not in set(pd.read_parquet(balanced / "tiny" / "sensitivity.parquet")["change"])
    # every parameter is diagnosed, and a short chain is told its section; one test, so one run
    table = pd.read_parquet(balanced / "tiny" / "diagnostics.parquet")
    inliers = table[table["stage"] == "inliers"]
    assert inliers["parameter"].tolist() == list(SHARED_PARAMETERS)
    assert inliers["warning"].str.contains("set independence_sampling.n_steps to").all()
    text = (balanced / "tiny" / "report.html").read_text()
    assert "noise model balanced" in text
    assert "independence_sampling.n_steps" in text
