"""Chessboards, markers and dots in raw scans of a ground vehicle, lying and standing, with the truth beside."""

import numpy as np
import pytest

from linepose.errors import InputError
from linepose.inputs.scans.scan_files import Scan
from linepose.inputs.targets.detectors import detector_of
from linepose.inputs.targets.rectified import RectifiedDetector
from linepose.survey.targets.apriltags import ApriltagsSection
from linepose.survey.targets.charuco import CharucoSection
from linepose.survey.targets.chessboard import ChessboardSection
from linepose.survey.targets.dots import DotsSection
from linepose.survey.targets.points import PointsSection
from unit.target_scans import hand_view, scan_of, survey_of

CHESSBOARD = ChessboardSection()
CHARUCO = CharucoSection.scaled(5, 7, 0.12)
TARGETS = {
    "chessboard": CHESSBOARD,
    "charuco": CHARUCO,
    "apriltags": ApriltagsSection.scaled(3, 4, 0.17),
    "dots": DotsSection(),
}
OPPOSITE = (18, 8)  # passes on either side of the target, one forwards of the other


def row_of(target, point):
    ids = {name: row for row, name in enumerate(target.ids())}
    return np.array([ids[one] for one in point.tolist()])


def errors_px(target, found, seen, way=None):
    """Errors (n, 2) of places along the scan line and across it, numbered in one of the ways that look alike."""
    row = row_of(target, found.point)
    row = row if way is None else way[row]
    error = found.position - seen.truth[row]
    return error * np.stack([np.ones(len(row)), seen.px_per_line[row]], axis=-1)


def way_meant(target, found, seen):
    ways = target.symmetries()
    return min(ways, key=lambda way: np.abs(errors_px(target, found, seen, way)).max())


@pytest.mark.parametrize("kind", TARGETS)
def test_every_point_of_a_lying_target_in_its_place_with_its_id(kind):
    target = TARGETS[kind]
    survey = survey_of(target, OPPOSITE)
    detector = RectifiedDetector(target, hand_view(survey))
    views = [(scan_of(survey, number), detector(scan_of(survey, number).scan)) for number in (1, 2)]
    ways = [way_meant(target, found, seen) for seen, found in views]
    np.testing.assert_array_equal(*ways)  # the same way round in both
    for seen, found in views:
        assert found.doubt == ""
        assert len(found.point) >= 0.9 * seen.visible.sum()
        error = errors_px(target, found, seen, ways[0])
        assert np.abs(error).max() < 0.4  # no id of a neighbour, which is 20 pixels away
        assert np.sqrt(np.mean(error**2)) < 0.15


def test_markers_too_small_to_be_read_are_found_beside_others_and_covered_ones_are_not():
    target = CharucoSection()  # cells of markers take three pixels
    survey = survey_of(target, OPPOSITE)
    seen = scan_of(survey, 1)
    found = RectifiedDetector(target, hand_view(survey))(seen.scan)
    assert len(found.point) == seen.visible.sum()
    assert np.abs(errors_px(target, found, seen)).max() < 0.4
    covered = seen.truth[:, 0] > np.quantile(seen.truth[:, 0], 0.7)
    light = seen.scan.intensity.copy()
    left = int(seen.truth[covered, 0].min()) - 3
    light[:, left:] = np.random.default_rng(0).normal(600, 60, light[:, left:].shape)
    found = RectifiedDetector(target, hand_view(survey))(Scan(light, seen.scan.time_us, "covered"))
    assert len(found.point) >= 0.8 * (~covered).sum()
    assert not covered[row_of(target, found.point)].any()
    assert np.abs(errors_px(target, found, seen)).max() < 0.4


def test_points_are_not_made_up_where_something_like_the_print_covers_the_board():
    target = CharucoSection()
    survey = survey_of(target, OPPOSITE)
    seen = scan_of(survey, 1)
    covered = seen.truth[:, 0] > np.quantile(seen.truth[:, 0], 0.6)
    light = seen.scan.intensity.copy()
    left = int(seen.truth[covered, 0].min()) - 3
    line, u = np.indices(light[:, left:].shape)  # squares half as wide as the board's
    light[:, left:] = np.where((line // 8 + u // 12) % 2, light.max(), light.min())
    found = RectifiedDetector(target, hand_view(survey))(Scan(light, seen.scan.time_us, "covered"))
    row = row_of(target, found.point)
    assert np.abs(errors_px(target, found, seen)[~covered[row]]).max() < 0.4
    assert covered[row].sum() <= 1  # that squares lie by chance as the board's corner


def test_standing_target():
    target = CHESSBOARD
    survey = survey_of(target, (16,), upright=True)
    seen = scan_of(survey, 1)
    found = RectifiedDetector(target, hand_view(survey))(seen.scan)
    assert len(found.point) >= 0.9 * seen.visible.sum()
    error = errors_px(target, found, seen, way_meant(target, found, seen))
    assert np.abs(error).max() < 0.4


def test_places_are_better_in_the_raw_scan_than_in_the_map():
    survey = survey_of(CHESSBOARD, OPPOSITE)
    seen = scan_of(survey, 1)
    rough, refined = (RectifiedDetector(CHESSBOARD, hand_view(survey), refines)(seen.scan) for refines in (False, True))
    way = way_meant(CHESSBOARD, refined, seen)
    rms = [np.sqrt(np.mean(errors_px(CHESSBOARD, one, seen, way) ** 2)) for one in (rough, refined)]
    assert rms[1] < rms[0]


def test_a_distance_that_is_a_quarter_off_is_enough():
    survey = survey_of(CHESSBOARD, OPPOSITE)
    seen = scan_of(survey, 1)
    range_m = np.linalg.norm([2.86, 0.65, 1.7])
    found = RectifiedDetector(CHESSBOARD, hand_view(survey, 1.25 * range_m))(seen.scan)
    assert len(found.point) == len(CHESSBOARD.points())


def test_lines_outside_the_log_are_left_out():
    survey = survey_of(CHESSBOARD, OPPOSITE)
    seen = scan_of(survey, 1)
    more = np.vstack([seen.scan.intensity[:9], seen.scan.intensity])
    early = seen.scan.time_us[0] - 10_000_000 + np.arange(9)  # before the log begins
    found = RectifiedDetector(CHESSBOARD, hand_view(survey))(
        Scan(more, np.concatenate([early, seen.scan.time_us]), "scan")
    )
    shifted = RectifiedDetector(CHESSBOARD, hand_view(survey))(seen.scan)
    np.testing.assert_allclose(found.line, shifted.line + 9)
    late = Scan(seen.scan.intensity, seen.scan.time_us + 10**12, "late")
    with pytest.raises(InputError, match=r"late: found lines from .*, expected lines within the navigation log"):
        RectifiedDetector(CHESSBOARD, hand_view(survey))(late)


def test_rows_taken_for_columns_are_told():
    survey = survey_of(CHARUCO, OPPOSITE)
    wrong = CHARUCO.model_copy(update={"rows": CHARUCO.columns, "columns": CHARUCO.rows})
    found = RectifiedDetector(wrong, hand_view(survey, 3.4))(scan_of(survey, 1).scan)
    assert len(found.point) == 0
    assert found.remedy.startswith("exchange target.rows and target.columns")
    # corners alone look alike with rows and columns exchanged, and their ids say nothing of it
    chess = ChessboardSection(rows=9, columns=7)
    survey = survey_of(CHESSBOARD, OPPOSITE)
    assert len(RectifiedDetector(chess, hand_view(survey))(scan_of(survey, 1).scan).point) == len(chess.points())


def test_ground_alone_has_no_target_and_one_too_small_is_told():
    survey = survey_of(CHESSBOARD, OPPOSITE)
    ground = scan_of(survey, 1).scan
    light = np.random.default_rng(0).uniform(400, 900, ground.intensity.shape).astype(np.float32)
    empty = Scan(light, ground.time_us, "empty")
    found = RectifiedDetector(CHESSBOARD, hand_view(survey, 3.0))(empty)
    assert "no chessboard that is large enough (square_m takes 5 pixels up to 13.3 m away)" in found.doubt
    found = RectifiedDetector(CHESSBOARD, hand_view(survey, 30.0))(empty)
    assert "too small to be seen from 30 m" in found.doubt
    assert not found.board_found


def test_what_has_no_pattern_is_not_sought():
    with pytest.raises(InputError, match=r"target.kind: found points.*set source.points: labels"):
        detector_of(PointsSection(), "centroid", lambda: pytest.fail("not asked for"))
