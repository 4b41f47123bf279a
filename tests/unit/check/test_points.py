"""Control points and ground before the points of the scans are known: their files, and the ground below the flight."""

import numpy as np
import pytest

from linepose.check.finding import Level
from linepose.check.points import file_findings
from linepose.config.platform import Platform, load_platform
from linepose.survey.navigation_log import NavigationLog
from unit.check.conftest import CONFIG
from unit.pipeline.test_tie_points import write_dem

HEADING = "id,north_m,east_m,down_m,sigma_m\n"
PLACE = np.array([6_248_550.0, 332_965.0, -82.0])


def log_of(position_m=PLACE):
    position = position_m + np.array([[0.0, 0.0, 0.0], [40.0, 0.0, 2.0], [80.0, 0.0, 1.0]])
    return NavigationLog(np.arange(3) * 1_000_000, position, np.zeros((3, 3)))


def told(folder, known, log=None, map_frame=None, **source):
    """Level and words of each finding on a platform whose points are found without labels."""
    given = load_platform(CONFIG / "platforms", "ladybird-sim").model_dump(mode="json")
    changed = {"noise_model": "adjustment", "points": known, "map_frame": map_frame}
    values = given | changed | {"source": given["source"] | {"points": "detection"} | source}
    findings = file_findings(Platform.model_validate(values), folder, log_of() if log is None else log)
    return [(one.level, f"{one.found}; {one.advice}") for one in findings]


@pytest.mark.parametrize(
    ("text", "level", "words"),
    [
        (None, Level.ERROR, "control.csv: no such file"),
        (f"{HEADING}3,1,2,3,0.01\n3,1,2,3,0.01\n", Level.ERROR, "row 3: point 3 again"),
        (f"{HEADING}3,1,2,3,0\n", Level.ERROR, "row 2: a place or sigma that is none"),
        (f"{HEADING}gate,1,2,3,0.01\n", Level.ERROR, "points gate, none of which is one of the rings; give them"),
        (f"{HEADING}3,1,2,3,0.01\ngate,1,2,3,0.01\n", Level.OK, "control.csv: 2 control points"),
    ],
)
def test_control_points_are_read_before_points_are_detected(tmp_path, text, level, words):
    if text is not None:
        (tmp_path / "control.csv").write_text(text)
    ((found, message),) = told(tmp_path, {"control_points": "control.csv"})
    assert found == level
    assert words in message


@pytest.mark.parametrize("height_m", [42.0, 420.0])
def test_ground_is_below_the_flight(tmp_path, height_m):
    matching = {"points": "matching", "matching": {"ground_height_m": height_m}}
    by_points = {"points": "matching", "matching": {"ground_height_m": None}}
    write_dem(tmp_path / "dem.tif", PLACE, height_m)
    model, crs = {"ground": {"dem": "dem.tif", "sigma_m": 1.0}}, {"crs": "EPSG:32756"}
    level = {"ground": {"height_m": height_m - 1.0, "height_offset_m": 1.0, "sigma_m": 1.0}}
    for findings, key in (
        (told(tmp_path, None, **matching), "source.matching.ground_height_m"),
        (told(tmp_path, level, **by_points), "points.ground"),
        (told(tmp_path, model, map_frame=crs, **by_points), "points.ground"),
    ):
        ((found, message),) = findings
        assert found == (Level.OK if height_m < 82.0 else Level.ERROR)
        assert message.startswith(f"{key}: ground at {height_m:.1f} m, ")
        assert ("up to 40.0 m below" if height_m < 82.0 else "highest pose is at 82.0 m; correct") in message


def test_a_height_model_that_is_not_there_or_elsewhere_is_told(tmp_path):
    crs, points = {"crs": "EPSG:32756"}, {"ground": {"dem": "dem.tif", "sigma_m": 1.0}}
    matching = {"points": "matching", "matching": {"ground_height_m": 42.0}}
    ((level, message),) = told(tmp_path, points, map_frame=crs)
    assert level == Level.ERROR
    assert "dem.tif: no such file" in message
    write_dem(tmp_path / "dem.tif", PLACE + np.array([5_000.0, 0.0, 0.0]), 42.0)
    for source in ({}, matching):
        level, message = told(tmp_path, points, map_frame=crs, **source)[0]
        assert level == Level.ERROR
        assert "no height below the log" in message
