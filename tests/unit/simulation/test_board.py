import numpy as np

from linepose.simulation import board
from linepose.simulation.settings import BoardSettings
from linepose.survey import pattern


def test_ids_run_to_and_fro_at_the_published_spacings():
    steps = np.linalg.norm(np.diff(pattern.board_points(), axis=0), axis=1)
    expected = np.full(14, 0.1511)
    expected[[4, 9]] = 0.1669
    np.testing.assert_allclose(steps, expected, atol=1e-12)
    np.testing.assert_allclose(pattern.board_points().mean(axis=0), 0, atol=1e-12)


def test_corner_mark_is_on_the_print_and_clear_of_the_nearest_ring():
    mark, half = np.abs(pattern.CORNER_MARK_CENTRE_M), pattern.CORNER_MARK_SIDE_M / 2
    assert np.all(mark + half <= np.array(pattern.SHEET_M) / 2 - pattern.PRINT_MARGIN_M)
    nearest_corner = mark - half
    assert np.linalg.norm(nearest_corner - np.abs(pattern.board_points()[0, :2])) > pattern.RING_OUTER_DIAMETER_M / 2


def test_upright_board_facing_west_has_its_rows_level():
    settings = BoardSettings(position_m=(1.0, 2.0, -3.0), euler_rad=(np.pi / 2, 0.0, np.pi))
    points = board.world_points(settings)
    np.testing.assert_allclose(points.mean(axis=0), [1, 2, -3], atol=1e-12)
    np.testing.assert_allclose(points[1] - points[0], [-0.1511, 0, 0], atol=1e-12)  # to the right, seen from the west
    np.testing.assert_allclose(points[9] - points[0], [0, 0, 0.1669], atol=1e-12)
