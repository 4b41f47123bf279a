"""Mapped points read back by GDAL, through geopandas and pyogrio."""

import json

import geopandas
import numpy as np
import pyogrio
import pytest
from pyproj import Geod, Transformer

from linepose.errors import InputError
from linepose.output.exports.map_frame import tangent_map
from linepose.output.exports.points import MAP_COLUMNS
from linepose.tables import write_table
from unit import made_up

LAYERS = ["estimated_points", "projected_calibrated", "projected_hand_measured"]
SYDNEY = (-33.8902, 151.1937, 40.0)


def coordinates(table):
    return np.array([[point.x, point.y, point.z] for point in table.geometry])


def east_north_up(table, columns=("north_m", "east_m", "down_m")):
    north, east, down = table[list(columns)].to_numpy().T
    return np.stack([east, north, -down], axis=-1)


def test_geopackage_is_in_the_survey_s_system(made, tmp_path):
    path = made.export("geopackage", tmp_path / "points.gpkg")
    assert pyogrio.list_layers(path)[:, 0].tolist() == LAYERS
    estimated = geopandas.read_file(path, layer="estimated_points")
    assert estimated.crs.to_epsg() == 32756
    np.testing.assert_allclose(coordinates(estimated), east_north_up(made_up.estimated_points()), rtol=0, atol=1e-9)
    np.testing.assert_allclose(estimated["sigma_height_m"], 1e-3, rtol=1e-9)
    calibrated = geopandas.read_file(path, layer="projected_calibrated")
    expected = made_up.mapping().query("pose == 'calibrated'")
    np.testing.assert_allclose(coordinates(calibrated), east_north_up(expected), rtol=0, atol=1e-9)
    assert calibrated["observation"].tolist() == expected["observation"].tolist()
    np.testing.assert_allclose(calibrated[["sigma_easting_m", "sigma_northing_m"]], 0.02, rtol=1e-9)
    np.testing.assert_allclose(calibrated["sigma_height_m"], 0.0, atol=1e-12)


def test_geojson_is_rfc_7946(made, tmp_path):
    path = made.export("geojson", tmp_path / "points.geojson")
    raw = json.loads(path.read_text())
    assert set(raw) == {"type", "features"}  # a `crs` member is what RFC 7946 removed
    read = geopandas.read_file(path)
    assert read.crs.to_epsg() == 4979
    estimated = read[read["layer"] == "estimated_points"]
    expected = east_north_up(made_up.estimated_points())
    to_wgs84 = Transformer.from_crs(32756, 4326, always_xy=True)
    longitude, latitude = to_wgs84.transform(*expected[:, :2].T)
    np.testing.assert_allclose(coordinates(estimated)[:, :2], np.stack([longitude, latitude], axis=-1), atol=1e-9)
    np.testing.assert_allclose(coordinates(estimated)[:, 2], expected[:, 2], atol=1e-9)
    np.testing.assert_allclose(estimated[list(MAP_COLUMNS)], expected, rtol=0, atol=1e-9)
    assert read["layer"].unique().tolist() == LAYERS
    assert 151.1 < longitude[0] < 151.3
    assert -34.0 < latitude[0] < -33.8


def test_same_points_are_the_same_bytes(made, tmp_path):
    for format in ("geopackage", "geojson"):
        first, second = (made.export(format, tmp_path / f"{k}").read_bytes() for k in range(2))
        assert first == second


def test_local_points_are_as_far_apart_on_the_earth_as_in_the_survey():
    """Distances and directions on the ellipsoid, by another way: geodesics."""
    frame = tangent_map(SYDNEY, "x.yaml: map_frame.origin")
    north_east_down = np.array([[0.0, 0.0, 0.0], [100.0, 0.0, 0.0], [0.0, 100.0, 0.0], [0.0, 0.0, -10.0]])
    places = frame.wgs84(frame.places(north_east_down))
    # a double of 6e6 m, as they stand between, has steps of 1e-9 m
    np.testing.assert_allclose(places[0], [SYDNEY[1], SYDNEY[0], SYDNEY[2]], rtol=0, atol=1e-8)
    azimuth, _, distance = Geod(ellps="WGS84").inv(
        np.full(3, SYDNEY[1]), np.full(3, SYDNEY[0]), places[1:, 0], places[1:, 1]
    )
    # geodesics lie on the ellipsoid, 40 m below: shorter by 40 m in 6370 km, 0.6 mm in 100 m
    np.testing.assert_allclose(distance, [100.0, 100.0, 0.0], atol=1e-3)
    np.testing.assert_allclose(azimuth[:2], [0.0, 90.0], atol=1e-3)
    # the plane leaves the ellipsoid: 100^2 / (2 x 6.36e6) m = 0.8 mm
    np.testing.assert_allclose(places[1:, 2], [40.00079, 40.00079, 50.0], atol=2e-5)


def test_local_covariance_turns_with_the_meridian_convergence():
    frame = tangent_map(SYDNEY, "x.yaml: map_frame.origin")
    covariance = np.diag([4.0, 1.0, 9.0])[None]  # north, east, down
    turned = frame.covariances(np.zeros((1, 3)), covariance)[0]
    factors = frame.crs  # grid north is west of true north by (151.1937 - 153) sin(latitude) deg
    convergence = np.arctan(np.tan(np.radians(SYDNEY[1] - 153.0)) * np.sin(np.radians(SYDNEY[0])))
    assert factors.to_epsg() == 32756
    rotation = np.array([[np.cos(convergence), -np.sin(convergence)], [np.sin(convergence), np.cos(convergence)]])
    expected = rotation @ np.diag([1.0, 4.0]) @ rotation.T  # easting, northing
    np.testing.assert_allclose(turned[:2, :2], expected, atol=0.01)  # scale 0.9996, squared
    assert turned[0, 1] == pytest.approx(expected[0, 1], abs=1e-3)
    assert abs(expected[0, 1]) > 0.05


def test_points_of_a_local_survey_land_on_their_place(made, tmp_path):
    """Made-up points brought to their local origin, and back to where the made-up map has them."""
    utm = Transformer.from_crs(32756, 4979, always_xy=True)
    north, east, down = made_up.ORIGIN
    longitude, latitude, height = utm.transform(east, north, -down)
    for name in ("estimated_points", "mapping"):
        make, schema = made_up.TABLES[name]
        local = make()
        local[["north_m", "east_m", "down_m"]] -= made_up.ORIGIN
        write_table(local, tmp_path / "made-up" / f"{name}.parquet", schema)
    made.results = tmp_path
    made.platform = made_up.platform(map_frame={"origin": (latitude, longitude, height)})
    read = geopandas.read_file(made.export("geopackage", tmp_path / "points.gpkg"), layer="estimated_points")
    assert read.crs.to_epsg() == 32756
    expected = east_north_up(made_up.estimated_points())
    # grid north is 1 deg off true north there, and points are 0.36 m from the origin
    np.testing.assert_allclose(coordinates(read), expected, atol=0.36 * np.radians(1.1))
    turned = (coordinates(read) - expected)[:, :2]
    assert np.linalg.norm(turned, axis=1) == pytest.approx(0.36 * np.radians(1.0), rel=0.03)


def test_northings_are_not_taken_as_metres_from_an_origin(made, tmp_path):
    made.platform = made_up.platform(map_frame={"origin": (-33.8902, 151.1937, 40.0)})
    for format in ("geopackage", "geojson"):
        with pytest.raises(
            InputError, match=r"map_frame.origin: found positions .* km north.*write map_frame.crs: EPSG"
        ):
            made.export(format, tmp_path / "points")
