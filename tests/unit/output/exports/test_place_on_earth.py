"""From a device's log of a known place to the map file, read back by another reader."""

import geopandas
import numpy as np
import pandas as pd
import pytest
from pyproj import Geod, Transformer

from linepose.config.platform import Platform
from linepose.experiments.mapping import PROJECTED_COLUMNS, PROJECTED_COVARIANCE_COLUMNS
from linepose.inputs import local_frame
from linepose.inputs.local_frame import MAP_FRAME, geodetic_from_local, local_from_geodetic, tangent_frame
from linepose.inputs.navigation import read_navigation
from linepose.pipeline.calibration import Calibration
from linepose.pipeline.survey_frame import map_frame_table
from linepose.survey.observations import POSITION_COLUMNS
from linepose.tables import write_table
from unit import made_up

CENTIMETRE = 0.01
PLACES = {"Sydney": (-33.9, 151.2, 40.0), "Calgary": (51.15, -114.03, 1080.0), "Quito": (-0.18, -78.47, 2850.0)}
COLUMNS = {"position": ["lat", "lon", "h"], "attitude": ["roll", "pitch", "yaw"]}
NAVIGATION = {
    "table": {"file": "log.csv", "columns": COLUMNS, "coordinates": "geodetic", "angle_unit": "degrees"},
    "sbet": {"file": "log.sbet", "gps_week": 1900},
    "resonon": {"file": "log.lcf"},
}


def write_log(folder, format, place):
    """A drive of 100 m to the north-east by a device of this format; latitude, longitude (deg), height (m) (11, 3)."""
    count = np.arange(11)
    geodetic = np.array(place) + count[:, None] * np.array([6e-5, 7e-5, 0.01])
    zeros = np.zeros(len(count))
    if format == "table":
        table = pd.DataFrame(geodetic, columns=["lat", "lon", "h"]).assign(roll=0.0, pitch=0.0, yaw=45.0)
        table.assign(time_us=1_466_000_000_000_000 + 1_000_000 * count).to_csv(folder / "log.csv", index=False)
    elif format == "sbet":
        angles = np.deg2rad(geodetic[:, :2])
        columns = [1000.0 + count, *angles.T, geodetic[:, 2], *[zeros] * 5, zeros + np.pi / 4, *[zeros] * 7]
        np.stack(columns, axis=-1).astype("<f8").tofile(folder / "log.sbet")
    else:
        lines = [
            f"{1149000000 + k}.0 0 0 0.785398 {longitude:.12f} {latitude:.12f} {height:.6f} 0 0 5 12"
            for k, (latitude, longitude, height) in zip(count, geodetic, strict=True)
        ]
        (folder / "log.lcf").write_text("\n".join(lines) + "\n")
    return geodetic


def write_points(folder, position_m):
    """Results whose mapped points are these positions north, east, down (K, 3)."""
    names = np.arange(len(position_m))
    estimated = pd.DataFrame(position_m, columns=list(POSITION_COLUMNS)).assign(stage="inliers", point=names)
    make, schema = made_up.TABLES["estimated_points"]
    covariances = [name for name in make() if name.startswith("covariance")]
    write_table(estimated.assign(**dict.fromkeys(covariances, 1e-6)), folder / "estimated_points.parquet", schema)
    projected = pd.DataFrame(position_m, columns=list(PROJECTED_COLUMNS)).assign(observation=1, point=names)
    projected = projected.assign(**dict.fromkeys(PROJECTED_COVARIANCE_COLUMNS, 1e-4))
    both = pd.concat([projected.assign(pose=name) for name in ("calibrated", "hand_measured")])
    write_table(both, folder / "mapping.parquet", made_up.TABLES["mapping"][1])


def apart_m(points, geodetic):
    """Distances (K,) and differences of height (K,) of points in WGS84 from latitude, longitude, height (K, 3)."""
    longitude, latitude, height = np.array([[point.x, point.y, point.z] for point in points.geometry]).T
    _, _, distance = Geod(ellps="WGS84").inv(longitude, latitude, geodetic[:, 1], geodetic[:, 0])
    return np.abs(distance), np.abs(height - geodetic[:, 2])


@pytest.mark.parametrize("place", PLACES.values(), ids=PLACES)
@pytest.mark.parametrize("format", NAVIGATION)
def test_a_log_s_places_come_back_from_the_map_files(tmp_path, format, place):
    geodetic = write_log(tmp_path, format, place)
    source = {"kind": "scans", "dataset": "own", "navigation": {"format": format, **NAVIGATION[format]}}
    platform = Platform.model_validate(made_up.PLATFORM | {"source": source})
    folder = tmp_path / "results" / "robot"
    write_table(map_frame_table(platform, tmp_path), folder / "map_frame.parquet", MAP_FRAME)
    write_points(folder, read_navigation(platform.source, tmp_path).log.position_m)
    local_frame._pipeline.cache_clear()  # the map is made by another process than the one that read the log
    for name in ("geojson", "geopackage"):
        path = Calibration.from_results(folder, platform).export(name, tmp_path)
        read = geopandas.read_file(path, **({"layer": "estimated_points"} if name == "geopackage" else {}))
        points = read[read["layer"] == "estimated_points"] if name == "geojson" else read
        distance, height = apart_m(points.to_crs(4979), geodetic)
        assert len(points) == len(geodetic)
        assert distance.max() < CENTIMETRE
        assert height.max() < CENTIMETRE
    # what was read first must not change what is read of the same place afterwards
    again = read_navigation(platform.source, tmp_path)
    np.testing.assert_allclose(geodetic_from_local(again.frame, again.log.position_m), geodetic, rtol=0, atol=1e-7)


def test_the_case_of_sydney(tmp_path):
    """Longitude 151.2, latitude -33.9; easting and northing as another program finds them."""
    write_log(tmp_path, "table", PLACES["Sydney"])
    source = {"kind": "scans", "dataset": "own", "navigation": {"format": "table", **NAVIGATION["table"]}}
    platform = Platform.model_validate(made_up.PLATFORM | {"source": source})
    folder = tmp_path / "results" / "robot"
    write_table(map_frame_table(platform, tmp_path), folder / "map_frame.parquet", MAP_FRAME)
    write_points(folder, np.zeros((1, 3)))
    local_frame._pipeline.cache_clear()
    points = geopandas.read_file(Calibration.from_results(folder, platform).export("geojson", tmp_path))
    assert (points.geometry.x[0], points.geometry.y[0]) == pytest.approx((151.2, -33.9), abs=1e-8)
    easting, northing = Transformer.from_crs(4326, 32756, always_xy=True).transform(151.2, -33.9)
    assert points.loc[0, ["easting_m", "northing_m"]].tolist() == pytest.approx([easting, northing], abs=CENTIMETRE)
    assert (round(easting, -3), round(northing, -3)) == (334000, 6247000)


@pytest.mark.parametrize("number", [float, np.float64, np.float32])
def test_an_origin_of_numpy_numbers_is_the_same_place(number):
    local_frame._pipeline.cache_clear()
    origin = tuple(number(value) for value in (12.5, 77.25, 900.0))
    position, _ = local_from_geodetic(tangent_frame(origin), [[12.5, 77.25, 900.0]])
    np.testing.assert_allclose(position, 0.0, atol=1e-6)
    np.testing.assert_allclose(geodetic_from_local(tangent_frame(origin), np.zeros((1, 3)))[0], origin, atol=1e-9)
