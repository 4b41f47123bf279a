"""What holds for every noise model: names, and defined answers to bad input."""

import re
from pathlib import Path

import numpy as np
import pytest
from pydantic import TypeAdapter

from linepose.adjustment.settings import AdjustmentSection
from linepose.errors import InputError, LineposeError
from linepose.estimation.adjustment_estimator import GAUSS_NEWTON, AdjustmentEstimator
from linepose.estimation.estimator import Conditions
from linepose.estimation.likelihood_estimator import LikelihoodEstimator
from linepose.estimation.noise_models import (
    DEFAULT,
    NOISE_MODELS,
    NoiseModelName,
    estimator_of,
    likelihood_of,
    noise_model,
)
from linepose.geometry.distance import mahalanobis_distance
from linepose.likelihood.prior import WithPrior
from linepose.survey.hand_measured import HandMeasured
from unit.likelihood.small_survey import CAMERA, POSE, Truth, make_survey, without

ROOT = Path(__file__).parents[3]
MODELS = pytest.mark.parametrize("name", NOISE_MODELS)
QUICK = AdjustmentSection(n_draws=10, n_samples=10)


def by_hand(**changed):
    position = tuple(POSE[:3].tolist())
    hand = HandMeasured(position_m=position, euler_deg=(0.0, 0.0, 0.0), **changed)
    euler = np.degrees(_euler(POSE))
    return hand.replaced(euler_deg=tuple(euler.tolist()))


def _euler(pose):
    from linepose.geometry.pose import euler_pose

    return euler_pose(pose)[3:]


def estimator(name, survey, **conditions):
    return estimator_of(name, survey, Conditions(CAMERA, by_hand(), adjustment=QUICK, **conditions))


def test_every_entry_carries_its_own_name_and_look():
    assert all(key == one.name for key, one in NOISE_MODELS.items())
    for look in ("meaning", "colour", "marker"):
        assert len({getattr(one, look) for one in NOISE_MODELS.values()}) == len(NOISE_MODELS)
    assert NOISE_MODELS[DEFAULT.name] is DEFAULT
    assert not DEFAULT.removes_outliers


def test_names_are_checked():
    names = TypeAdapter(NoiseModelName)
    assert [names.validate_python(name) for name in NOISE_MODELS] == list(NOISE_MODELS)
    with pytest.raises(ValueError, match="one of adjustment, published"):
        names.validate_python("adjustmnt")
    with pytest.raises(InputError) as error:
        noise_model("adjustmnt")
    assert str(error.value).endswith("; did you mean adjustment?")


def test_the_adjustment_has_no_likelihood():
    likely = ", ".join(one.name for one in NOISE_MODELS.values() if one.likelihood is not None)
    with pytest.raises(InputError) as error:
        likelihood_of("adjustment", make_survey(3, 2, Truth(), seed=6), CAMERA)
    assert str(error.value) == (
        f"noise_model: found adjustment, expected one with a likelihood: {likely}; choose one of these"
    )


def test_models_are_told_apart_by_their_entries_only():
    compared = re.compile(r"noise_model == |noise_model\) == ")
    found = [path.name for path in ROOT.glob("src/**/*.py") if compared.search(path.read_text())]
    assert found == []


@MODELS
def test_it_finds_the_pose_of_a_small_survey(name):
    survey = make_survey(8, 6, Truth(0.2, 0.05, 0.5), seed=3)
    kind = AdjustmentEstimator if name == "adjustment" else LikelihoodEstimator
    made = estimator(name, survey)
    assert isinstance(made, kind)
    found = made.estimate(POSE)
    assert found.number.tolist() == survey.number.tolist()
    assert mahalanobis_distance(POSE, found.pose, found.covariance) < 6.0
    assert found.sigma().shape == (6,)
    fewer = made.select(survey.number[:6].tolist()).estimate(POSE)
    assert len(fewer.number) == 6
    assert np.any(fewer.pose != found.pose)


@MODELS
def test_searches_are_those_that_it_names(name):
    made = estimator(name, make_survey(5, 4, Truth(0.2), seed=3))
    assert made.searches()[0] == (GAUSS_NEWTON if name == "adjustment" else "powell")
    found = made.search_by(made.searches()[0], POSE + 0.02)
    assert np.linalg.norm(found.pose[:3] - POSE[:3]) < 0.3
    with pytest.raises(InputError, match=r"basin.optimisers: found 'newton'"):
        made.search_by("newton", POSE)


def test_a_search_that_ends_nowhere_has_no_pose():
    behind = np.array([*POSE[:3], 2.2, 2.1, -1.0])  # turned by half a turn, the camera looks away from the points
    survey = make_survey(4, 3, Truth(), seed=6)
    found = estimator("adjustment", survey).search_by(GAUSS_NEWTON, behind)
    assert found.pose.shape == (6,)


@MODELS
def test_variations_differ_from_the_model_itself(name):
    made = estimator(name, make_survey(6, 5, Truth(0.5, 0.1, 1.0), seed=4))
    plain = made.estimate(POSE)
    for words, other in made.variations().items():
        assert words
        assert np.all(np.isfinite(other.estimate(POSE).pose))
    assert any(np.any(other.estimate(POSE).pose != plain.pose) for other in made.variations().values())


def test_the_hand_measurement_counts_where_it_is_a_prior():
    survey = make_survey(6, 5, Truth(0.5), seed=4)
    assert isinstance(estimator("published", survey, prior=True).likelihood, WithPrior)
    assert not isinstance(estimator("published", survey, prior=False).likelihood, WithPrior)
    for name in NOISE_MODELS:
        known, unknown = (estimator(name, survey, prior=prior).estimate(POSE).sigma() for prior in (True, False))
        assert np.all(known < unknown)


@MODELS
@pytest.mark.parametrize("rank", [0, 1, 5])
def test_zero_and_singular_covariances_have_an_estimate(name, rank):
    survey = make_survey(5, 4, Truth(0.5), seed=3)
    values, vectors = np.linalg.eigh(survey.covariance)
    values[..., rank:] = 0.0
    survey.covariance[:] = (vectors * values[..., None, :]) @ np.swapaxes(vectors, -1, -2)
    assert np.all(np.isfinite(estimator(name, survey).estimate(POSE).pose))


def test_a_view_of_one_point_counts():
    survey = make_survey(5, 4, Truth(0.5), seed=3)
    single = without(survey, (2, 0), (2, 1), (2, 2))
    for name in NOISE_MODELS:
        one, none = (estimator(name, kept).estimate(POSE).pose for kept in (single, without(single, (2, 3))))
        assert np.any(one != none)


def test_a_point_behind_the_camera_is_impossible_and_not_undefined():
    likelihood = likelihood_of("published", make_survey(4, 3, Truth(), seed=6), CAMERA)
    behind = likelihood.start([*POSE[:3], 2.2, 2.1, -1.0])
    one, many = likelihood.log_likelihood(behind), likelihood.log_likelihoods(np.stack([behind, behind]))
    assert one == -np.inf
    assert np.array_equal(many, [-np.inf, -np.inf])


@MODELS
def test_an_observed_point_without_a_pose_is_refused(name):
    survey = make_survey(3, 2, Truth(), seed=6)
    survey.position_m[1, 0] = np.nan
    with pytest.raises(LineposeError):
        estimator(name, survey).estimate(POSE)
