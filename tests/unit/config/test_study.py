import numpy as np
import pytest

from linepose.config.study import check_study, load_dataset
from linepose.errors import InputError
from linepose.estimation.optimise import Search
from linepose.estimation.sampling import SamplingSettings


def message_of(values):
    with pytest.raises(InputError) as error:
        check_study(values)
    assert "\n" not in str(error.value)
    return str(error.value)


def test_defaults_are_the_papers():
    study = check_study({"platforms": ["robot"]})
    assert study.search == Search()
    assert study.sampling == SamplingSettings()
    assert (study.search.half_width_m, study.search.half_width_rad) == (2.0, np.pi)
    assert study.sampling == SamplingSettings(
        n_walkers=250, n_burn_in=100, n_steps=100, stretch_scale=2.5, start_sigma_m=0.1, start_sigma_rad=0.01
    )
    assert (study.outliers.threshold_px, study.outliers.minimum_observations) == (5.0, 10)
    assert study.data_folders == ["data", "../shared"]


def test_values_reach_the_library_in_its_units():
    study = check_study(
        {
            "platforms": ["robot"],
            "search": {"half_width_m": 1, "half_width_deg": 90, "x_tolerance": 1e-3, "f_tolerance": 1e-4},
            "sampling": {
                "n_walkers": 20,
                "n_burn_in": 0,
                "n_steps": 7,
                "stretch_scale": 2,
                "start_sigma_m": 0.3,
                "start_sigma_rad": 0.4,
            },
        }
    )
    assert study.search == Search(half_width_m=1.0, half_width_deg=90.0, x_tolerance=1e-3, f_tolerance=1e-4)
    assert study.sampling == SamplingSettings(
        n_walkers=20, n_burn_in=0, n_steps=7, stretch_scale=2.0, start_sigma_m=0.3, start_sigma_rad=0.4
    )


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("data_folders", ["d{a}"]),
        ("data_folders", [" "]),
        ("datasets", {"a": "config/{a}"}),
        ("datasets", {"a/b": "c"}),
    ],
)
def test_paths_that_a_run_cannot_use_are_refused(key, value):
    assert key in message_of({"platforms": ["robot"], key: value})


def test_committed_dataset_is_pinned_and_whole(ladybird_dataset):
    assert "14de42e7ad2bc0c4b82ed90cbba4b4f9004ac08e" in ladybird_dataset.base_url
    assert sum(file.startswith("labelled_points/") for file in ladybird_dataset.sha256) == 50
    assert {"COPYING", "nav_covs.csv"} < set(ladybird_dataset.sha256)
    assert all(len(digest) == 64 for digest in ladybird_dataset.sha256.values())


@pytest.mark.field
def test_configured_sums_are_those_beside_the_data(field_data, ladybird_dataset):
    lines = (field_data / "SHA256SUMS").read_text().split("\n")
    beside = dict(reversed(line.split(maxsplit=1)) for line in lines if line)
    assert beside == ladybird_dataset.sha256


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({}, "platforms: found nothing, expected a value; add it"),
        (
            {"platforms": []},
            "platforms: found [], expected list should have at least 1 item after validation, not 0; correct the value",
        ),
        (
            {"platforms": ["a"], "data_folders": []},
            "data_folders: found [], expected list should have at least 1 item after validation, not 0; "
            "correct the value",
        ),
        ({"platforms": ["a"], "seed": -1}, "seed: found -1, expected greater than or equal to 0; correct the value"),
        (
            {"platforms": ["a"], "sampling": {"n_walkrs": 250}},
            "sampling.n_walkrs: found an unknown key, expected one of n_walkers, n_burn_in, n_steps, stretch_scale, "
            "start_sigma_m, start_sigma_rad; did you mean n_walkers?",
        ),
        (
            {"platforms": ["a"], "sampling": {"stretch_scale": 1.0}},
            "sampling.stretch_scale: found 1.0, expected greater than 1; correct the value",
        ),
        (
            {"platforms": ["a"], "outliers": {"minimum_observations": 2}},
            "outliers.minimum_observations: found 2, expected greater than or equal to 3; correct the value",
        ),
        (
            {"platforms": ["a"], "search": {"half_width_m": "wide"}},
            "search.half_width_m: found 'wide', expected a valid number, unable to parse string as a number; "
            "correct the value",
        ),
    ],
)
def test_wrong_value_is_named(values, message):
    assert message_of(values) == f"config/config.yaml: {message}"


def test_misspelt_section_is_named():
    message = message_of({"platforms": ["a"], "sampler": {}})
    assert message.startswith("config/config.yaml: sampler: found an unknown key, expected one of platforms, ")
    assert message.endswith("; did you mean sampling?")


def test_dataset_file_without_sums(tmp_path):
    (tmp_path / "robot.yaml").write_text("base_url: http://127.0.0.1/\n")
    with pytest.raises(InputError) as error:
        load_dataset(tmp_path / "robot.yaml")
    assert str(error.value) == f"{tmp_path}/robot.yaml: sha256: found nothing, expected a value; add it"
