"""What the page says of the adjustment: sentences that other numbers would change, and tables."""

import numpy as np
import pytest

from linepose.output.report.adjustment import adjustment_section, views_sentence, with_least_weights
from linepose.output.report.adjustment_words import boresight_sentence, levels_sentence, sigmas_sentence
from linepose.output.report.page import PlatformOnPage, render_platform_page
from linepose.output.report.platform_sections import leading_sections, platform_sections
from linepose.pipeline.calibration import Calibration
from linepose.pipeline.stages import DIAGNOSTICS
from linepose.pipeline.summary import summarise
from linepose.tables import read_table, write_table
from unit import made_up
from unit.made_up_adjustment import adjusted_measurements, adjusted_views, levels

REPORTED_RAD = np.radians([0.2, 0.2, 0.1])


@pytest.fixture(scope="module")
def beside(tmp_path_factory):
    folder = tmp_path_factory.mktemp("beside") / "made-up"
    made_up.write_results(folder)
    return Calibration.from_results(folder, made_up.platform())


@pytest.fixture(scope="module")
def adjusted(tmp_path_factory):
    folder = tmp_path_factory.mktemp("adjusted") / "made-up"
    made_up.write_adjusted_results(folder)
    return Calibration.from_results(folder, made_up.adjusted_platform())


def with_levels(**changes):
    table = levels().set_index("level")
    for name, row in changes.items():
        table.loc[name, list(row)] = list(row.values())
    return table.reset_index()


def test_levels_are_told_in_words_with_their_numbers():
    assert levels_sentence(levels()) == (
        "The navigation's position errs by 1 of what it reports (0.8 drifts within 13 s, 0.6 is common to an "
        "observation), its attitude by 0.4 of what it reports. Labels are good to 0.23 of the stated pixel noise along "
        "the scan line and to 0.62 line across it."
    )
    noisy = with_levels(white={"value": 0.75}, drift={"value": 0.01}, correlation_time_s={"value": 600.0})
    assert "errs by 0.96 of what it reports (0.6 is common to an observation, 0.75 is each meas" in levels_sentence(
        noisy
    )
    assert "drifts within 10 min" in levels_sentence(with_levels(correlation_time_s={"value": 600.0}))


def test_attitude_sigmas_look_wrong_where_their_interval_leaves_out_one():
    low = with_levels(attitude={"value": 0.35, "low": 0.2, "high": 0.6})
    fits = with_levels(attitude={"value": 1.1, "low": 0.8, "high": 1.5})
    high = with_levels(attitude={"value": 3.0, "low": 2.0, "high": 4.0})
    told = sigmas_sentence({"all": low, "other": fits})
    assert "all observations: they look too large and want a factor of 0.35 (0.2 to 0.6 with 95 %)" in told
    assert "other: they fit as they are (factor 1.1, 0.8 to 1.5 with 95 %)" in told
    assert "Where other differs from this platform in its covariance columns alone, those columns" in told
    assert "those columns" not in sigmas_sentence({"all": low, "inliers": fits, "other": high})
    assert "those columns" not in sigmas_sentence({"all": fits, "other": fits})
    assert "other: they look too small and want a factor of 3" in sigmas_sentence({"all": low, "other": high})
    unknown = with_levels(attitude={"value": 0.4, "low": np.nan, "high": np.nan})
    assert "all observations: not known" in sigmas_sentence({"all": unknown})


def test_a_boresight_has_the_survey_s_own_attitude_error_in_it_where_drift_outlasts_it():
    assert boresight_sentence(levels(), 300.0, REPORTED_RAD) == ""  # 13 s of drift in 300 s
    assert boresight_sentence(with_levels(drift={"value": 0.01}), 10.0, REPORTED_RAD) == ""
    told = boresight_sentence(with_levels(correlation_time_s={"value": 3e4}), 300.0, REPORTED_RAD)
    assert "The drift lasts 500 min, the survey 5 min: 100 % of the drift's variance" in told
    assert "0.064° in roll, 0.064° in pitch, 0.032° in yaw (one sigma)" in told  # 0.8 x 0.4 of 0.2 and 0.1 deg


def test_observations_that_are_far_off_are_named_with_what_their_errors_look_like():
    views = with_least_weights(adjusted_views(), adjusted_measurements())
    assert views_sentence(views) == (
        "Far off, but not removed: observation 5, weight 0.05, as if points were mislabelled; 6, weight 0.1, as if its "
        "clock were off."
    )
    assert "No observation is far off" in views_sentence(views.assign(fault=""))


def test_beside_the_published_model_the_adjustment_leads_with_both_poses(beside):
    (section,) = leading_sections(beside)
    assert section.paragraphs[0] == (
        "Random halves lie 0.95 times as far apart as stated (adjustment, all observations), 0.95 times (adjustment, "
        "accepted observations), 0.48 times (adjustment, other), 1.99 times (published, accepted observations)."
    )
    assert section.paragraphs[-1] == "Warning (other): few draws."
    poses, of_levels, sigmas, of_halves, views = section.tables
    heads = ["Number", "Adjustment, 6 all", "Adjustment, 4 accepted", "Published, 4 accepted", "By hand"]
    assert list(poses.heads) == heads
    assert poses.rows[0] == [
        "r_x forward (m)",
        "0.1700 ± 0.0400",
        "0.2000 ± 0.0400",
        "0.1900 ± 0.0300",
        "0.2000 ± 0.1000",
    ]
    assert of_levels.rows[0][1:] == ["0.8 (0.4 to 0.4)"] * 3 + ["0.5 (0.026 to 9.5)"]
    assert [row[-1] for row in sigmas.rows] == ["look wrong", "look wrong", "fit"]
    assert sigmas.rows[2][1:4] == ["1.00", "1.10", "1.1 (0.8 to 1.5)"]
    assert of_halves.rows[0] == ["adjustment", "all observations", "31", "2.20", "0.95"]
    assert views.rows[4][1:4] == ["0.80", "0.05", "as if points were mislabelled"]
    assert views.rows[5][:5] == ["6", "0.10", "0.10", "as if its clock were off", "2.0"]
    assert "adjustment" not in "".join(one.anchor for one in platform_sections(beside))


def test_under_the_adjustment_the_section_follows_the_pose(adjusted):
    assert leading_sections(adjusted) == []
    section = platform_sections(adjusted)[0]
    assert section.paragraphs[0] == "Random halves lie 1.99 times as far apart as stated."
    assert section.paragraphs[-1] == "Warning: few draws."
    assert [table.title for table in section.tables] == [
        "Levels",
        "Reported sigmas",
        "The camera",
        "Random halves",
        "Observations",
    ]


def test_a_platform_without_an_adjustment_has_no_section(beside):
    alone = Calibration.from_results(beside.results.folder, made_up.platform(experiments={}))
    assert adjustment_section(alone) is None


def page_of(calibration):
    one = PlatformOnPage(
        summarise(calibration), leading_sections(calibration), platform_sections(calibration), [], "settings"
    )
    return " ".join(render_platform_page(one, "study", {"python": "3"}).split())


def test_the_page_puts_the_adjustment_before_the_published_model_s_pose(beside):
    page = page_of(beside)
    places = [page.index(f'<h3 id="made-up-{name}"') for name in ("adjustment", "verdict", "pose", "decided")]
    assert places == sorted(places)
    assert "Pose under the published noise model</h3>" in page
    assert "4 of 6 observations accepted, -log L" in page


def test_the_page_of_an_adjusted_platform_speaks_of_weights(adjusted):
    page = page_of(adjusted)
    places = [page.index(f'<h3 id="made-up-{name}"') for name in ("verdict", "pose", "adjustment", "decided")]
    assert places == sorted(places)
    assert "Pose</h3>" in page
    assert "all 6 observations, each with its weight, half of chi squared 12.500" in page
    assert "accepted" not in page[: page.index("made-up-pose")]
    assert '<p class="care">Warning: few draws.</p>' in page


def test_a_known_target_is_told_with_the_sigmas_with_and_without(adjusted, tmp_path):
    assert "Known target" not in [table.title for table in adjustment_section(adjusted).tables]
    folder = tmp_path / "made-up"
    made_up.write_adjusted_results(folder)
    table = read_table(folder / "diagnostics.parquet", DIAGNOSTICS)
    without = 2.0 * table["laplace_sigma"] * [1, 1, 2, 1, 1, 1]
    fits = table.assign(sigma_without_target=without, target_misfit_sigmas=1.3)
    write_table(fits, folder / "diagnostics.parquet", DIAGNOSTICS)
    section = adjustment_section(Calibration.from_results(folder, made_up.adjusted_platform()))
    gained = next(one for one in section.tables if one.title == "Known target")
    assert [row[-1] for row in gained.rows] == ["0.50", "0.50", "0.25", "0.50", "0.50", "0.50"]
    assert "1.3 sigmas off what is seen without it; with it the sigma of r_z down is 0.25 times" in section.text
    write_table(fits.assign(target_misfit_sigmas=7.0), folder / "diagnostics.parquet", DIAGNOSTICS)
    section = adjustment_section(Calibration.from_results(folder, made_up.adjusted_platform()))
    assert "7.0 sigmas off what is seen without it, and was not used." in section.text


def test_what_is_said_of_a_table_stands_between_its_title_and_the_table(adjusted):
    page = page_of(adjusted)
    assert "<h4>Levels</h4> <p>Each with its 95 % interval.</p> <div" in page
    assert "<h4>The camera</h4> <p>One sigma each. The survey tells" in page
