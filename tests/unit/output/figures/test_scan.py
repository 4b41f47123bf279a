import numpy as np
import pandas as pd
import pytest

from linepose.errors import InputError
from linepose.inputs.targets.board_in_scan import fit_board
from linepose.output.figures.scan import (
    detected_points_caption,
    labelled_points_caption,
    points_in_scan,
    stacked_scan,
    stacked_scan_caption,
)
from linepose.output.figures.scan_example import ScanExample, board_of, chosen
from linepose.survey.pattern import board_points
from linepose.survey.targets.points import PointsSection
from linepose.survey.targets.rings import RingsSection

BOARD_M = board_points()[:, :2]
RNG = np.random.default_rng(2)


def points_at(matrix, offset):
    """All points of a board at `matrix b + offset`."""
    u, line = (BOARD_M @ np.transpose(matrix) + offset).T
    return pd.DataFrame({"point": np.arange(15), "u_px": u, "line": line})


def example(title="Observation 3\nslow", matrix=((60, 0), (0, 120)), offset=(50, 90), shape=(200, 100)):
    points = points_at(matrix, offset)
    return ScanExample(title, RNG.random(shape, dtype=np.float32), points, board_of(points, RingsSection()))


def test_sheet_is_framed_where_its_points_have_it():
    axes = stacked_scan([example()]).axes[0]
    frame = axes.lines[0].get_xydata()
    centre, half = np.array([50, 90]), np.array([0.841, 0.594]) / 2 * [60, 120]
    np.testing.assert_allclose(frame[0], centre - half, atol=1e-6)
    np.testing.assert_allclose(frame[2], centre + half, atol=1e-6)
    left, right, bottom, top = axes.images[0].get_extent()
    assert (left, right) == (-0.5, 99.5)  # pixel centres at whole numbers, whole lines
    assert top < frame[:, 1].min() - 10
    assert bottom > frame[:, 1].max() + 10
    assert bottom > top  # lines downwards
    assert axes.get_aspect() == 1.0
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("Pixel u (px)", "Scan line (count)")


@pytest.mark.parametrize("count", [1, 2, 3])
def test_each_example_has_a_panel_of_each_figure(count):
    examples = [example(f"Observation {n}\nmirrored") for n in range(count)]
    for draw in (stacked_scan, points_in_scan):
        figure = draw(examples)
        assert {axes.get_title() for axes in figure.axes} == {one.title for one in examples}


def test_points_are_crossed_and_numbered_where_they_are():
    one = example()
    axes = points_in_scan([one]).axes[0]
    np.testing.assert_allclose(axes.lines[0].get_xydata(), one.points[["u_px", "line"]])
    assert [text.get_text() for text in axes.texts] == [str(n) for n in range(15)]
    left, right, bottom, top = axes.images[0].get_extent()
    part = axes.images[0].get_array()
    np.testing.assert_allclose(part[0, 0], one.intensity[int(top + 0.5), int(left + 0.5)])
    assert part.shape == (bottom - top, right - left)
    assert left < one.outline()[:, 0].min() < one.outline()[:, 0].max() < right


def test_captions_name_the_observations_and_count_their_points():
    for caption in (stacked_scan_caption, labelled_points_caption, detected_points_caption):
        assert "observation 3 (slow, 15 points)" in caption([example()])


def test_a_scan_without_numbers_is_refused():
    one = example()
    one.intensity[:] = np.nan
    with pytest.raises(InputError, match="scan"):
        stacked_scan([one])


def boards(**matrices):
    return {int(name[1:]): fit_board(BOARD_M, BOARD_M @ np.transpose(m)) for name, m in matrices.items()}


def test_quick_mirrored_and_slow_examples_are_chosen():
    views = boards(
        o1=((300, 0), (0, -1200)),  # mirrored, four times as slow
        o2=((300, 0), (0, -700)),  # mirrored, more than twice as slow
        o4=((0, 300), (310, 0)),  # mirrored and turned
        o5=((300, 0), (0, -320)),  # the quick one's mirror image
        o7=((300, 0), (0, 300)),  # quick
        o8=((300, 0), (0, 305)),
    )
    assert chosen(views) == {
        7: "Observation 7\nnot mirrored",
        5: "Observation 5\nmirrored",
        2: "Observation 2\nmirrored, slow",
    }


def test_passes_alike_leave_one_example():
    assert chosen(boards(o3=((300, 0), (0, -310)), o9=((300, 0), (0, -300)))) == {9: "Observation 9\nmirrored"}


def test_points_that_are_not_the_targets_have_no_board():
    view = pd.DataFrame({"point": [f"stone {k}" for k in range(8)], "u_px": np.arange(8.0), "line": np.arange(8.0)})
    assert board_of(view, RingsSection()) is None
    assert board_of(view, PointsSection()) is None
