import numpy as np
import pandas as pd
import pytest

from linepose.errors import InputError
from linepose.figures.scan import labelled_points, stacked_scan

POINTS = pd.DataFrame({"point": [0, 1, 14], "u_px": [10.0, 30.0, 20.0], "line": [20.0, 22.0, 60.0]})
SCAN = np.random.default_rng(2).random((100, 48), dtype=np.float32)


def test_stacked_scan_shows_all_lines_and_frames_the_points():
    axes = stacked_scan(SCAN, POINTS).axes[0]
    image = axes.images[0]
    assert image.get_array().shape == (100, 48)
    assert image.get_extent() == [-0.5, 47.5, 99.5, -0.5]  # pixel centres at whole numbers, lines downwards
    frame = axes.lines[0].get_xydata()
    assert frame[:, 0].min() < 10
    assert frame[:, 0].max() > 30
    assert frame[:, 1].min() < 20
    assert frame[:, 1].max() > 60
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("Pixel u (px)", "Scan line (count)")


def test_labelled_points_are_crossed_and_numbered_where_they_are():
    axes = labelled_points(SCAN, POINTS).axes[0]
    np.testing.assert_allclose(axes.lines[0].get_xydata(), POINTS[["u_px", "line"]])
    assert [text.get_text() for text in axes.texts] == ["0", "1", "14"]
    left, _, bottom, top = axes.images[0].get_extent()
    part = axes.images[0].get_array()
    np.testing.assert_allclose(part[0, 0], SCAN[int(top + 0.5), int(left + 0.5)])
    assert (bottom - top, part.shape[0]) == (part.shape[0], part.shape[0])


@pytest.mark.parametrize("intensity", [np.zeros((0, 5), np.float32), np.full((5, 5), np.nan, np.float32)])
def test_a_scan_without_lines_or_numbers_is_refused(intensity):
    with pytest.raises(InputError, match="scan"):
        stacked_scan(intensity, POINTS)
