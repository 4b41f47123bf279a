"""Which noise model to use: the paragraph says what the numbers say."""

from dataclasses import replace

import pytest

from linepose.output.report.noise_models import noise_models_section, paragraph
from unit import made_up


def told(summary=None, estimates=None):
    return paragraph(
        made_up.noise_models() if estimates is None else estimates,
        made_up.consistency_summary() if summary is None else summary,
        made_up.identifiability(),
    )


def with_factors(published, shared):
    summary = made_up.consistency_summary()
    summary["sigma_factor"] = summary["noise_model"].map({"published": published, "shared": shared})
    return summary


def test_levels_factors_and_moves_are_in_the_sentence():
    text = told(with_factors(1.7, 1.2))
    assert "0.50 of the reported sigmas is shared" in text
    assert "2.3 times the stated pixel noise" in text
    assert "1.70 times as far apart" in text
    assert "moves the pose of the accepted observations by 140 mm, most in sigmas in r_y (2.8)" in text
    assert "lies 2.1 sigmas" in text


@pytest.mark.parametrize(
    ("published", "shared", "advice"),
    [
        (1.7, 1.2, "The shared model's sigmas hold as they stand."),
        (2.0, 1.4, "though too small by the factor above"),
        (0.3, 0.7, "though too large by the factor above"),
        (1.1, 1.6, "are too small by the factor above, further off than the published ones"),
    ],
)
def test_advice_follows_the_factors(published, shared, advice):
    assert advice in told(with_factors(published, shared))


@pytest.mark.parametrize(("distance", "advice"), [(1.2, "they say the same."), (3.5, "rewards distance")])
def test_advice_on_the_balanced_model_follows_its_distance(distance, advice):
    estimates = made_up.noise_models()
    estimates.loc[estimates["noise_model"] == "balanced", "mahalanobis"] = distance
    text = told(estimates=estimates)
    assert "Use the balanced model" in text
    assert "Use the shared model" not in text
    assert advice in text[text.index(f"lies {distance:.1f} sigmas from the shared one: ") :]


def test_errors_against_the_truth_are_told_where_there_is_one(results):
    estimates = made_up.noise_models().assign(position_error_m=0.025, rotation_error_rad=0.01, error_in_sigmas=1.5)
    assert "25 mm, 1.5 sigmas by the robust model with every fault left in" in told(estimates=estimates)
    assert "truth" not in told()
    section = noise_models_section(results)
    assert [table.title for table in section.tables][:2] == ["Pose under each noise model", "Inferred levels"]
    assert not section.tables[0].folded


def test_a_platform_without_the_experiment_has_no_section(results):
    without = replace(results, platform=made_up.platform(experiments={}))
    assert noise_models_section(without) is None
