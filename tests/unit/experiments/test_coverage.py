"""The coverage study's surveys and rows, and a small cell of it as a regression of what the adjustment states."""

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import binom, chi2

from linepose.adjustment import AdjustmentSettings, adjust
from linepose.config.platform import load_platform
from linepose.errors import EstimationError, InputError
from linepose.experiments import coverage
from linepose.experiments.coverage import COVERAGE_SURVEYS, NOT_CONVERGED, Cell, drawn_hand_measurement
from linepose.experiments.coverage_estimates import Judged, judged
from linepose.geometry.distance import pose_difference
from linepose.geometry.pose import POSE_COLUMNS
from linepose.simulation.noise_levels import NoiseLevels
from linepose.tables import read_table, write_table

N_SURVEYS = 24
MIXED = NoiseLevels(shared_level=0.7071, white_level=0.7071)


@pytest.fixture(scope="module")
def platform(platforms_folder):
    return load_platform(platforms_folder, "ladybird-sim")


def cell(platform, noise_model="adjustment", regime="mixed", levels=MIXED, **options):
    camera, simulation = platform.intrinsics(), platform.simulation
    return Cell("p", regime, noise_model, camera, simulation, platform.start_pose(), levels, 7, **options)


def judge(**values):
    """An estimator that gives these values in place of an estimate."""
    given = {"pose": np.arange(6.0), "error": np.ones(6), "sigma": np.full(6, 2.0), "credibility": 0.4}
    return lambda *_: Judged(**(given | values))


def halved(found):
    """The same estimate with samples half as far from their mean: sigmas half as large."""
    samples = found.samples.copy()
    samples[list(POSE_COLUMNS)] = 0.5 * (samples[list(POSE_COLUMNS)] + samples[list(POSE_COLUMNS)].mean())
    return replace(found, samples=samples)


def is_true(results):
    """Whether coverage of 68 % and errors in sigmas are such as 99.8 % of right ones are."""
    n = len(results)
    held = sum(one.credibility < 0.68 for one in results)
    low, high = binom.interval(0.998, n, 0.68)
    # as if the six errors of a survey were one: the widest that any correlation between them makes it
    least, most = np.sqrt(chi2.ppf([0.001, 0.999], n) / n)
    ratio = np.sqrt(np.mean([(one.error / one.sigma) ** 2 for one in results]))
    return low <= held <= high and least <= ratio <= most


@pytest.mark.statistical
def test_stated_regions_hold_the_truth_and_sigmas_of_half_the_size_are_found_out(platform):
    small = cell(platform)
    settings = AdjustmentSettings(hand_measured_prior=False, line_period_s=1 / 133.0, n_draws=80)
    stated, half = [], []
    for index in range(N_SURVEYS):
        survey, truth, hand = small.survey(index)
        found = adjust(survey, small.camera, hand, settings=settings)
        assert found.diagnostics.converged
        stated.append(judged(found, truth))
        half.append(judged(halved(found), truth))
    assert is_true(stated)
    assert not is_true(half)


def test_rows_depend_on_the_survey_alone_and_fit_the_schema(platform, tmp_path):
    small = cell(platform)
    both, second = small.rows([0, 1]), small.rows([1])
    np.testing.assert_array_equal(both.iloc[1].drop("reason"), second.iloc[0].drop("reason"))
    write_table(both, tmp_path / "rows.parquet", COVERAGE_SURVEYS)
    assert read_table(tmp_path / "rows.parquet", COVERAGE_SURVEYS)["survey"].tolist() == [0, 1]


FORKED = """
import sys
from pathlib import Path
from linepose.config.platform import load_platform
from linepose.experiments.coverage import COVERAGE_SURVEYS, Cell
from linepose.pipeline.batches import run_batches
from linepose.simulation.noise_levels import NoiseLevels

platform = load_platform(Path(sys.argv[1]), "ladybird-sim")
camera, simulation = platform.intrinsics(), platform.simulation
cell = Cell("p", "white", "published", camera, simulation, platform.start_pose(), NoiseLevels(white_level=1.0), 7)
cell.compile()
table = run_batches(lambda name: cell.rows([int(name)]), ["0", "1"], Path(sys.argv[2]), COVERAGE_SURVEYS, 2)
print(*table["survey"])
"""


def test_processes_may_fork_from_one_that_has_compiled(platforms_folder, tmp_path):
    command = [sys.executable, "-c", FORKED, str(platforms_folder), str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=300)
    assert done.stdout.split() == ["0", "1"], done.stderr[-500:]


def test_estimates_that_fail_hold_nothing_and_say_why(platform, monkeypatch):
    def raises(*_):
        raise EstimationError("no start leads anywhere")

    small = cell(platform)
    monkeypatch.setattr(coverage, "judged_estimate", raises)
    row = small.row(0)
    assert (row["failed"], row["reason"], row["credibility"]) == (True, "no start leads anywhere", 1.0)
    assert np.isnan(row["error_r_x_m"])
    monkeypatch.setattr(coverage, "judged_estimate", judge(converged=False))
    row = small.row(0)
    assert (row["failed"], row["reason"], row["credibility"]) == (True, NOT_CONVERGED, 1.0)
    monkeypatch.setattr(coverage, "judged_estimate", judge(converged=True))
    row = small.row(0)
    assert (row["failed"], row["reason"], row["credibility"], row["sigma_r_x_m"]) == (False, "", 0.4, 2.0)


def test_same_number_is_the_same_survey_for_every_noise_model(platform):
    first, second = (cell(platform, model).survey(4)[0] for model in ("published", "adjustment"))
    np.testing.assert_array_equal(first.position_m, second.position_m)
    assert not np.array_equal(first.position_m, cell(platform).survey(5)[0].position_m)
    assert not np.array_equal(first.position_m, cell(platform, regime="other").survey(4)[0].position_m)


def test_hand_measurement_is_drawn_anew_where_it_counts(platform):
    np.testing.assert_array_equal(cell(platform).survey(4)[2], platform.start_pose())
    drawn = cell(platform, hand_measured_prior=True)
    assert not np.array_equal(drawn.survey(4)[2], drawn.survey(5)[2])
    np.testing.assert_array_equal(drawn.survey(4)[0].position_m, cell(platform).survey(4)[0].position_m)


def test_hand_measurement_counts_where_it_is_said_to(platform, monkeypatch):
    starts = []
    monkeypatch.setattr(coverage, "judged_estimate", lambda *given: starts.append(given[3]) or judge(converged=True)())
    for counts in (False, True):
        cell(platform, hand_measured_prior=counts).row(0)
    assert [start.is_prior for start in starts] == [False, True]
    assert starts[0].line_period_s == pytest.approx(1 / 133.0)


@pytest.mark.statistical
def test_hand_measurements_are_off_by_their_sigmas_on_every_body_axis():
    random, truth = np.random.default_rng(3), np.array([0.2, 0.0, -0.5, 1.4, 1.4, -1.1])
    n = 400
    off = np.array([pose_difference(drawn_hand_measurement(truth, random), truth) for _ in range(n)])
    low, high = np.sqrt(chi2.ppf([1e-4, 1 - 1e-4], n) / n)
    scaled = np.sqrt(np.mean(off**2, axis=0)) / np.array([0.1] * 3 + [np.deg2rad(2.0)] * 3)
    assert np.all((scaled > low) & (scaled < high))


def test_unknown_noise_model_is_told(platform):
    with pytest.raises(InputError, match="noise_model: found 'publishd', expected one of adjustment, published"):
        cell(platform, "publishd")
