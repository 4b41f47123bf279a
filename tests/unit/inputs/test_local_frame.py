import re

import numpy as np
import pytest

from linepose.errors import InputError
from linepose.geometry import rotations
from linepose.inputs.local_frame import (
    check_geodetic,
    check_is_near,
    geodetic_from_local,
    local_from_geodetic,
    projected_frame,
    tangent_frame,
    utm_crs,
)
from unit.inputs import geodesy

WITHOUT_AREA = "+proj=webmerc +datum=WGS84 +units=m +type=crs"
ORIGINS = [(-33.8892, 151.1937, 42.5), (51.15, -114.03, 1080.0), (0.0, 179.9999, -20.0), (69.6, 18.9, 10.0)]


@pytest.fixture
def around():
    """Places within 2 km of an origin."""
    return np.random.default_rng(1).uniform(-1, 1, (20, 3)) * [0.018, 0.018, 100.0]


@pytest.mark.parametrize("origin", ORIGINS)
def test_tangent_plane_is_that_of_the_ellipsoid(around, origin):
    geodetic = np.array(origin) + around
    position, turn = local_from_geodetic(tangent_frame(origin), geodetic)
    expected = (geodesy.ecef(geodetic) - geodesy.ecef(np.array(origin))) @ geodesy.axes(np.array(origin))
    np.testing.assert_allclose(position, expected, atol=2e-8)
    from_there = np.swapaxes(geodesy.axes(np.array(origin))[None], -1, -2) @ geodesy.axes(geodetic)
    np.testing.assert_allclose(turn, from_there, atol=1e-14)
    np.testing.assert_allclose(position / [1, 1, 1], expected, atol=2e-8)  # distances are true: no scale


@pytest.mark.parametrize("origin", ORIGINS)
def test_back_to_latitude_and_longitude(around, origin):
    geodetic = np.array(origin) + around
    frames = [tangent_frame(origin), projected_frame(utm_crs(origin[0], origin[1]))]
    for frame in frames:
        back = geodetic_from_local(frame, local_from_geodetic(frame, geodetic)[0])
        back[:, 1] += 360 * np.rint((geodetic[:, 1] - back[:, 1]) / 360)
        np.testing.assert_allclose(back[:, :2], geodetic[:, :2], atol=1e-11)  # a micrometre
        np.testing.assert_allclose(back[:, 2], geodetic[:, 2], atol=1e-7)


def test_zone_of_utm():
    assert utm_crs(-33.9, 151.2) == "EPSG:32756"
    assert utm_crs(51.15, -114.03) == "EPSG:32611"
    assert utm_crs(1.0, 180.0) == utm_crs(1.0, -180.0) == "EPSG:32601"


def test_grid_north_is_turned_by_the_convergence():
    """A short step in a known true direction, mapped: its direction in the grid, and its length."""
    frame, start = projected_frame("EPSG:32756"), np.array([[-33.9, 150.3, 0.0]])
    heading = np.deg2rad(37.0)
    step = np.array([np.cos(heading), np.sin(heading), 0.0]) * 10.0
    end = geodesy.geodetic_of(geodesy.ecef(start) + step @ geodesy.axes(start[0]).T)
    (first,), turn = local_from_geodetic(frame, start)
    (last,), _ = local_from_geodetic(frame, end)
    grid = np.arctan2(last[1] - first[1], last[0] - first[0])
    convergence = heading - grid
    # textbook, to second order of the distance from the central meridian at 153 deg; west and south it is positive
    expected = np.arctan(np.tan(np.deg2rad(150.3 - 153.0)) * np.sin(np.deg2rad(-33.9)))
    assert convergence == pytest.approx(expected, abs=2e-5)
    assert rotations.euler_from_matrix(turn[0])[2] == pytest.approx(-convergence, abs=1e-6)
    assert np.hypot(*(last - first)[:2]) / 10.0 == pytest.approx(
        0.9996 * (1 + np.deg2rad(2.7) ** 2 * 0.69 / 2), abs=1e-5
    )


@pytest.mark.parametrize("crs", ["EPSG:4326", "EPSG:999999", "utm"])
def test_crs_must_be_projected(crs):
    with pytest.raises(InputError, match=r"found '.*', expected a projected CRS"):
        projected_frame(crs)


@pytest.mark.parametrize("row", [[91.0, 0.0, 0.0], [0.0, 400.0, 0.0], [np.nan, 0.0, 0.0], [0.0, 0.0, np.inf]])
def test_place_that_is_none_is_told(row):
    with pytest.raises(InputError, match=r"log, record 2: found latitude"):
        check_geodetic(np.array([[1.0, 2.0, 3.0], row]), "log")


def test_crs_in_feet_is_refused():
    with pytest.raises(InputError, match=r"'EPSG:2263', which counts in units of US survey foot, .* in metres"):
        projected_frame("EPSG:2263")


@pytest.mark.parametrize(
    ("crs", "latitude", "longitude", "near"),
    [
        ("EPSG:32756", -33.9, 151.2, True),
        ("EPSG:32756", -33.9, 146.0, False),
        ("EPSG:32633", -33.9, 151.2, False),
        ("EPSG:32660", 52.0, -179.0, True),  # across the date line
        ("EPSG:3857", 1.0, 170.0, True),
        ("EPSG:3413", 71.0, -45.0, True),
    ],
)
def test_crs_of_another_part_of_the_earth_is_told(crs, latitude, longitude, near):
    if near:
        check_is_near(projected_frame(crs), latitude, longitude, "source.navigation.crs")
    else:
        with pytest.raises(InputError, match=r"made for .*, with positions at -33\.90, .*such as EPSG:327"):
            check_is_near(projected_frame(crs), latitude, longitude, "source.navigation.crs")


@pytest.mark.parametrize(("crs", "scale"), [("EPSG:3857", "1.20"), ("EPSG:6933", "1.04"), (WITHOUT_AREA, "1.20")])
def test_crs_whose_metres_are_none_is_told(crs, scale):
    """Scales 1 / cos(33.9 deg) = 1.205 of Web Mercator, and cos(30 deg) / cos(33.9 deg) = 1.043 of equal areas."""
    told = rf"{re.escape(crs)}, in which a metre is {scale}\d m long at -33.90, .*such as EPSG:32756"
    with pytest.raises(InputError, match=told):
        check_is_near(projected_frame(crs), -33.9, 151.2, "source.navigation.crs")


@pytest.mark.parametrize(("longitude_deg", "told"), [(153.0, []), (156.0, []), (157.0, [1.0020574])])
def test_crs_whose_lengths_are_a_thousandth_off_is_told(caplog, longitude_deg, told):
    """On the equator UTM's scale is 0.9996 (1 + 1.00674 d^2 / 2 + 5 d^4 / 24) at d (rad) from its meridian."""
    check_is_near(projected_frame("EPSG:32756"), -0.1, longitude_deg, "source.navigation.crs")
    assert [record.args[2] for record in caplog.records] == [pytest.approx(scale, abs=1e-6) for scale in told]
