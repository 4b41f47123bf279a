import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
from scipy.spatial.transform import Rotation

from linepose.experiments.truth_error import TRUTH_ERROR, true_pose, truth_error_table
from linepose.geometry.pose import POSE_COLUMNS
from linepose.paper.simulated_numbers import extraction_numbers, fault_numbers, truth_numbers
from unit.paper.reproduced import outliers

TRUTH = np.array([0.2, -0.1, -0.8, -0.8, 0.7, -1.4])
SIGMA = [0.03, 0.05, 0.06, 0.016, 0.018, 0.009]


@pytest.fixture
def errors():
    """An estimate that is off by a known part of known sigmas, with correlated samples of exactly that covariance."""
    rng = np.random.default_rng(4)
    mixing = np.tril(rng.normal(size=(6, 6)) * 0.3) + np.diag([1.0, 2.0, 3.0, 0.5, 0.6, 0.7])
    raw = rng.standard_normal((500, 6))
    raw = (raw - raw.mean(axis=0)) @ np.linalg.inv(np.linalg.cholesky(np.cov(raw, rowvar=False))).T
    covariance = 1e-4 * mixing @ mixing.T
    samples = raw @ (1e-2 * mixing).T + TRUTH
    error = np.array([0.01, -0.02, 0.02, 0.003, -0.004, 0.005])
    optima = pd.DataFrame(
        [{"stage": "inliers", "n_observations": 16, **dict(zip(POSE_COLUMNS, TRUTH + error, strict=True))}]
    )
    return error, covariance, truth_error_table(optima, {"inliers": samples}, TRUTH)


def test_error_of_each_parameter_in_its_unit_and_in_sigmas(errors):
    error, covariance, table = errors
    parameters = table.set_index("quantity").loc[list(POSE_COLUMNS)]
    np.testing.assert_allclose(parameters["error"], error, atol=1e-12)
    np.testing.assert_allclose(parameters["sigma"], np.sqrt(np.diag(covariance)), rtol=1e-9)
    np.testing.assert_allclose(parameters["error_in_sigmas"], error / np.sqrt(np.diag(covariance)), rtol=1e-9)


def test_error_of_the_whole(errors):
    error, covariance, table = errors
    whole = table.set_index("quantity")
    assert whole.loc["position_m", "error"] == pytest.approx(np.linalg.norm(error[:3]))
    turned = Rotation.from_rotvec(TRUTH[3:]).inv() * Rotation.from_rotvec(TRUTH[3:] + error[3:])
    assert whole.loc["rotation_rad", "error"] == pytest.approx(turned.magnitude())
    for name, part in {"position_m": slice(0, 3), "rotation_rad": slice(3, 6), "pose": slice(0, 6)}.items():
        expected = np.sqrt(error[part] @ np.linalg.inv(covariance[part, part]) @ error[part])
        assert whole.loc[name, "error_in_sigmas"] == pytest.approx(expected)


def test_truth_from_a_table_of_results(tmp_path, errors):
    columns = {name: np.full(3, value) for name, value in zip(POSE_COLUMNS, TRUTH, strict=True)}
    pd.DataFrame(columns).to_parquet(tmp_path / "truth.parquet")
    truth = true_pose(pd.read_parquet(tmp_path / "truth.parquet"))
    truth.flags.writeable = False  # as tables may give it
    np.testing.assert_array_equal(truth, TRUTH)
    optima = pd.DataFrame([{"stage": "all", "n_observations": 3, **dict(zip(POSE_COLUMNS, TRUTH, strict=True))}])
    samples = {"all": np.random.default_rng(0).normal(size=(50, 6))}
    assert np.all(truth_error_table(optima, samples, truth)["error"] == 0.0)


def test_table_fits_its_schema(errors):
    table = errors[2]
    assert pa.Table.from_pandas(table, schema=TRUTH_ERROR, preserve_index=False).num_rows == 9


def test_faults_are_the_observations_removed():
    truth = pd.DataFrame({"observation": [1, 2, 2, 3, 4, 5], "faulty": [False, True, True, False, True, False]})
    counts = {"outliers": 2, "inliers": 3}
    for removed, obtained in (([4, 2], [2, 3, 2, 4]), ([4, 3], [2, 3, 0, 4])):
        numbers = fault_numbers("robot", counts, truth, outliers(5, removed))
        assert [number.published for number in numbers] == [2, 3, 2, 4]
        assert [number.obtained for number in numbers] == obtained


def test_errors_stand_beside_the_published_sigmas(errors):
    error, covariance, table = errors
    numbers = {number.quantity: number for number in truth_numbers("robot", SIGMA, table)}
    assert len(numbers) == 8 + 9
    one = numbers["robot, error against truth, r_y_m"]
    assert (one.published, one.obtained, one.sigma) == (0.0, pytest.approx(error[1]), 0.05)
    position = numbers["robot, error against truth, position_m"]
    assert position.obtained == pytest.approx(np.linalg.norm(error[:3]))
    assert position.sigma == pytest.approx(np.sqrt(0.03**2 + 0.05**2 + 0.06**2))
    assert numbers["robot, error against truth, rotation_rad"].sigma == pytest.approx(
        np.sqrt(0.016**2 + 0.018**2 + 0.009**2)
    )
    in_sigmas = numbers["robot, error against truth in sigmas, r_y_m"]
    assert in_sigmas.obtained == pytest.approx(error[1] / np.sqrt(covariance[1, 1]))


def extraction(n_found, n_wrong, bias=0.0, sigma=0.01):
    accuracy = pd.DataFrame(
        {
            "chosen": [True, False] * 2,
            "n_points": 15,
            "n_missing": 0,
            "bias_u_px": [bias, 9.0] * 2,
            "sigma_u_px": [sigma, 9.0] * 2,
            "bias_v_px": 0.1,
            "sigma_v_px": 0.0,
        }
    )
    detection = pd.DataFrame({"n_visible": [50, 50], "n_found": n_found, "n_wrong": n_wrong})
    return extraction_numbers("robot", accuracy, detection)


@pytest.mark.parametrize(
    ("n_found", "n_wrong", "right", "wrong"), [([50, 45], [0, 0], 95, 0), ([50, 50], [1, 0], 99, 1)]
)
def test_points_found_are_those_with_their_own_id(n_found, n_wrong, right, wrong):
    found, mistaken = extraction(n_found, n_wrong)[:2]
    assert (found.published, found.obtained) == (100, right)
    assert (mistaken.published, mistaken.obtained) == (0, wrong)


def test_extraction_error_is_bias_and_scatter_together():
    u, v = extraction([50, 50], [0, 0], bias=0.3, sigma=0.2)[2:]
    assert u.obtained == pytest.approx(np.sqrt(0.3**2 + 0.2**2 * 14 / 15))
    assert v.obtained == pytest.approx(0.1)
