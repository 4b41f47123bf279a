"""Each figure drawn from made-up results: axes with units, the artists that must be there, marks where they belong."""

import numpy as np
import pandas as pd
import pytest
from matplotlib.collections import LineCollection, PathCollection, QuadMesh
from matplotlib.colors import to_hex
from matplotlib.patches import Ellipse, Rectangle

from linepose.errors import LineposeError
from linepose.experiments.basin import Region
from linepose.output.figures.basin import basin, basin_caption
from linepose.output.figures.corner_plot import corner_plot, corner_plot_caption, two_ticks
from linepose.output.figures.mapping import angle_error, mapping, mapping_caption
from linepose.output.figures.outlier_matrix import outlier_matrix, outlier_matrix_caption
from linepose.output.figures.platform_sketch import platform_sketch
from linepose.output.figures.repeatability import repeatability, repeatability_caption
from linepose.output.figures.residuals import residuals, residuals_caption
from linepose.output.figures.rotation_axis import axis_and_angle, rotation_axis, tangent_plane
from linepose.output.figures.style import GREEN, RED
from linepose.output.figures.survey_plan import label_places, survey_plan, survey_plan_caption
from linepose.output.figures.trace import autocorrelation, autocorrelation_function, trace
from linepose.output.figures.uncertainty import uncertainty
from linepose.survey.observations import survey_from_table
from unit import made_up

MARKED = {"optimum": made_up.OPTIMUM, "hand measured": made_up.platform().start_pose(), "truth": made_up.OPTIMUM + 0.01}


def labels(figure):
    return {text for axes in figure.axes for text in (axes.get_xlabel(), axes.get_ylabel()) if text}


def legend(figure):
    return [text.get_text() for one in figure.legends for text in one.get_texts()]


def test_outlier_matrix_frames_the_accepted_row_and_leaves_removed_cells_white():
    figure = outlier_matrix(made_up.outliers())
    axes = figure.axes[0]
    mesh = next(artist for artist in axes.collections if isinstance(artist, QuadMesh))
    cells = mesh.get_array().reshape(4, 6)
    assert cells.mask.sum() == 0 + 1 + 2 + 3  # what the stages with 6, 5, 4 and 3 observations no longer have
    assert cells[0, 5] == 9.0
    frame = next(patch for patch in axes.patches if isinstance(patch, Rectangle) and patch.get_label() == "accepted")
    assert (frame.get_xy(), frame.get_width(), frame.get_height()) == ((-0.5, 1.5), 6, 1)
    crosses = axes.lines[0]
    assert list(zip(crosses.get_xdata(), crosses.get_ydata(), strict=True)) == [(5, 0), (4, 1), (3, 2)]
    assert {"Observation", "Observations used", "Mean reprojection error (px)"} <= labels(figure)
    assert legend(figure) == ["removed next", "accepted"]
    assert "6, 5" in outlier_matrix_caption(made_up.outliers(), 5.0)


def test_corner_plot_marks_each_pose_in_each_panel():
    figure = corner_plot(made_up.samples(), MARKED)
    panels = np.array(figure.axes).reshape(6, 6)
    assert panels[5, 0].get_xlabel() == "$r_x$ (m)"
    assert panels[5, 0].get_ylabel() == r"$\theta e_z$ (rad)"
    marks = [line.get_xydata()[0] for line in panels[3, 1].lines if line.get_marker() in ("s", "D", "o")]
    np.testing.assert_allclose(marks, [[pose[1], pose[3]] for pose in MARKED.values()])
    low, high = panels[3, 1].get_ylim()
    assert all(low < pose[3] < high for pose in MARKED.values())
    assert legend(figure)[:3] == ["optimum", "hand measured", "truth"]
    assert "320 samples" in corner_plot_caption(made_up.samples())


def test_mapping_shows_both_poses_the_points_and_ellipses_of_one_sigma():
    figure = mapping(made_up.mapping(), made_up.estimated_points(), made_up.observations(), 2)
    upper, lower = figure.axes
    before, after = (one for one in upper.collections if isinstance(one, PathCollection))
    assert len(before.get_offsets()) == len(after.get_offsets()) == 24
    assert to_hex(after.get_facecolor()[0]).upper() == RED
    crosses = next(line for line in upper.lines if line.get_color() == GREEN)
    np.testing.assert_allclose(
        np.sort(crosses.get_xydata(), axis=0), np.sort(made_up.POINTS[:, [1, 0]], axis=0), atol=1e-9
    )
    ellipses = [patch for patch in lower.patches if isinstance(patch, Ellipse)]
    assert len(ellipses) == 4
    np.testing.assert_allclose([[one.width, one.height] for one in ellipses], 0.04)  # sigma 0.02 m to both sides
    assert labels(figure) == {"East (m)", "North (m)"}
    assert "100 mm before and 10 mm after" in mapping_caption(made_up.mapping_summary(), 2)


def test_angle_error_compares_the_turned_pose_with_the_calibrated():
    figure = angle_error(made_up.mapping(), made_up.estimated_points(), made_up.observations(), 1.0)
    assert [len(one.get_offsets()) for one in figure.axes[0].collections] == [24, 24]
    assert "turned by 1° about each axis" in legend(figure)


def test_mapping_leaves_out_rays_that_miss_the_plane_and_refuses_a_table_without_a_pose():
    table = made_up.mapping().astype({"north_m": float})
    table.loc[3, "north_m"] = np.nan
    figure = mapping(table, made_up.estimated_points(), made_up.observations(), 2)
    assert len(figure.axes[0].collections[0].get_offsets()) == 23
    with pytest.raises(LineposeError, match="calibrated"):
        mapping(table[table["pose"] != "calibrated"], made_up.estimated_points(), made_up.observations(), 2)


def test_survey_plan_numbers_every_observation():
    survey = survey_from_table(made_up.observations())
    figure = survey_plan(survey, made_up.ACCEPTED, made_up.estimated_points())
    axes = figure.axes[0]
    assert {text.get_text() for text in axes.texts} == {"1", "2", "3", "4", "5", "6"}
    accepted, rejected = (one for one in axes.collections if isinstance(one, PathCollection))
    assert (len(accepted.get_offsets()), len(rejected.get_offsets())) == (4, 2)
    np.testing.assert_allclose(accepted.get_array()[0], np.hypot(5.0, np.degrees(0.01)))
    assert {"East of the pattern (m)", "North of the pattern (m)", "Norm of roll and pitch (°)"} <= labels(figure)
    assert "6 observations, 4 accepted" in survey_plan_caption(survey, made_up.ACCEPTED)


def test_labels_keep_clear_of_each_other():
    plan = np.array([[0.0, 3.0], [0.02, 3.0], [0.0, 3.05], [3.0, 0.0], [-3.0, 0.0], [0.0, -3.0]])
    headings = plan + np.array([0.0, 0.4])
    places = label_places(plan, headings)
    apart = np.linalg.norm(places[:, None] - places, axis=-1)[np.triu_indices(6, 1)]
    assert apart.min() > 0.2  # 3 % of the 6 m that the survey spans
    assert np.linalg.norm(places[:, None] - headings, axis=-1).min() > 0.2


def test_uncertainty_draws_both_methods_of_six_parameters():
    figure = uncertainty(made_up.uncertainty())
    drawn = [line for axes in figure.axes for line in axes.lines if len(line.get_xdata()) == 3]
    assert len(drawn) == 12
    np.testing.assert_allclose(drawn[0].get_xdata(), [4, 5, 6])
    np.testing.assert_allclose(drawn[0].get_ydata()[0], 30.0)  # 0.03 m at four observations
    assert labels(figure) == {"Sigma of position (mm)", "Sigma of rotation (°)", "Observations used"}


def test_basin_colours_each_cell_and_draws_the_region():
    region = Region(1.0, 0.6)
    figure = basin(made_up.basin(), region)
    powell, wide = figure.axes
    meshes = [next(one for one in axes.collections if isinstance(one, QuadMesh)) for axes in (powell, wide)]
    assert [mesh.get_array().sum() for mesh in meshes] == [6, 12]
    np.testing.assert_allclose(meshes[0].get_array().reshape(3, 4), np.tile([1, 1, 0, 0], (3, 1)))
    np.testing.assert_allclose(powell.lines[0].get_xydata(), [[0, np.degrees(0.6)], [1.0, 0]])
    assert labels(figure) == {"Angle of the start (°)", "Distance of the start (m)"}
    assert powell.get_title("left").endswith("50 %")
    assert "100 %" in basin_caption(made_up.basin_summary(), region)


def test_rotation_axis_has_sphere_close_up_and_histogram():
    figure = rotation_axis(made_up.samples(), MARKED)
    sphere, close, colours, histogram = figure.axes
    assert sphere.name == "3d"
    assert {"To the right (°)", "Upwards (°)"} <= labels(figure)
    assert colours.get_ylabel() == "Density (1/°²)"
    hand = next(line for line in close.lines if line.get_color() == RED).get_xydata()[0]
    axes = [axis_and_angle(pose[3:])[0] for pose in (MARKED["hand measured"], made_up.OPTIMUM)]
    between = np.degrees(np.arccos(axes[0] @ axes[1]))
    # the mean of 320 samples with 0.02 rad lies within 0.1 deg of the optimum; a sine is less than its angle by 1e-3
    assert np.linalg.norm(hand) == pytest.approx(between, abs=0.3)
    assert "(°)" in histogram.get_xlabel()
    lines = [line.get_xdata()[0] for line in histogram.lines]
    np.testing.assert_allclose(lines, [np.degrees(np.linalg.norm(pose[3:])) for pose in MARKED.values()])
    axis, angle = axis_and_angle([0.0, 0.0, -np.pi / 2])
    np.testing.assert_allclose(axis, [0, 0, -1])
    assert angle == pytest.approx(90.0)


@pytest.mark.parametrize("pole", [[0.6, 0.0, -0.8], [0.0, 1.0, 0.0], [0.0, 0.1, np.sqrt(0.99)]])
def test_the_close_up_is_seen_from_outside(pole):
    (rightwards, upwards), (_, label) = tangent_plane(np.array(pole))
    np.testing.assert_allclose(np.cross(rightwards, upwards), pole, atol=1e-12)  # right-handed towards the viewer
    wanted = {"Upwards (°)": [0.0, 0.0, -1.0], "Forwards (°)": [1.0, 0.0, 0.0]}[label]
    assert upwards @ wanted > 0


def test_truth_is_circled_where_it_is_known():
    truth = made_up.ORIGIN + made_up.POINTS
    tables = made_up.mapping(), made_up.estimated_points(), made_up.observations()
    for figure, panels in ((mapping(*tables, 2, truth), 2), (angle_error(*tables, 1.0, truth), 1)):
        for axes in figure.axes[:panels]:
            circles = next(line for line in axes.lines if line.get_label() == "true points")
            np.testing.assert_allclose(
                np.sort(circles.get_xydata(), axis=0), np.sort(made_up.POINTS[:, [1, 0]], axis=0), atol=1e-9
            )
        assert "true points" in legend(figure)


def test_corner_ticks_are_few_and_keep_off_the_ends():
    assert two_ticks(-0.35, 0.05) == pytest.approx([-0.2, -0.1])
    assert len(two_ticks(0.0, 0.01)) == 2
    assert two_ticks(1.0, 1.0 + 1e-12) != []


def test_platform_sketch_shows_outline_and_optical_axes_in_both_views():
    outline = made_up.platform().outline
    figure = platform_sketch(made_up.samples(), outline, MARKED)
    side, front, side_close, front_close = figure.axes
    assert (side.get_xlabel(), front.get_xlabel(), side.get_ylabel()) == ("Forward (m)", "Right (m)", "Up (m)")
    circle, frame = side.patches
    assert circle.center == (0.5, -0.7)
    # the frame is where the close-up is: 3.5 of the largest sigma to each side of the mean position
    np.testing.assert_allclose([frame.get_x(), frame.get_x() + frame.get_width()], side_close.get_xlim())
    assert frame.get_width() == pytest.approx(7.0 * made_up.samples()[["r_x_m", "r_y_m", "r_z_m"]].std(ddof=0).max())
    for axes, axis in ((side_close, 0), (front_close, 1)):
        mesh = next(one for one in axes.collections if isinstance(one, QuadMesh))
        assert mesh.get_array().sum() == 320  # every sample is in a cell
        marks = [line.get_xydata()[0] for line in axes.lines if line.get_marker() in ("s", "D", "o")]
        np.testing.assert_allclose(marks, [[pose[axis], -pose[2]] for pose in MARKED.values()])
    np.testing.assert_allclose(side.lines[0].get_xydata()[2], [0.0, 0.7])  # the top of the triangle, up
    sampled = next(one for one in side.collections if isinstance(one, LineCollection))
    assert len(sampled.get_segments()) == 200
    assert front.xaxis_inverted()
    assert front_close.xaxis_inverted()  # seen from the front, the platform's right is on the left


def test_trace_and_autocorrelation_have_a_line_for_each_parameter():
    figure = trace(made_up.samples(), {"optimum": made_up.OPTIMUM, "truth": made_up.OPTIMUM + 0.01})
    assert len(figure.axes) == 6
    optimum, truth = figure.axes[1].lines[-2:]
    np.testing.assert_allclose(optimum.get_ydata(), -0.14)
    np.testing.assert_allclose(truth.get_ydata(), -0.13)
    assert legend(figure)[-2:] == ["optimum", "truth"]
    figure = autocorrelation(made_up.samples())
    assert len([line for line in figure.axes[0].lines if len(line.get_xdata()) == made_up.N_STEPS]) == 6
    assert "Lag (steps)" in labels(figure)


def test_autocorrelation_function_of_an_alternating_series():
    series = np.tile([1.0, -1.0], 50)[:, None]
    function = autocorrelation_function(series)
    np.testing.assert_allclose(function[:3], [1.0, -0.99, 0.98], atol=1e-9)  # (100 - lag) / 100, alternating


@pytest.mark.parametrize(("by", "groups"), [("observation", ["1", "2", "3", "4"]), ("point", ["0", "1", "2", "3"])])
def test_residuals_show_every_point_in_its_group(by, groups):
    figure = residuals(made_up.residuals(), by)
    upper, lower = figure.axes
    assert [text.get_text() for text in lower.get_xticklabels()] == groups
    dots = next(one for one in upper.collections if isinstance(one, PathCollection))
    assert len(dots.get_offsets()) == 16
    assert [bar.get_height() for bar in upper.patches] == [4.0] * 4  # two sigmas of 2 px
    assert {"Error along the line (px)", "Error across the line (px)"} <= labels(figure)


def test_residuals_caption_says_what_a_view_has_in_common():
    assert "100 %" in residuals_caption(made_up.residuals(), "observation")


def test_repeatability_leaves_open_splits_out_and_says_by_how_much_sigmas_fail():
    figure = repeatability(made_up.splits())
    assert "39 random splits" in legend(figure)
    assert "Distance of the two poses (sigmas)" in labels(figure)
    told = repeatability_caption(made_up.splits())
    assert "too small by a factor of 1.99" in told  # 4.6 over the median of chi with six degrees of freedom, 2.313
    assert "1 splits left" in told


def test_repeatability_marks_the_named_subsets_unless_one_leaves_its_pose_open():
    pair = pd.DataFrame({"subset": ["subset_1", "subset_2"], "mahalanobis": 2.5})
    figure = repeatability(made_up.splits(), pair)
    assert "the two named subsets" in legend(figure)
    assert "named subsets are 2.50 apart" in repeatability_caption(made_up.splits(), pair)
    unknown = pair.assign(mahalanobis=np.nan)
    assert "the two named subsets" not in legend(repeatability(made_up.splits(), unknown))
    assert "named" not in repeatability_caption(made_up.splits(), unknown)


@pytest.mark.parametrize(
    ("draw", "table", "column"),
    [
        (outlier_matrix, made_up.outliers, "error_px"),
        (lambda table: corner_plot(table, MARKED), made_up.samples, "r_x_m"),
        (lambda table: rotation_axis(table, MARKED), made_up.samples, "theta_x_rad"),
        (lambda table: platform_sketch(table, made_up.platform().outline, MARKED), made_up.samples, "r_z_m"),
        (lambda table: trace(table, {"optimum": made_up.OPTIMUM}), made_up.samples, "r_y_m"),
        (autocorrelation, made_up.samples, "theta_z_rad"),
        (lambda table: residuals(table, "point"), made_up.residuals, "error_u_px"),
        (uncertainty, made_up.uncertainty, "sigma_r_x_m"),
    ],
)
def test_a_number_that_is_not_finite_or_a_column_that_is_missing_is_named(draw, table, column):
    broken = table()
    broken.loc[broken.index[1], column] = np.nan
    with pytest.raises(LineposeError, match=column):
        draw(broken)
    with pytest.raises(LineposeError, match=column):
        draw(table().drop(columns=column))
    with pytest.raises(LineposeError, match="no rows"):
        draw(table().iloc[:0])
