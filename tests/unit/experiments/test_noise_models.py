import numpy as np
import pyarrow as pa
import pytest

from linepose.errors import InputError
from linepose.estimation.sampling import IndependenceSettings, SamplingSettings
from linepose.experiments.noise_models import (
    IDENTIFIABILITY,
    NOISE_MODELS,
    WEIGHTS,
    chosen,
    fit_noise_models,
    identifiability_table,
    noise_model_table,
    weights_table,
)
from unit.likelihood.small_survey import CAMERA, POSE, Truth, make_survey

SHORT = IndependenceSettings(n_walkers=24, n_burn_in=40, n_steps=30)
SETTINGS = {
    "published": SamplingSettings(n_walkers=12, n_burn_in=5, n_steps=20),
    "shared": SHORT,
    "balanced": SHORT,
    "robust": SHORT,
}
BAD_VIEW = 4


@pytest.fixture(scope="module")
def fits():
    """Ten views with shared errors, one of them 0.2 m off, which the second set leaves out."""
    survey = make_survey(10, 8, Truth(0.5, 0.05, 1.0), seed=2)
    survey.position_m[BAD_VIEW - 1] += [0.14, -0.1, 0.1]
    good = [number for number in range(1, 11) if number != BAD_VIEW]
    return list(fit_noise_models({"all": survey, "inliers": survey.select(good)}, CAMERA, SETTINGS, POSE, 1))


def fits_schema(table, schema):
    pa.Table.from_pandas(table, schema=schema, preserve_index=False)
    return set(table.columns) == set(schema.names)


def test_each_model_and_set_has_a_row_and_distances_are_from_the_shared_one(fits):
    table = noise_model_table(fits)
    assert fits_schema(table, NOISE_MODELS)
    assert table[["noise_model", "set"]].to_numpy().tolist() == [
        [model, name] for name in ("all", "inliers") for model in SETTINGS
    ]
    rows = table.set_index(["noise_model", "set"])
    assert rows.loc[("shared", "inliers"), ["distance_m", "angle_rad", "mahalanobis"]].tolist() == [0.0] * 3
    assert rows.loc["published"][["shared_level", "focal_length_m"]].isna().all().all()
    assert table["error_in_sigmas"].isna().all()
    levels = rows.loc[("shared", "inliers")]
    assert levels["pixel_level_low"] < levels["pixel_level"] < levels["pixel_level_high"]
    # eighty pixels say the level to a tenth; a factor of 1.5 is beyond four sigmas
    assert 1 / 1.5 < levels["pixel_level"] < 1.5
    same = chosen(fits, "shared", "all")
    assert rows.loc[("shared", "all"), "neg_log_likelihood"] == same.optimum.neg_log_likelihood


def test_errors_against_a_truth_are_in_metres_radians_and_own_sigmas(fits):
    table = noise_model_table(fits, POSE).set_index(["noise_model", "set"])
    fit = chosen(fits, "robust", "all")
    row = table.loc[("robust", "all")]
    assert row["position_error_m"] == pytest.approx(np.linalg.norm(fit.pose[:3] - POSE[:3]))
    difference = fit.pose - POSE
    expected = np.sqrt(difference @ np.linalg.solve(fit.pose_covariance(), difference))
    # rotation vectors and turns differ to second order in an angle of some hundredths
    assert row["error_in_sigmas"] == pytest.approx(expected, rel=0.2)


def test_the_bad_view_costs_the_robust_model_least(fits):
    table = noise_model_table(fits, POSE).set_index(["noise_model", "set"])["position_error_m"]
    assert table["robust", "all"] < table["shared", "all"]
    weights = weights_table(fits, [number for number in range(1, 11) if number != BAD_VIEW])
    assert fits_schema(weights, WEIGHTS)
    assert len(weights) == 80
    assert weights.loc[weights["view_weight"].idxmin(), "observation"] == BAD_VIEW
    assert set(weights.loc[weights["removed"], "observation"]) == {BAD_VIEW}


def test_prior_and_posterior_of_each_parameter_stand_side_by_side(fits):
    covariance = np.diag([0.1**2] * 3 + [0.03**2] * 3)
    table = identifiability_table(fits, POSE, covariance)
    assert fits_schema(table, IDENTIFIABILITY)
    prior = table.set_index("parameter")["prior_sigma"]
    assert prior["r_x_m"] == pytest.approx(0.1)
    assert prior["log_white_level"] == 1.5
    assert prior["principal_point_px"] == CAMERA.sigmas.principal_point_px
    posterior = table.set_index("parameter")["posterior_sigma"]
    assert posterior["r_x_m"] == pytest.approx(chosen(fits, "shared", "inliers").chain.sigma()[0])
    np.testing.assert_allclose(table["shrinkage"], 1 - (table["posterior_sigma"] / table["prior_sigma"]) ** 2)
    assert table["weakest_direction"].abs().idxmax() == table["weakest_direction"].idxmax()


def test_a_model_that_was_not_fitted_is_named(fits):
    with pytest.raises(InputError, match="no robust"):
        weights_table([fit for fit in fits if fit.noise_model != "robust"], [1])
