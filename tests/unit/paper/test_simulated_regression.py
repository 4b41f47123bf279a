import numpy as np
import pandas as pd
import pyarrow as pa
import pytest
from scipy.spatial.transform import Rotation

from linepose.experiments.truth_error import TRUTH_ERROR, true_pose, truth_error_table
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from linepose.paper.experiments_regression import BASIN_ROWS_OF
from linepose.paper.simulated_regression import extraction_rows, fault_rows, sigma_rows, truth_rows

TRUTH = np.array([0.2, -0.1, -0.8, -0.8, 0.7, -1.4])
PUBLISHED = {"sigma": [0.03, 0.05, 0.06, 0.016, 0.018, 0.009]}


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


@pytest.mark.parametrize(("factor", "passed"), [(1.39, True), (0.61, True), (1.41, False), (0.59, False)])
def test_sigmas_hold_to_forty_per_cent(factor, passed):
    obtained = pd.Series(dict(zip(SIGMA_COLUMNS, factor * np.array(PUBLISHED["sigma"]), strict=True)))
    rows = sigma_rows("robot", PUBLISHED, obtained)
    assert [row["passed"] for row in rows] == [passed] * 6
    assert {row["note"] for row in rows} == {"simulated"}


def outliers(removed, n=5):
    rows, left = [], list(range(1, n + 1))
    for turn, worst in enumerate([*removed, None]):
        rows += [
            {"n_observations": len(left), "observation": k, "removed": k == worst, "accepted": turn == len(removed)}
            for k in left
        ]
        left = [k for k in left if k != worst]
    return pd.DataFrame(rows)


def test_faults_are_the_observations_removed():
    truth = pd.DataFrame({"observation": [1, 2, 2, 3, 4, 5], "faulty": [False, True, True, False, True, False]})
    rows = fault_rows("robot", {"outliers": 2, "inliers": 3}, truth, outliers([4, 2]))
    assert len(rows) == 4
    assert all(row["passed"] for row in rows)
    wrong = {
        row["quantity"]: row["passed"]
        for row in fault_rows("robot", {"outliers": 2, "inliers": 3}, truth, outliers([4, 3]))
    }
    assert wrong == {
        "robot, section 4, number of outliers": True,
        "robot, section 4, number of inliers": True,
        "robot, planted fault 2 removed": False,
        "robot, planted fault 4 removed": True,
    }


def test_wholes_are_held_to_the_published_sigmas_of_their_parts(errors):
    error, _, table = errors
    rows = {row["quantity"]: row for row in truth_rows("robot", PUBLISHED, table)}
    position = rows["robot, error against truth, position_m"]
    assert position["obtained"] == pytest.approx(np.linalg.norm(error[:3]))
    assert position["tolerance"] == pytest.approx(3 * np.sqrt(0.03**2 + 0.05**2 + 0.06**2))
    rotation = rows["robot, error against truth, rotation_rad"]
    assert rotation["tolerance"] == pytest.approx(3 * np.sqrt(0.016**2 + 0.018**2 + 0.009**2))


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
    return extraction_rows("robot", accuracy, detection, {"u_px": 0.5, "v_px": 0.05})


@pytest.mark.parametrize(
    ("n_found", "n_wrong", "passed"),
    [
        ([50, 45], [0, 0], [True, True]),
        ([50, 44], [0, 0], [False, True]),
        ([50, 50], [1, 0], [True, False]),
        ([50, 50], [3, 3], [False, False]),
    ],
)
def test_detection_finds_nearly_all_and_mistakes_none(n_found, n_wrong, passed):
    assert [row["passed"] for row in extraction(n_found, n_wrong)[:2]] == passed


def test_extraction_holds_to_the_cameras_sigmas():
    u, v = extraction([50, 50], [0, 0], bias=0.3, sigma=0.2)[2:]
    assert u["obtained"] == pytest.approx(np.sqrt(0.3**2 + 0.2**2 * 14 / 15))
    assert u["passed"]
    assert v["obtained"] == pytest.approx(0.1)
    assert not v["passed"]


def test_error_beyond_its_own_sigmas_is_shown_and_explained(errors):
    table = errors[2].copy()
    table.loc[table["quantity"] == "r_x_m", "error_in_sigmas"] = -4.0
    rows = {row["quantity"]: row for row in truth_rows("robot", PUBLISHED, table)}
    beyond = rows["robot, error against truth in sigmas, r_x_m"]
    assert (beyond["passed"], beyond["known_deviation"], beyond["obtained"]) == (False, True, -4.0)
    assert "sigmas come out too small" in beyond["note"]
    assert rows["robot, error against truth, r_x_m"]["passed"]
    assert not rows["robot, error against truth in sigmas, r_y_m"]["known_deviation"]
    limits = [
        rows[f"robot, error against truth in sigmas, {name}"]["tolerance"] for name in ("r_x_m", "position_m", "pose")
    ]
    # 99.73 % points of chi with 1, 3 and 6 degrees of freedom, as tables print them
    np.testing.assert_allclose(limits, [3.0, 3.76, 4.48], atol=0.01)


def test_error_beyond_the_published_sigmas_fails(errors):
    table = errors[2].copy()
    table.loc[table["quantity"] == "theta_y_rad", "error"] = 0.06
    rows = {row["quantity"]: row for row in truth_rows("robot", PUBLISHED, table)}
    beyond = rows["robot, error against truth, theta_y_rad"]
    assert (beyond["passed"], beyond["known_deviation"]) == (False, False)


@pytest.mark.parametrize(
    ("inside", "outside", "passed", "known"),
    [
        (1.0, 0.6, [True, True], False),
        (0.61, 0.83, [True, True], False),
        (0.59, 0.35, [False, False], False),
        (1.0, 0.95, [True, False], True),
    ],
)
def test_basin_claims_hold_to_forty_per_cent(inside, outside, passed, known):
    summary = pd.DataFrame(
        {"optimiser": ["powell"] * 2, "region": ["inside", "outside"], "success_rate": [inside, outside]}
    )
    rows = BASIN_ROWS_OF["shrimp_simulated"]("robot", {"section4": {"basin": {"beyond_success_rate": 0.6}}}, summary)
    assert [row["passed"] for row in rows] == passed
    assert [row["known_deviation"] for row in rows] == [False, known]
    assert all("simulated" in row["note"] for row in rows)
