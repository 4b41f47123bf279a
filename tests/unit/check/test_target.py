import pytest

from linepose.check.finding import Level
from linepose.check.target import target_findings
from linepose.geometry.camera import Camera
from linepose.inputs.source import ScansSection
from linepose.survey.targets.charuco import CharucoSection
from linepose.survey.targets.chessboard import ChessboardSection
from linepose.survey.targets.points import PointsSection

CAMERA = Camera(focal_length_m=8e-3, pixel_pitch_m=8e-6, n_pixels=640, principal_point_px=319.5)


def source(range_m, points="detection"):
    return ScansSection(kind="scans", dataset="mine", points=points, target_range_m=range_m)


@pytest.mark.parametrize(("target", "farthest_m"), [(ChessboardSection(square_m=0.06), 12.0), (CharucoSection(), 2.9)])
def test_target_is_large_enough_up_to_where_its_details_take_their_pixels(target, farthest_m):
    (near,) = target_findings(target, CAMERA, source(0.99 * farthest_m))
    (far,) = target_findings(target, CAMERA, source(1.02 * farthest_m))
    assert (near.level, far.level) == (Level.OK, Level.ERROR)
    assert f"{farthest_m:.1f} m" in far.found


def test_nothing_is_said_of_what_is_not_known_or_not_sought():
    assert target_findings(ChessboardSection(), CAMERA, source(None)) == []
    assert target_findings(ChessboardSection(), CAMERA, source(50.0, "labels")) == []
    assert target_findings(PointsSection(), CAMERA, source(50.0)) == []
