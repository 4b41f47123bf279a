"""Every kind of target: its points lie where its print shows them, whatever its size."""

import numpy as np
import pytest

from linepose.errors import InputError
from linepose.survey import pattern
from linepose.survey.targets.artwork import Artwork, Disc, Rectangle
from linepose.survey.targets.base import RectifiedSection
from linepose.survey.targets.registry import KINDS, PRINTED
from linepose.survey.targets.rings import RingsSection

RESOLUTION_M, MARGIN_M = 0.002, 0.03
FOUND = [name for name, section in PRINTED.items() if issubclass(section, RectifiedSection)]


def seen(target, turns=0):
    """A soft picture of the print, and where its points lie in it; turned by quarters."""
    cv2 = pytest.importorskip("cv2")
    white = target.artwork().picture(RESOLUTION_M, MARGIN_M)
    picture = cv2.GaussianBlur(np.where(white, 220, 40).astype(np.uint8), (0, 0), 0.8)
    place = target.points()[:, :2] / RESOLUTION_M + (np.array(picture.shape[::-1]) - 1) / 2
    for _ in range(turns):
        picture = np.ascontiguousarray(np.rot90(picture))
        place = np.stack([place[:, 1], picture.shape[0] - 1 - place[:, 0]], axis=-1)
    return picture, place


@pytest.mark.parametrize("kind", PRINTED)
def test_defaults_are_those_of_a_scaled_target(kind):
    assert PRINTED[kind].scaled(None, None, None) == PRINTED[kind]()


@pytest.mark.parametrize("kind", PRINTED)
def test_artwork_keeps_within_its_field_and_scales_with_the_spacing(kind):
    section = PRINTED[kind]
    artwork = section().artwork()
    half = np.array([artwork.width_m, artwork.height_m]) / 2 + 1e-9
    assert np.all(np.abs(section().points()[:, :2]) < half)
    for shape in artwork.shapes:
        size = (shape.width_m, shape.height_m) if isinstance(shape, Rectangle) else (shape.diameter_m,) * 2
        corner = np.array([shape.x_m, shape.y_m]) - (0 if isinstance(shape, Rectangle) else shape.diameter_m / 2)
        assert np.all(corner >= -half)
        assert np.all(corner + size <= half)
    larger = section.scaled(None, None, 2 * section().spacing).artwork()
    np.testing.assert_allclose([larger.width_m, larger.height_m], 4 * half, rtol=1e-6)


@pytest.mark.parametrize("turns", [0, 1])
@pytest.mark.parametrize("kind", FOUND)
def test_points_are_found_in_the_print_up_to_the_turns_that_look_alike(kind, turns):
    target = PRINTED[kind]()
    picture, place = seen(target, turns)
    found = target.find(picture)
    assert len(found.row) >= 0.9 * len(place)
    errors = [np.abs(found.place - place[numbering][found.row]).max() for numbering in target.symmetries()]
    assert min(errors) < 1.0


@pytest.mark.parametrize("kind", FOUND)
def test_nothing_is_found_where_there_is_none(kind):
    ground = np.random.default_rng(1).integers(60, 200, (90, 120)).astype(np.uint8)
    assert KINDS[kind]().find(ground) is None


@pytest.mark.parametrize("kind", ["charuco", "apriltags"])
def test_a_part_is_enough(kind):
    target = PRINTED[kind]()
    picture, place = seen(target)
    found = target.find(picture[:, : picture.shape[1] // 2])
    assert 4 <= len(found.row) < len(place)
    assert np.abs(found.place - place[found.row]).max() < 1.0


def test_default_rings_are_the_papers_board():
    rings = RingsSection()
    np.testing.assert_array_equal(rings.points(), pattern.board_points())
    assert rings.corner_mark_centre_m == pattern.CORNER_MARK_CENTRE_M
    assert rings.ids() == tuple(range(15))


def test_ids_of_tags_are_those_of_their_corners():
    tags = KINDS["apriltags"](first_tag=3, rows=1, columns=2)
    assert tags.ids() == tuple(range(12, 20))


@pytest.mark.parametrize(
    ("kind", "values", "expected"),
    [
        ("rings", {"rows": 4, "columns": 4}, "not as many rows as columns"),
        ("rings", {"ring_outer_diameter_m": 0.2}, "ring_outer_diameter_m below"),
        ("rings", {"dot_diameter_m": 0.08}, "dot_diameter_m < ring_inner_diameter_m"),
        ("rings", {"rows": 1, "columns": 9}, "2 to 100 rows and columns, 6 rings or more"),
        ("dots", {"diameter_m": 0.07}, "diameter_m below spacing_m"),
        ("chessboard", {"rows": 3}, "4 to 100 rows and columns of squares"),
        ("charuco", {"rows": 2}, "3 to 100 rows"),
        ("dots", {"rows": 1}, "2 to 100 rows"),
        ("dots", {"columns": 1_000_000_000}, "found 7 rows and 1000000000 columns, expected 2 to 100"),
        ("rings", {"rows": 2, "columns": 2}, "6 rings or more, and not as many"),
        ("dots", {"known": True, "sigma_m": 1e-12}, "0.000001"),
        ("dots", {"known": True, "sigma_m": 1e9}, "less than or equal to 1"),
        ("charuco", {"marker_m": 0.09}, "marker_m below square_m"),
        ("charuco", {"rows": 12, "columns": 12}, "at most 50 white squares"),
        ("apriltags", {"tag_m": 0.2}, "tag_m below spacing_m"),
        ("apriltags", {"family": "25h9", "first_tag": 20}, "tag numbers below 35"),
    ],
)
def test_what_no_detector_could_find_is_refused(kind, values, expected):
    with pytest.raises(InputError, match=expected):
        KINDS[kind](**values)


def test_picture_shows_what_is_painted_last():
    shapes = (Rectangle(-0.02, -0.01, 0.02, 0.02, white=False), Disc(-0.01, 0.0, 0.006, white=True))
    white = Artwork(0.04, 0.02, shapes).picture(0.001, 0.002)
    assert white.shape == (24, 44)
    assert not white[3, 3]
    assert white[12, 11]
    assert white[:, 23:].all()
    assert white.mean() == pytest.approx(1 - (400 - np.pi * 9) / (24 * 44), abs=0.01)


@pytest.mark.parametrize(("rows", "columns", "n_ways"), [(7, 9, 2), (6, 9, 1), (9, 6, 1), (8, 8, 2), (7, 7, 4)])
def test_corners_of_a_chessboard_are_numbered_by_its_colours(rows, columns, n_ways):
    board = KINDS["chessboard"](rows=rows, columns=columns)
    assert len(board.symmetries()) == n_ways
    printed = (255 * board.artwork().picture(board.square_m / 12).astype(float)).clip(0, 255).astype(np.uint8)
    for turn in range(4):
        picture = np.ascontiguousarray(np.rot90(printed, turn))
        found = board.find(picture)
        place = found.place[np.argsort(found.row)]
        along, across = place[1] - place[0], place[columns - 1] - place[0]
        assert along[0] * across[1] > along[1] * across[0]  # not seen from behind
        u, v = np.rint(place[0] - (along + across) / 2).astype(int)
        assert picture[v, u] == 0
