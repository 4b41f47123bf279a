"""The tables of an adjustment: they fit their schemas, and say what the adjustment found."""

import numpy as np
import pytest

from linepose.adjustment import AdjustmentSettings
from linepose.adjustment.levels import LEVEL_NAMES
from linepose.estimation.adjustment_estimator import AdjustmentEstimator
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS, euler_pose
from linepose.pipeline.adjusted_intrinsics import intrinsics_from_table
from linepose.pipeline.adjusted_schemas import ADJUSTED, CORRECTION_COLUMNS, STAGES
from linepose.pipeline.adjusted_tables import adjusted_tables
from linepose.pipeline.stages import SAMPLES
from linepose.survey.hand_measured import HandMeasured
from linepose.tables import read_table, write_table
from unit.adjustment import timed_survey

SEED = 5


@pytest.fixture(scope="module")
def estimator():
    survey = timed_survey.make_survey(8, 6, seed=2)
    survey.u_px[3, 4] = np.nan
    pose = timed_survey.POSE
    hand = HandMeasured(position_m=tuple(pose[:3].tolist()), euler_deg=tuple(np.degrees(euler_pose(pose)[3:]).tolist()))
    settings = AdjustmentSettings(line_period_s=timed_survey.LINE_S, n_draws=20, n_samples=60)
    return AdjustmentEstimator(survey, timed_survey.CAMERA, hand, settings)


@pytest.fixture(scope="module")
def tables(estimator):
    return adjusted_tables(estimator, SEED)


def test_every_table_fits_its_schema(tables, tmp_path):
    schemas = STAGES | ADJUSTED | {"mcmc/inliers": SAMPLES}
    assert set(tables) == set(schemas)
    for name, schema in schemas.items():
        write_table(tables[name], tmp_path / f"{name}.parquet", schema)
        assert len(read_table(tmp_path / f"{name}.parquet", schema)) == len(tables[name])


def test_the_numbers_are_the_adjustments(tables, estimator):
    found = estimator.adjusted(seed=SEED)
    pose = tables["pose"].set_index("stage")
    np.testing.assert_array_equal(pose.loc["inliers", list(POSE_COLUMNS)].to_numpy(dtype=float), found.pose)
    np.testing.assert_array_equal(pose.loc["inliers", list(SIGMA_COLUMNS)].to_numpy(dtype=float), found.sigma)
    levels = tables["levels"].set_index("level")
    assert levels.index.tolist() == list(LEVEL_NAMES)
    assert levels.loc["drift", "value"] == found.levels.drift
    assert np.all(levels["prior_low"] < levels["prior_median"])
    views = tables["adjusted_views"].set_index("observation")
    number = estimator.survey.number[3]
    mean = np.nanmean(found.corrections[3], axis=0)
    np.testing.assert_allclose(views.loc[number, list(CORRECTION_COLUMNS)].to_numpy(dtype=float), mean)
    told = tables["diagnostics"]
    assert told["least_eigenvalue"].unique().tolist() == [found.diagnostics.least_eigenvalue]
    np.testing.assert_array_equal(told["disagreement_sigmas"], found.diagnostics.disagreement_sigmas)


def test_a_point_that_was_not_seen_is_in_no_table(tables):
    for name in ("adjusted_measurements", "residuals"):
        assert len(tables[name]) == 47
        of_view = tables[name]["observation"] == tables[name]["observation"].unique()[3]
        assert tables[name].loc[of_view, "point"].tolist() == [0, 1, 2, 3, 5]


def test_all_observations_are_accepted(tables):
    assert tables["outliers"]["accepted"].all()
    assert not tables["outliers"]["removed"].any()
    assert tables["optima"]["stage"].tolist() == ["inliers"]


def test_principal_point_and_focal_length_are_kept_with_how_the_pose_follows_them(tables, estimator):
    found = estimator.adjusted(seed=SEED)
    kept = intrinsics_from_table(tables["adjusted_intrinsics"])
    assert kept.names == ("principal_point_px", "focal_length_m")
    assert kept.estimate.tolist() == [found.principal_point_px, found.focal_length_m]
    assert kept.prior.tolist() == [estimator.camera.principal_point_px, estimator.camera.focal_length_m]
    assert kept.prior_sigma.tolist() == [2.0, estimator.camera.sigmas.focal_length_m]
    assert kept.sigma.tolist() == np.sqrt(np.diag(found.intrinsics_covariance)).tolist()
    np.testing.assert_array_equal(kept.covariance, found.intrinsics_covariance)
    np.testing.assert_array_equal(kept.pose_by_intrinsics, found.pose_by_intrinsics)
    camera = kept.camera(estimator.camera)
    assert camera.principal_point_px != estimator.camera.principal_point_px
    assert camera.sigmas == estimator.camera.sigmas
