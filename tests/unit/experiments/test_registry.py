"""What a platform's file may say of its experiments, how it is told what it may not, and what each entry holds."""

import pytest

from linepose.config.platform import load_platform
from linepose.errors import InputError
from linepose.experiments.inputs import Inputs
from linepose.experiments.registry import (
    EXPERIMENTS,
    SECTIONS,
    check_experiments,
    compared_platforms,
    experiment,
    experiment_faults,
    experiment_settings,
    wanted_experiments,
)

FILE = "robot.yaml"


@pytest.fixture
def scans(platforms_folder):
    """A platform with scans and a raw log, as its file is without experiments."""
    return load_platform(platforms_folder, "ladybird-sim").replaced(experiments={})


@pytest.fixture
def views(platforms_folder):
    """A platform with labelled views."""
    return load_platform(platforms_folder, "ladybird").replaced(experiments={})


def message(platform, values: dict) -> str:
    with pytest.raises(InputError) as caught:
        check_experiments(platform.replaced(experiments=values), FILE)
    assert "\n" not in str(caught.value)
    return str(caught.value)


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ({"basin": {"n_distances": 0}}, "robot.yaml: experiments.basin.n_distances: found 0"),
        ({"basin": {"maximum_angle_deg": 0}}, "basin.maximum_angle_deg: found 0"),
        ({"basin": {"optimisers": ["powel"]}}, "basin.optimisers.0: found 'powel'"),
        ({"basin": {"n_angle": 5}}, "did you mean n_angles?"),
        ({"basins": None}, "did you mean basin?"),
        ({"basin": 5}, "robot.yaml: experiments.basin: found 5, expected keys and values"),
        ({"subsets": {"a": {}}}, "found neither observations nor rules"),
        (
            {"subsets": {"a": {"observations": [1], "rules": [{"angle": "roll", "count": 1}]}}},
            "found observations and rules, expected one of them",
        ),
        ({"subsets": {"a": {"rules": [{"angle": "heading", "count": 2}]}}}, "found 'heading'"),
        ({"subsets": {"a": {"rules": [{"angle": "yaw", "count": 0}]}}}, "count: found 0"),
        ({"repeatability": {"first": {"observations": [1, 2]}}}, "found first without second"),
    ],
)
def test_what_cannot_be_is_one_clear_line(scans, values, told):
    assert told in message(scans, values)


def test_a_clock_offset_of_an_adjustment_needs_no_log(views):
    check_experiments(views.replaced(noise_model="adjustment", experiments={"clock_offset": {}}), FILE)


def test_all_faults_are_told_at_once(views):
    faults = experiment_faults(
        views.replaced(experiments={"basin": {"n_angle": 5}, "mapping": {"perturbation_deg": 0}}), FILE
    )
    assert [str(fault).split(":")[1].strip() for fault in faults] == [
        "experiments.basin.n_angle",
        "experiments.mapping.perturbation_deg",
    ]


def test_clock_offset_needs_a_log(scans, views):
    asked = {"clock_offset": {}}
    check_experiments(scans.replaced(experiments=asked), FILE)
    assert "robot.yaml: experiments.clock_offset: found an experiment that needs a raw navigation log" in message(
        views, asked
    )
    assert len(experiment_faults(views.replaced(experiments=asked), FILE)) == 1


def test_every_experiment_but_three_runs_by_default_and_null_leaves_one_out(views):
    default = experiment_settings(views)
    assert not default.subsets
    assert default.adjustment_beside is None
    assert default.clock_offset is None
    assert default.basin
    assert default.repeatability.first is None
    names = {one.name for one in wanted_experiments(views)}
    assert names == {"uncertainty", "prior", "splits", "leave_one_out", "basin", "mapping", "sensitivity"}
    without = views.replaced(experiments=dict.fromkeys(SECTIONS))
    assert {one.name for one in wanted_experiments(without)} == {"uncertainty", "prior"}
    adjusted = {one.name for one in wanted_experiments(views.replaced(noise_model="adjustment"))}
    assert adjusted == names - {"uncertainty"}


def test_error_against_the_truth_is_of_simulated_platforms(scans, views):
    truth_error = experiment("truth_error")
    assert truth_error.is_wanted(scans)
    assert not truth_error.is_wanted(views)


def test_compared_platforms_are_those_that_sections_name(views):
    asked = {"sensitivity": {"platforms": ["a", "b"]}, "adjustment_beside": {"platforms": ["b", "c"]}}
    assert compared_platforms(views.replaced(experiments=asked), FILE) == ["a", "b", "c"]
    assert compared_platforms(views, FILE) == []


def test_entries_share_no_result_and_name_what_they_need():
    results = [name for one in EXPERIMENTS for name in one.outputs]
    assert len(results) == len(set(results))
    of_the_pipeline = {"observations", "outliers", "optima", "samples", "pose", "truth", "estimated_points"}
    for one in EXPERIMENTS:
        assert set(one.needs) <= of_the_pipeline | set(results), one.name
        assert one.title
        assert one.module == f"linepose.experiments.{one.name}"
    with pytest.raises(InputError, match="expected one of uncertainty, prior"):
        experiment("basins")


def test_undeclared_inputs_are_refused(views, tmp_path):
    inputs = Inputs("robot", views, FILE, {}, {}, {"seed": 1}, {}, tmp_path, tmp_path)
    assert inputs.seed == 1
    with pytest.raises(KeyError):
        _ = inputs.conditions
    with pytest.raises(KeyError):
        _ = inputs.data
    with pytest.raises(KeyError):
        inputs.settings(SECTIONS["basin"])
