"""Starts at their cell's distance and angle, rows that depend on nothing else, intervals against the closed form."""

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation
from scipy.stats import kstest

from linepose.errors import InputError
from linepose.estimation.likelihood_estimator import LikelihoodEstimator
from linepose.estimation.optimise import Optimum
from linepose.estimation.optimisers import OPTIMISERS
from linepose.experiments.basin import BasinSettings, Sweep, chosen_searches, start_pose, summarise, wilson_interval
from unit.experiments.conftest import SIGMA, TRUE_POSE

GRID = BasinSettings(n_distances=6, n_angles=5)


@pytest.mark.parametrize("reference", [TRUE_POSE, np.array([0, 0, 0, 2.0, -1.9, 1.2])], ids=["usual", "near pi"])
def test_start_lies_at_its_cells_distance_and_angle(reference):
    for cell in range(GRID.n_cells):
        start = start_pose(GRID, reference, 1, cell)
        distance, angle = GRID.offset(cell)
        assert np.linalg.norm(start[:3] - reference[:3]) == pytest.approx(distance, rel=1e-12)
        between = Rotation.from_rotvec(start[3:]) * Rotation.from_rotvec(reference[3:]).inv()
        assert between.magnitude() == pytest.approx(angle, rel=1e-9)


def test_cells_tile_the_whole_range_uniformly():
    offsets = np.array([GRID.offset(cell) for cell in range(GRID.n_cells)])
    assert len(np.unique(offsets, axis=0)) == 30
    np.testing.assert_allclose(np.unique(offsets[:, 0].round(12)), (np.arange(6) + 0.5) / 3)
    np.testing.assert_allclose(np.degrees(np.unique(offsets[:, 1].round(12))), [6, 18, 30, 42, 54])


@pytest.mark.statistical
def test_directions_and_axes_are_uniform_on_the_sphere():
    """A uniform direction's coordinates are uniform on [-1, 1] (Archimedes); Kolmogorov-Smirnov at 0.1 %, seeded."""
    grid = BasinSettings(n_distances=40, n_angles=40)
    starts = np.array([start_pose(grid, np.zeros(6), 2, cell) for cell in range(grid.n_cells)])
    for part in (starts[:, :3], starts[:, 3:]):
        unit = part / np.linalg.norm(part, axis=1, keepdims=True)
        for axis in range(3):
            assert kstest(unit[:, axis], "uniform", args=(-1, 2)).pvalue > 1e-3


def test_start_is_a_function_of_seed_and_cell():
    np.testing.assert_array_equal(start_pose(GRID, TRUE_POSE, 1, 7), start_pose(GRID, TRUE_POSE, 1, 7))
    assert np.all(start_pose(GRID, TRUE_POSE, 1, 7) != start_pose(GRID, TRUE_POSE, 2, 7))


@pytest.mark.parametrize(
    ("settings", "key"),
    [
        ({"n_distances": 0}, "n_distances"),
        ({"n_angles": -3}, "n_angles"),
        ({"maximum_distance_m": 0.0}, "maximum_distance"),
        ({"maximum_angle_deg": float("nan")}, "maximum_angle"),
    ],
)
def test_grid_of_no_size_is_refused(settings, key):
    with pytest.raises(InputError, match=rf"BasinSettings: {key}"):
        BasinSettings(**settings)


@pytest.mark.parametrize("model", ["gaussian", "gaussian_11"])
def test_sweep_finds_the_only_optimum_of_a_quadratic(model, request):
    likelihood = request.getfixturevalue(model)
    reference = likelihood.means.mean(axis=0)[:6]
    covariance = np.linalg.inv(likelihood.information)[:6, :6] / 12
    row = Sweep(LikelihoodEstimator(likelihood), reference, covariance, GRID, 1).attempt("powell", 17)
    assert row["success"]
    assert row["mahalanobis"] < 0.01
    start = [row["start_r_x_m"], row["start_theta_z_rad"]]
    np.testing.assert_array_equal(start, start_pose(GRID, reference, 1, 17)[[0, 5]])


@pytest.mark.parametrize(("share", "success"), [(0.05, True), (0.2, False)])
def test_success_ends_at_the_threshold(gaussian, monkeypatch, share, success):
    """An optimiser that stops 0.05 and 0.2 sigmas from the reference."""
    end = TRUE_POSE + share * SIGMA * np.eye(6)[1]
    monkeypatch.setitem(OPTIMISERS, "stops", lambda *_: Optimum(end, 0.0, 1, True))
    row = Sweep(LikelihoodEstimator(gaussian), TRUE_POSE, np.diag(SIGMA**2), GRID, 1).attempt("stops", 0)
    assert row["success"] is success
    assert row["mahalanobis"] == pytest.approx(share, rel=1e-9)


def test_searches_are_the_usual_ones_or_those_that_are_named(gaussian):
    estimator = LikelihoodEstimator(gaussian)
    assert chosen_searches(estimator, [], "robot.yaml") == ("powell", "wide")
    assert chosen_searches(estimator, ["powell_in_front"], "robot.yaml") == ("powell_in_front",)
    with pytest.raises(InputError) as error:
        chosen_searches(estimator, ["gauss_newton"], "robot.yaml")
    assert str(error.value) == (
        "robot.yaml: experiments.basin.optimisers: found gauss_newton, expected of powell, wide, powell_in_front; "
        "correct the name, or leave the key out"
    )


def test_a_search_that_comes_to_no_pose_is_no_success(gaussian, monkeypatch):
    monkeypatch.setitem(OPTIMISERS, "lost", lambda *_: Optimum(np.full(6, np.nan), np.nan, 1, False))
    row = Sweep(LikelihoodEstimator(gaussian), TRUE_POSE, np.diag(SIGMA**2), GRID, 1).attempt("lost", 0)
    assert not row["success"]
    assert row["mahalanobis"] == np.inf


def test_rows_do_not_depend_on_what_is_swept_with_them(gaussian):
    sweep = Sweep(LikelihoodEstimator(gaussian), TRUE_POSE, np.diag(SIGMA**2), GRID, 1)
    together = sweep.rows("powell", range(3, 7))
    assert sweep.rows("powell", [5]).equals(together.iloc[[2]].reset_index(drop=True))


def test_summary_counts_the_triangle():
    """Shares of the region's two sides: a start is inside where they add up to less than 1."""
    shares = [(0.1, 0.1, True), (0.3, 0.3, True), (0.9, 0.05, False), (0.6, 0.6, True), (0.05, 3.0, False)]
    sweep = pd.DataFrame(
        {
            "distance_m": [0.5 * d for d, _, _ in shares],
            "angle_rad": [np.radians(20) * a for _, a, _ in shares],
            "success": [s for _, _, s in shares],
            "n_evaluations": [10, 20, 30, 40, 50],
        }
    )
    table = summarise(sweep, BasinSettings().region()).set_index("region")
    assert table["n_starts"].to_dict() == {"inside": 3, "outside": 2, "all": 5}
    assert table["n_successes"].to_dict() == {"inside": 2, "outside": 1, "all": 3}
    assert table.loc["all", "success_rate"] == pytest.approx(0.6)


def test_summary_of_an_empty_region_has_no_rate():
    sweep = pd.DataFrame({"distance_m": [1.9], "angle_rad": [1.0], "success": [True], "n_evaluations": [10]})
    table = summarise(sweep, BasinSettings().region()).set_index("region")
    assert np.isnan(table.loc["inside", ["success_rate", "success_rate_low"]].to_numpy(float)).all()


def test_wilson_interval_is_the_closed_form():
    z, n, k = 1.959963984540054, 40, 27
    centre = (k + z**2 / 2) / (n + z**2)
    half = z / (n + z**2) * np.sqrt(k * (n - k) / n + z**2 / 4)
    assert wilson_interval(k, n) == pytest.approx((centre - half, centre + half), rel=1e-9)


def test_angles_become_radians():
    settings = BasinSettings(maximum_angle_deg=90, n_angles=1, region_angle_deg=30)
    assert settings.offset(0)[1] == pytest.approx(np.pi / 4)
    assert settings.region().angle_rad == pytest.approx(np.pi / 6)
