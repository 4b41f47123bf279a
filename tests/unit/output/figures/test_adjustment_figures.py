"""The figures of the adjustment, drawn from made-up results, and their captions, which tell other numbers apart."""

import numpy as np
import pandas as pd
import pytest
from matplotlib.collections import QuadMesh
from matplotlib.colors import to_hex

from linepose.errors import LineposeError
from linepose.estimation.noise_models import ADJUSTMENT, PUBLISHED
from linepose.output.adjusted import Halves, common_share, estimates, halves, levels_by_set
from linepose.output.figures.corrections import corrections, corrections_caption, labelled, side_by_side
from linepose.output.figures.estimates import estimates_caption, estimates_figure
from linepose.output.figures.halves import halves_caption, halves_figure
from linepose.output.figures.levels import NAMES, levels, levels_caption
from linepose.output.figures.normalised_residuals import expected, normalised_residuals, normalised_residuals_caption
from linepose.output.figures.registry import FIGURES
from linepose.output.figures.style import ORANGE, PURPLE
from linepose.output.figures.weights import weights, weights_caption
from linepose.pipeline.calibration import Calibration
from unit import made_up
from unit.made_up_adjustment import POSE, VALUES, adjusted_measurements, adjusted_views
from unit.made_up_adjustment import levels as level_table


@pytest.fixture(scope="module")
def beside(tmp_path_factory):
    folder = tmp_path_factory.mktemp("beside")
    made_up.write_results(folder)
    return Calibration.from_results(folder, made_up.platform())


@pytest.fixture(scope="module")
def adjusted(tmp_path_factory):
    folder = tmp_path_factory.mktemp("adjusted")
    made_up.write_adjusted_results(folder)
    return Calibration.from_results(folder, made_up.adjusted_platform())


def legend(figure):
    return [text.get_text() for one in figure.legends for text in one.get_texts()]


def test_corrections_have_a_panel_each_with_the_reported_sigmas_as_a_band():
    figure = corrections(adjusted_measurements(), made_up.observations())
    panels = {axes.get_ylabel(): axes for axes in figure.axes}
    assert list(panels) == ["North (mm)", "Roll (°)", "East (mm)", "Pitch (°)", "Down (mm)", "Yaw (°)"]
    second = panels["East (mm)"].lines[1]  # observation 2
    np.testing.assert_allclose(second.get_ydata(), 4.0)
    np.testing.assert_allclose(panels["Yaw (°)"].lines[1].get_ydata(), np.degrees(0.004))
    band = panels["East (mm)"].collections[0].get_paths()[0].vertices
    np.testing.assert_allclose([band[:, 1].min(), band[:, 1].max()], [-10.0, 10.0])  # a variance of 1e-4 m^2
    assert len(panels["East (mm)"].collections) == 6


def test_corrections_caption_has_their_size_in_reported_sigmas_and_the_times():
    told = corrections_caption(adjusted_measurements(), made_up.observations())
    # north has 4 to 7 mm in one observation, -4 to -1 in the next: a mean square of 19.5; 10 mm are reported
    assert "0.44, 0.40, 0.40 of the reported sigmas in north, east and down" in told
    assert "lasted 3.0 to 3.0 s, the survey 303 s" in told


def test_observations_stand_side_by_side_without_their_breaks():
    place, centre = side_by_side(adjusted_measurements())
    np.testing.assert_allclose(np.diff(place[:5]), [1, 1, 1, 0.75])  # a second a point, then a quarter of 3 s
    assert centre[2] == pytest.approx(3.0 + 0.75 + 1.5)
    assert labelled({1: 0.0, 2: 1.0, 3: 2.5}, 2.0) == [1, 3]


def test_a_measurement_without_reported_sigmas_is_named():
    with pytest.raises(LineposeError, match=r"observations\.parquet"):
        corrections(adjusted_measurements(), made_up.observations().query("observation != 3"))


def test_normalised_residuals_are_sorted_against_normal_numbers():
    figure = normalised_residuals(adjusted_measurements())
    along, across = figure.axes
    dots = along.lines[1]
    np.testing.assert_allclose(dots.get_ydata(), np.sort(adjusted_measurements()["normalised_along"]))
    np.testing.assert_allclose(dots.get_xdata(), expected(24)[0])
    assert across.get_title(loc="left") == "across it"
    assert "6 lie beyond 3 sigmas" in normalised_residuals_caption(adjusted_measurements())


def test_the_band_of_chance_holds_what_sorted_normal_numbers_do():
    drawn = np.sort(np.random.default_rng(3).standard_normal((2000, 20)), axis=1)
    middle, low, high = expected(20)
    inside = np.mean((drawn > low) & (drawn < high), axis=0)
    assert np.all(np.abs(inside - 0.95) < 4 * np.sqrt(0.95 * 0.05 / 2000))
    np.testing.assert_allclose(np.median(drawn, axis=0), middle, atol=4 * 1.3 * 0.6 / np.sqrt(2000))


def test_weights_are_coloured_by_what_the_errors_look_like():
    figure = weights(adjusted_views(), adjusted_measurements())
    bars, cells = figure.axes[:2]
    assert [round(bar.get_height(), 3) for bar in bars.patches] == [1.2, 1.1, 1.0, 0.9, 0.8, 0.1]
    colours = [to_hex(bar.get_facecolor()).upper() for bar in bars.patches]
    assert colours[4:] == [PURPLE, ORANGE]
    mesh = next(one for one in cells.collections if isinstance(one, QuadMesh))
    assert mesh.get_array().reshape(4, 6)[2, 4] == 0.05
    assert legend(figure) == ["as good as the rest", "its clock", "labels"]
    told = weights_caption(adjusted_views(), adjusted_measurements())
    assert "Far off: 6 (its clock), 5 (labels)." in told
    assert "point 2 of observation 5 (0.05)" in told


def test_weights_that_are_all_alike_are_told_as_such():
    views, single = adjusted_views().assign(weight=1.0, fault=""), adjusted_measurements().assign(weight=1.0)
    assert "all alike, none is far off" in weights_caption(views, single)
    unknown = views.assign(weight=[np.nan, *[1.0] * 5])
    assert len(weights(unknown, single).axes[0].patches) == 5


def test_levels_lie_on_their_priors_a_mark_a_set(beside, adjusted):
    figure = levels(levels_by_set(adjusted))
    scales, time = figure.axes
    shown = [text.get_text() for text in scales.get_yticklabels()]
    value = dict(zip(shown, scales.lines[0].get_xdata(), strict=True))
    assert value == {words: VALUES[name] for name, words in NAMES.items() if name != "correlation_time_s"}
    np.testing.assert_allclose(time.lines[0].get_xdata(), [13.0])
    assert time.patches[0].get_x() == pytest.approx(300.0 / np.exp(1.96 * 2.0))
    sets = levels_by_set(beside)
    assert list(sets) == ["all", "inliers", "other"]
    assert sets["other"].set_index("level").loc["attitude", ["value", "low", "high"]].tolist() == [1.1, 0.8, 1.5]
    assert legend(levels(sets))[1:] == ["all observations", "accepted observations", "other"]


def test_levels_that_the_data_do_not_narrow_are_named():
    assert "The data narrow all of them" in levels_caption({"all": level_table()})
    wide = level_table().assign(low=lambda table: table["prior_low"], high=lambda table: table["prior_high"])
    wide.loc[wide["level"] != "white", ["low", "high"]] = [0.9, 1.1]
    assert "say little of: each measurement's own." in levels_caption({"all": wide})


def test_halves_of_both_models_stand_beside_right_sigmas(beside, adjusted):
    found = halves(beside)
    assert [(one.noise_model, one.set, round(one.factor, 2)) for one in found] == [
        (ADJUSTMENT.name, "all", 0.95),  # 2.2 over 2.313, the median of chi with six degrees of freedom
        (ADJUSTMENT.name, "inliers", 0.95),
        (ADJUSTMENT.name, "other", 0.48),
        (PUBLISHED.name, "inliers", 1.99),
    ]
    figure = halves_figure(found)
    lines = [line for line in figure.axes[0].lines if line.get_drawstyle() == "steps-post"]
    assert [line.get_color() for line in lines] == [ADJUSTMENT.colour] * 3 + [PUBLISHED.colour]
    np.testing.assert_allclose(lines[0].get_xdata(), np.linspace(1.2, 3.2, 31))
    told = halves_caption(found)
    assert "0.95 times (adjustment, all observations, 31 splits)" in told
    assert "1.99 times (published, accepted observations, 39 splits)" in told
    assert [(one.noise_model, one.set) for one in halves(adjusted)] == [(ADJUSTMENT.name, "all")]


def test_halves_beyond_the_axis_are_drawn_at_its_end():
    figure = halves_figure([Halves(ADJUSTMENT.name, "all", np.array([1.0, 20.0]), 4.5)])
    assert figure.axes[0].lines[1].get_xdata().tolist() == [1.0, 8.0]


def test_estimates_of_both_models_are_drawn_with_two_sigmas(beside):
    table = estimates(beside)
    assert list(zip(table["noise_model"], table["set"], strict=True)) == [
        *((ADJUSTMENT.name, name) for name in ("all", "inliers", "other")),
        *((PUBLISHED.name, name) for name in ("all", "inliers")),
    ]
    figure = estimates_figure(table, made_up.platform().start_pose())
    forward = figure.axes[0]
    bar, other = forward.containers
    np.testing.assert_allclose(np.array(bar.lines[0].get_xdata(), dtype=float), POSE[0] + np.array([0.0, 0.03, 0.0]))
    np.testing.assert_allclose(np.array(other.lines[0].get_xdata(), dtype=float), made_up.OPTIMUM[0])
    (left, right), *_ = bar.lines[2][0].get_segments()
    assert right[0] - left[0] == pytest.approx(4 * 0.04)
    assert "30 mm forwards under adjustment" in estimates_caption(table)


def test_a_survey_has_a_drift_in_common_that_outlasts_it():
    assert common_share(1e9, 1.0) == pytest.approx(1.0)
    assert common_share(1.0, 1.0) == pytest.approx(2 * np.exp(-1))  # 2 (1 - 1 + 1/e)
    assert common_share(1.0, 1e4) == pytest.approx(2e-4, rel=1e-3)


def test_what_makes_no_sense_for_the_adjustment_has_a_reason():
    reasons = {entry.name: entry.left_out(made_up.adjusted_platform()) for entry in FIGURES}
    for name, words in {
        "outliers": "removes no observation",
        "uncertainty": "removes no observation",
        "trace": "independent draws",
        "autocorrelation": "independent draws",
        "repeatability": "random halves",
        "estimates": "one estimate",
    }.items():
        assert words in reasons[name]
    for name in ("levels", "corrections", "weights", "normalised_residuals", "halves", "corner", "residuals_by_point"):
        assert not reasons[name]


def test_no_figure_on_halves_is_named_where_there_is_none():
    without = made_up.platform(noise_model="adjustment", experiments={"basin": None, "repeatability": None})
    reasons = {entry.name: entry.left_out(without) for entry in FIGURES}
    assert reasons["halves"]
    assert "experiments.repeatability has no splits" in reasons["repeatability"]


def test_without_an_adjustment_its_figures_are_left_out():
    alone = made_up.platform(experiments={})
    reasons = {entry.name: entry.left_out(alone) for entry in FIGURES}
    assert all(
        "experiments.adjustment_beside is null" in reasons[name] for name in ("levels", "corrections", "estimates")
    )
    assert "repeatability" in reasons["halves"]
    assert not reasons["repeatability"]


@pytest.mark.parametrize("name", ["levels", "corrections", "weights", "normalised_residuals", "halves"])
def test_figures_of_a_platform_under_the_adjustment_are_drawn_from_its_own_tables(adjusted, name):
    entry = next(one for one in FIGURES if one.name == name)
    assert entry.draw(adjusted).axes
    assert "nan" not in entry.caption(adjusted)


def test_a_level_that_is_missing_is_told():
    with pytest.raises(LineposeError, match="levels"):
        levels({"all": pd.DataFrame(level_table().query("level != 'drift'"))})
