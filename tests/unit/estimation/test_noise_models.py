"""What holds for every noise model: names, defined answers to bad input, and that chi-square is near its freedom."""

import re
from pathlib import Path

import numpy as np
import pytest
from linepose.likelihood.shared import SharedLikelihood
from pydantic import TypeAdapter

from linepose.config.study import Study
from linepose.errors import InputError, LineposeError
from linepose.estimation.noise_models import DEFAULT, NOISE_MODELS, NoiseModelName, likelihood_of, noise_model
from unit.likelihood.small_survey import CAMERA, POSE, Truth, make_survey, without

ROOT = Path(__file__).parents[3]
MODELS = pytest.mark.parametrize("noise_model", NOISE_MODELS)


def test_every_entry_carries_its_own_name_look_and_section():
    assert all(key == one.name for key, one in NOISE_MODELS.items())
    for look in ("meaning", "colour", "marker"):
        assert len({getattr(one, look) for one in NOISE_MODELS.values()}) == len(NOISE_MODELS)
    assert {one.section for one in NOISE_MODELS.values()} <= set(Study.model_fields)
    assert NOISE_MODELS[DEFAULT.name] is DEFAULT


def test_names_are_checked():
    names = TypeAdapter(NoiseModelName)
    assert [names.validate_python(name) for name in NOISE_MODELS] == list(NOISE_MODELS)
    with pytest.raises(ValueError, match="one of published, "):
        names.validate_python("balancd")
    with pytest.raises(InputError) as error:
        noise_model("balancd")
    assert str(error.value).endswith("; did you mean balanced?")


def test_a_model_is_named_in_one_place_only():
    names = [name for name in NOISE_MODELS if name != "published"]  # also a column of the regression
    found = {
        path.name
        for path in [*ROOT.glob("src/**/*.py"), *ROOT.glob("scripts/*.py"), *ROOT.glob("workflow/**/*.smk")]
        if "paper" not in path.parts and re.search('"(' + "|".join(names) + ')"', path.read_text())
    }
    assert found == {"noise_models.py"}


@MODELS
@pytest.mark.parametrize("rank", [0, 1, 5])
def test_zero_and_singular_covariances_have_a_likelihood_and_residuals(noise_model, rank):
    survey = make_survey(5, 4, Truth(0.5), seed=3)
    values, vectors = np.linalg.eigh(survey.covariance)
    values[..., rank:] = 0.0
    survey.covariance[:] = (vectors * values[..., None, :]) @ np.swapaxes(vectors, -1, -2)
    likelihood = likelihood_of(noise_model, survey, CAMERA, POSE)
    parameters = likelihood.start(POSE)
    assert np.isfinite(likelihood.log_likelihood(parameters))
    assert np.all(np.isfinite(likelihood.residuals(parameters).sigma_px))


@MODELS
def test_a_view_of_one_point_counts_as_one_line(noise_model):
    survey = make_survey(5, 4, Truth(0.5), seed=3)
    single = without(survey, (2, 0), (2, 1), (2, 2))
    likelihood = likelihood_of(noise_model, single, CAMERA, POSE)
    parameters = likelihood.start(POSE)
    value = likelihood.log_likelihood(parameters)
    absent = likelihood_of(noise_model, without(single, (2, 3)), CAMERA, POSE).log_likelihood(parameters)
    assert np.isfinite(value)
    assert value != absent
    assert np.isfinite(likelihood.residuals(parameters).error_px).sum() == 17


@MODELS
def test_a_point_behind_the_camera_is_impossible_and_not_undefined(noise_model):
    likelihood = likelihood_of(noise_model, make_survey(4, 3, Truth(), seed=6), CAMERA, POSE)
    # turned about its x axis by half a turn, the camera looks away from the pattern
    behind = likelihood.start([*POSE[:3], 2.2, 2.1, -1.0])
    one, many = likelihood.log_likelihood(behind), likelihood.log_likelihoods(np.stack([behind, behind]))
    assert one == -np.inf
    assert np.array_equal(many, [-np.inf, -np.inf])


@MODELS
def test_an_observed_point_without_a_pose_is_refused(noise_model):
    survey = make_survey(3, 2, Truth(), seed=6)
    survey.position_m[1, 0] = np.nan
    with pytest.raises(LineposeError):
        likelihood_of(noise_model, survey, CAMERA, POSE)


@pytest.mark.statistical
def test_chi_square_is_near_its_degrees_of_freedom_at_the_truth():
    total, freedom = 0.0, 0
    for seed in range(20):
        likelihood = SharedLikelihood(make_survey(6, 6, Truth(0.5, 0.1, 1.0), seed=seed), CAMERA)
        parameters = likelihood.start(POSE)
        parameters[6:9] = np.log([0.5, 0.1, 1.0])
        chi_square, degrees = likelihood.chi_square(parameters)
        assert degrees == 2 * 36 - 3 * 6 - 6
        total += chi_square
        freedom += degrees + 6  # the true pose is not fitted
    assert abs(total - freedom) < 4 * np.sqrt(2 * freedom)
