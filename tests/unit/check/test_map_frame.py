import numpy as np
import pytest

from linepose.check.finding import Level
from linepose.check.map_frame import origin_findings
from linepose.config.map_frame import MapFrameSection

ORIGIN = MapFrameSection(origin=(-33.8902, 151.1937, 40.0))
UTM = MapFrameSection(crs="EPSG:32756")
NORTHINGS = np.array([[6_248_550.0, 332_965.0, -42.0], [6_248_551.0, 332_966.0, -42.0]])


@pytest.mark.parametrize(
    ("section", "position_m", "n_told"),
    [(None, NORTHINGS, 0), (UTM, NORTHINGS, 0), (ORIGIN, NORTHINGS - NORTHINGS[0], 0), (ORIGIN, NORTHINGS, 1)],
)
def test_northings_with_an_origin_are_told(section, position_m, n_told):
    findings = origin_findings(section, position_m)
    assert len(findings) == n_told
    for one in findings:
        assert one.level == Level.WARNING
        assert "map_frame.origin: positions 6249 km north" in one.found
        assert "write map_frame.crs" in one.advice
