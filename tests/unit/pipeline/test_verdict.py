from dataclasses import replace

import numpy as np
import pytest

from linepose.estimation.noise_models import ADJUSTMENT, PUBLISHED
from linepose.pipeline.adjusted_schemas import MEASUREMENTS
from linepose.pipeline.calibration import Calibration
from linepose.pipeline.checks import AdjustedEvidence, DoubtfulView, LostMeasurement
from linepose.pipeline.verdict import Evidence, Level, judge
from linepose.tables import write_table
from unit import made_up, made_up_adjustment

FINE = Evidence(
    n_observations=25,
    n_accepted=16,
    converged=True,
    n_steps=5000,
    autocorrelation_time=50.0,
    split_r_hat=1.002,
    reduced_chi_square=1.0,
    intraclass_correlation=0.05,
    tilt_spread_deg=2.7,
    worst_observation=24,
    worst_error_px=3.0,
    threshold_px=5.0,
    hand_sigmas=1.2,
    hand_parameter="r_y right",
    undecided=(),
    noise_model=PUBLISHED.name,
    sigma_factor=1.05,
    most_influential=5,
    influence=0.6,
    truth_sigmas=1.4,
    truth_parameter="r_z down",
)


def named(verdict, name):
    return next(check for check in verdict.checks if check.name == name)


def test_everything_in_order_says_use_it_and_asks_for_nothing():
    verdict = judge(FINE)
    assert verdict.level == Level.GOOD
    assert verdict.sentence == "Use this pose: every check passed."
    assert not any(check.advice for check in verdict.checks)
    assert len(verdict.checks) == 10


@pytest.mark.parametrize(
    ("change", "name", "level", "advice"),
    [
        ({"converged": False}, "Convergence", Level.BAD, "start pose"),
        ({"n_steps": 2499}, "Chain length", Level.CARE, "sampling.n_steps to 2500"),
        ({"n_steps": 100, "autocorrelation_time": 9.5, "split_r_hat": 1.6}, "Chain length", Level.CARE, "1000 or more"),
        ({"split_r_hat": 1.011}, "Chain length", Level.CARE, "sampling.n_steps"),
        ({"reduced_chi_square": 1.6}, "Size of the residuals", Level.CARE, "covariances"),
        ({"reduced_chi_square": 2.5}, "Size of the residuals", Level.BAD, "covariances"),
        ({"reduced_chi_square": 0.44}, "Size of the residuals", Level.CARE, "columns"),
        (
            {"intraclass_correlation": 0.31, "sigma_factor": None},
            "Independence within a view",
            Level.CARE,
            "noise_model: adjustment",
        ),
        ({"tilt_spread_deg": 1.4}, "Angular diversity", Level.CARE, "rolled or pitched"),
        ({"undecided": ("r_z down",)}, "Angular diversity", Level.CARE, "rolled or pitched"),
        ({"worst_error_px": 4.7}, "Worst observation", Level.CARE, "observation 24"),
        ({"influence": 1.1}, "Worst observation", Level.CARE, "Repeat the view of observation 5"),
        ({"hand_sigmas": 3.1}, "Hand measurement", Level.CARE, "Measure again"),
        ({"sigma_factor": 1.7}, "Repeatability", Level.CARE, "Multiply the sigmas by 1.7"),
        ({"truth_sigmas": 3.2}, "Truth", Level.CARE, "repeatability"),
        ({"exact_axes": ("yaw",)}, "Reported sigmas", Level.CARE, "data sheet"),
        ({"exact_axes": ("roll", "pitch", "yaw")}, "Reported sigmas", Level.BAD, "data sheet"),
        ({"hand_sigmas": 6.1, "hand_counts": True}, "Hand measurement", Level.BAD, "correct hand_measured"),
        ({"hand_sigmas": 5.9, "hand_counts": True}, "Hand measurement", Level.CARE, "Measure again"),
        ({"hand_sigmas": 40.0}, "Hand measurement", Level.CARE, "Measure again"),
    ],
)
def test_each_fault_is_named_with_what_to_do(change, name, level, advice):
    verdict = judge(replace(FINE, **change))
    check = named(verdict, name)
    assert (check.level, verdict.level) == (level, level)
    assert advice in check.advice
    assert verdict.reasons == (check,)
    assert check.brief
    assert f"1 of {len(verdict.checks)} checks" in verdict.sentence
    assert all(other.level == Level.GOOD for other in verdict.checks if other is not check)


def test_the_papers_chain_is_called_too_short_but_not_its_pose():
    check = named(judge(replace(FINE, n_steps=100, autocorrelation_time=9.6, split_r_hat=1.6)), "Chain length")
    assert "Chain too short" in check.found
    assert "The pose is not affected" in check.found


def test_the_worst_level_decides_the_sentence():
    verdict = judge(replace(FINE, converged=False, sigma_factor=2.0))
    assert verdict.level == Level.BAD
    assert verdict.sentence == "Do not use this pose yet: 1 of 10 checks failed."
    assert [check.name for check in verdict.reasons] == ["Convergence", "Repeatability"]


def test_what_is_not_known_is_not_judged():
    verdict = judge(replace(FINE, sigma_factor=None, truth_sigmas=None, influence=None, most_influential=None))
    assert {check.name for check in verdict.checks}.isdisjoint({"Repeatability", "Truth"})
    assert "influence" not in named(verdict, "Worst observation").found


def test_a_parameter_that_only_the_tape_knows_is_named():
    assert "r_z down" in named(judge(replace(FINE, undecided=("r_z down",))), "Angular diversity").found


def test_errors_in_common_do_no_harm_where_halves_agree():
    check = named(judge(replace(FINE, intraclass_correlation=0.9, sigma_factor=1.0)), "Independence within a view")
    assert check.level == Level.GOOD
    assert "90 %" in check.found


ADJUSTED = replace(FINE, noise_model=ADJUSTMENT.name, adjusted=AdjustedEvidence(0.9, 80.0, 0.4, ()))


def test_little_tilt_is_in_the_sigmas_of_an_adjustment_as_long_as_the_data_say_something_of_all():
    level = replace(ADJUSTED, tilt_spread_deg=0.4)
    assert named(judge(level), "Angular diversity").level == Level.GOOD
    open_height = named(judge(replace(level, undecided=("r_z down",))), "Angular diversity")
    assert open_height.level == Level.CARE
    assert "second height" in open_height.advice


def test_the_data_are_said_to_decide_all_only_where_they_do():
    found = named(judge(replace(ADJUSTED, decided_by_both=("r_z",))), "Angular diversity").found
    assert "decide r_z together" in found
    assert "about every number" not in found
    assert "about every number" in named(judge(ADJUSTED), "Angular diversity").found


def test_an_adjustment_in_order_is_judged_by_checks_of_its_own():
    verdict = judge(ADJUSTED)
    assert verdict.level == Level.GOOD
    names = {check.name for check in verdict.checks}
    assert {"Weights", "Curvature", "Draws of the levels", "Repeatability", "Hand measurement"} <= names
    assert not {"Worst observation", "Chain length", "Independence within a view"} & names


@pytest.mark.parametrize(
    ("change", "name", "level", "advice"),
    [
        ({"least_eigenvalue": 0.29}, "Curvature", Level.BAD, "Add observations"),
        ({"camera_sigmas": 3.1, "camera_parameter": "focal_length_m"}, "Camera", Level.CARE, "field of view, binning"),
        ({"camera_sigmas": float("nan")}, "Camera", Level.CARE, "other checks"),
        ({"camera_held": ("focal_length_m",)}, "Camera", Level.CARE, "camera.sigmas how well it is known"),
        ({"effective_draws": 19.0}, "Draws of the levels", Level.CARE, "adjustment.n_draws"),
        ({"drift_known": False}, "Times", Level.CARE, "Give the times"),
        ({"least_eigenvalue": float("nan")}, "Curvature", Level.BAD, "other checks"),
        ({"target_misfit": 4.1}, "Known target", Level.CARE, "target.sigma_m"),
        ({"navigation_error": 3.1}, "Size of the errors", Level.CARE, "units"),
        ({"navigation_error": 10.1}, "Size of the errors", Level.BAD, "linepose check"),
        ({"pareto_shape": 0.71}, "Draws of the levels", Level.CARE, "Add views"),
        (
            {"doubtful": tuple(DoubtfulView(n, 0.1, "jump") for n in range(1, 10))},
            "Weights",
            Level.CARE,
            "more than a third",
        ),
        (
            {"lost": tuple(LostMeasurement(1, f"t{n}", 0.1) for n in range(64)), "n_measurements": 1500},
            "Weights",
            Level.CARE,
            "Look at these measurements",
        ),
    ],
)
def test_each_fault_of_an_adjustment_is_named_with_what_to_do(change, name, level, advice):
    verdict = judge(replace(ADJUSTED, adjusted=replace(ADJUSTED.adjusted, **change)))
    check = named(verdict, name)
    assert (check.level, verdict.level) == (level, level)
    assert advice in check.advice
    assert verdict.reasons == (check,)


def test_a_camera_is_told_to_fit_as_far_as_the_survey_tests_it():
    fits = {"camera_sigmas": 2.9, "camera_parameter": "focal_length_m"}
    check = named(judge(replace(ADJUSTED, adjusted=replace(ADJUSTED.adjusted, **fits))), "Camera")
    assert check.level == Level.GOOD
    assert check.found.startswith("Of the camera the focal length lies 2.9 sigmas from the platform's file")
    assert "the survey hardly tests it" in named(judge(ADJUSTED), "Camera").found


def test_a_contradicted_camera_is_told_before_one_that_cannot_be_tested():
    held = {"camera_held": ("principal_point_px",), "camera_parameter": "focal_length_m"}
    for sigmas, said in (
        (2.9, "sigmas of the principal point in the platform's file are so small"),
        (3.1, "contradicts"),
    ):
        change = replace(ADJUSTED.adjusted, camera_sigmas=sigmas, **held)
        assert said in named(judge(replace(ADJUSTED, adjusted=change)), "Camera").found


def test_a_known_target_that_fits_is_told():
    check = named(judge(replace(ADJUSTED, adjusted=replace(ADJUSTED.adjusted, target_misfit=-0.4))), "Known target")
    assert check.level == Level.GOOD
    assert "0.0 sigmas off" in check.found


def test_a_few_views_that_are_far_off_are_told_and_no_reason_to_doubt():
    doubtful = (DoubtfulView(7, 0.02, "clock"), DoubtfulView(9, 0.1, "label"))
    check = named(judge(replace(ADJUSTED, adjusted=replace(ADJUSTED.adjusted, doubtful=doubtful))), "Weights")
    assert check.level == Level.GOOD
    assert "observation 7 (its clock), 9 (labels)" in check.found


def test_a_few_bad_matches_of_thousands_are_named_and_no_reason_to_doubt():
    lost = tuple(LostMeasurement(n % 10, f"t{n}", 0.01 * n) for n in range(1, 10))
    check = named(
        judge(replace(ADJUSTED, adjusted=replace(ADJUSTED.adjusted, lost=lost, n_measurements=1500))), "Weights"
    )
    assert check.level == Level.GOOD
    assert "Of 1500 measurements 9 have lost their weight, where heavy tails explain up to 63" in check.found
    assert "point t1 of observation 1 (0.01), point t2" in check.found
    assert "t6" not in check.found


def test_a_measurement_that_has_lost_its_weight_is_told_by_its_points_name(tmp_path):
    made_up.write_adjusted_results(tmp_path)
    measurements = made_up_adjustment.adjusted_measurements()
    first = (measurements["observation"] == 1) & (measurements["point"] == 3)
    lighter = measurements.assign(weight=np.where(first, 0.05, measurements["weight"]))
    write_table(lighter, tmp_path / "adjusted_measurements.parquet", MEASUREMENTS)
    verdict = Calibration.from_results(tmp_path, made_up.adjusted_platform()).verdict()
    assert "point 3 of observation 1 (0.05)" in named(verdict, "Weights").found


def test_the_camera_of_the_results_is_held_against_the_platforms_file(tmp_path):
    made_up.write_adjusted_results(tmp_path)
    check = named(Calibration.from_results(tmp_path, made_up.adjusted_platform()).verdict(), "Camera")
    # 4 px off with a prior of 2 px, of which the survey leaves 0.3 px
    expected = 4.0 / np.sqrt(2.0**2 - 0.3**2)
    assert f"Of the camera the principal point lies {expected:.1f} sigmas" in check.found
