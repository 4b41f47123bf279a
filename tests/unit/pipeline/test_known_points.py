"""Control points and ground, from a platform's files to what the adjustment takes; and what cannot be used is told."""

import logging
from dataclasses import replace

import numpy as np
import pytest
import rasterio
from pyproj import Transformer
from rasterio.transform import from_origin

from linepose.config.platform import Platform
from linepose.config.points import GroundSection
from linepose.errors import InputError
from linepose.geometry.rotations import euler_from_rotation_vector
from linepose.inputs.local_frame import geodetic_from_local, tangent_frame
from linepose.pipeline.known_points import known_of_survey, known_points
from linepose.simulation.flight import FlightSettings, simulate_flight
from linepose.survey.point_knowledge import knowledge_from_table, knowledge_table

FRAME = tangent_frame((-33.0, 151.0, 60.0))
UTM = "EPSG:32756"


@pytest.fixture(scope="module")
def flight():
    return simulate_flight(FlightSettings(n_points=12, relief_m=0.0), 3)


def platform(flight, target=None, **points):
    euler = np.rad2deg(euler_from_rotation_vector(flight.hand_pose[3:])).tolist()
    return Platform(
        camera=flight.camera,
        hand_measured={"position_m": flight.hand_pose[:3].tolist(), "euler_deg": euler},
        source={"kind": "labelled_views", "dataset": "flight"},
        points=points or None,
        **({} if target is None else {"target": target}),
    )


def on_map(position_m):
    """Easting, northing, height (K, 3) of places north, east, down in the survey's frame."""
    latitude, longitude, height = geodetic_from_local(FRAME, position_m).T
    return np.column_stack(
        [*Transformer.from_crs("EPSG:4326", UTM, always_xy=True).transform(longitude, latitude), height]
    )


def write_control(folder, places, header="id,easting_m,northing_m,height_m,sigma_m", sigma_m=0.02, names=None):
    names = names or [str(k) for k in range(len(places))]
    rows = [
        ",".join([name, *(f"{v:.4f}" for v in place), str(sigma_m)]) for name, place in zip(names, places, strict=True)
    ]
    (folder / "control.csv").write_text("\n".join([header, *rows]) + "\n")


def write_dem(folder, corner, heights, nodata=None):
    """A height model of cells of 2 m whose north-west corner is at easting, northing."""
    path = folder / "dem.tif"
    profile = {"driver": "GTiff", "height": heights.shape[0], "width": heights.shape[1], "count": 1}
    transform = from_origin(*corner, 2.0, 2.0)
    with rasterio.open(path, "w", dtype="float32", crs=UTM, transform=transform, nodata=nodata, **profile) as raster:
        raster.write(heights.astype("float32"), 1)


def told(flight, folder, **points):
    with pytest.raises(InputError) as error:
        known_points(platform(flight, **points), folder, flight.survey, FRAME)
    assert "\n" not in str(error.value)
    return str(error.value)


def test_control_points_of_a_map_lie_where_they_are(flight, tmp_path, caplog):
    write_control(tmp_path, [*on_map(flight.points_m[:5]), on_map(flight.points_m[:1])[0]], names=[*"01234", "church"])
    with caplog.at_level(logging.WARNING):
        known = known_points(platform(flight, control_points="control.csv", crs=UTM), tmp_path, flight.survey, FRAME)
    assert "1 of 6 points are in no scan" in caplog.text
    arrays = known_of_survey(knowledge_from_table(knowledge_table(known)), flight.survey)
    assert np.allclose(arrays.position_m[:5], flight.points_m[:5], atol=1e-3)
    assert np.allclose(arrays.information[:5], np.eye(3) / 0.02**2)
    assert np.all(arrays.information[5:] == 0)


def test_a_height_alone_and_the_surveys_own_axes(flight, tmp_path):
    (tmp_path / "control.csv").write_text(
        "id,north_m,east_m,down_m,sigma_horizontal_m,sigma_height_m\n2,,,0.5,,0.1\n3,1.0,2.0,0.25,0.5,0.1\n"
    )
    known = known_points(platform(flight, control_points="control.csv"), tmp_path, flight.survey, None)
    assert np.allclose(known["2"].information, np.diag([0, 0, 100.0]))
    assert known["2"].position_m[2] == 0.5
    assert np.allclose(np.diag(known["3"].information), [4.0, 4.0, 100.0])


@pytest.mark.parametrize(
    ("shift_m", "word"),
    [((60.0, 0.0, 0.0), " m east"), ((0.0, 0.0, 47.0), "height_offset_m"), ((-90.0, 180.0, 0.0), " m north")],
)
def test_control_points_of_another_datum_are_told(flight, tmp_path, shift_m, word):
    write_control(tmp_path, on_map(flight.points_m[:8]) + shift_m)
    message = told(flight, tmp_path, control_points="control.csv", crs=UTM)
    assert "of where the scans see them" in message
    assert word in message


@pytest.mark.parametrize(
    ("text", "word"),
    [
        ("id,easting_m,northing_m,height_m,sigma_m\n1,1,2,3,0.1\n1,4,5,6,0.1\n", "point 1 again"),
        ("id,easting_m,northing_m,height_m,sigma_m\n1,one,2,3,0.1\n", "'one'"),
        ("id,easting_m,northing_m,height_m\n1,1,2,3\n", "no sigmas"),
        ("id,x,y,z,sigma_m\n1,1,2,3,1\n", "easting_m"),
        ("id,latitude_deg,longitude_deg,height_m,sigma_m\n1,1,2,3,1\n", "easting_m, northing_m"),
        ("name,easting_m\n1,1\n", "id, coordinates and sigmas"),
        ("id,easting_m,northing_m,height_m,sigma_m\n1,1,2,,1\n", "a height"),
        ("id,easting_m,northing_m,height_m,sigma_m\n1,1,,3,1\n", "row 2: found easting_m without northing_m"),
        ("id,easting_m,northing_m,height_m,sigma_m\nx,400000,6000000,3,1\n", "points that the scans show"),
    ],
)
def test_tables_that_cannot_be_used(flight, tmp_path, text, word):
    (tmp_path / "control.csv").write_text(text)
    assert word in told(flight, tmp_path, control_points="control.csv", crs=UTM)


def test_a_system_needs_a_place_on_earth(flight, tmp_path):
    write_control(tmp_path, on_map(flight.points_m[:3]))
    with pytest.raises(InputError, match="add map_frame"):
        known_points(platform(flight, control_points="control.csv", crs=UTM), tmp_path, flight.survey, None)


def test_ground_of_one_height_counts_for_all_but_control_points(flight, tmp_path):
    write_control(tmp_path, on_map(flight.points_m[:3]))
    ground = {"height_m": 2.0, "sigma_m": 0.5, "shift_sigma_m": 1.0}
    asked = platform(flight, control_points="control.csv", crs=UTM, ground=ground)
    known = known_of_survey(known_points(asked, tmp_path, flight.survey, FRAME), flight.survey)
    assert known.shifts.tolist() == [0.0] * 3 + [1.0] * 9
    assert known.shift_sigma_m == 1.0
    assert np.allclose(known.information[5], np.diag([0, 0, 4.0]))
    assert known.position_m[5, 2] == -2.0


def test_a_height_model_gives_heights_and_slopes(flight, tmp_path):
    corner = on_map(np.array([[100.0, -100.0, 0.0]]))[0]
    east = 2.0 * np.arange(120)
    heights = 55.0 + np.tile(0.05 * east, (120, 1))
    write_dem(tmp_path, corner[:2], heights)
    asked = platform(flight, ground={"dem": "dem.tif", "sigma_m": 0.2, "shift_sigma_m": 0.5, "height_offset_m": 3.0})
    known = known_points(asked, tmp_path, flight.survey, FRAME)
    assert len(known) == 12
    for name, one in known.items():
        easting = on_map(one.position_m[None])[0, 0]
        height = 55.0 + 0.05 * (easting - corner[0] - 1.0) + 3.0
        assert -one.position_m[2] == pytest.approx(height - 60.0, abs=0.02), name
        # the grid of the map is turned a little against north
        assert np.allclose(one.information * 0.2**2, np.outer(*[[0.0, 0.05, 1.0]] * 2), atol=5e-3)


def test_a_height_model_with_holes_leaves_points_out_and_one_elsewhere_is_told(flight, tmp_path, caplog):
    corner = on_map(np.array([[100.0, -100.0, 0.0]]))[0]
    heights = np.full((120, 120), 60.0)
    beyond = np.quantile(on_map(flight.points_m)[:, 0], 0.75) - corner[0]
    heights[:, int(beyond / 2) :] = -9999.0
    write_dem(tmp_path, corner[:2], heights, nodata=-9999.0)
    ground = {"dem": "dem.tif", "sigma_m": 0.2}
    known = known_points(platform(flight, ground=ground), tmp_path, flight.survey, FRAME)
    assert 6 <= len(known) < 12
    assert "they count without" in caplog.text
    write_dem(tmp_path, corner[:2] + 5000.0, np.full((50, 50), 60.0))
    assert "no height for 12 of 12 points" in told(flight, tmp_path, ground=ground)
    (tmp_path / "dem.tif").write_text("no raster")
    assert "a raster of heights" in told(flight, tmp_path, ground=ground)


def test_the_section_is_closed_and_needs_the_adjustment(flight):
    with pytest.raises(InputError, match="found neither height_m nor dem, expected one of them"):
        GroundSection(sigma_m=1.0)
    values = platform(flight, ground={"height_m": 0.0, "sigma_m": 1.0}).model_dump() | {"noise_model": "published"}
    with pytest.raises(InputError, match="has no use for them"):
        Platform(**values)


CHESSBOARD = {"kind": "chessboard", "rows": 4, "columns": 5, "known": True, "sigma_m": 0.001}  # 12 corners


def test_a_known_target_s_points_have_places_in_its_frame(flight, tmp_path):
    asked = platform(flight, CHESSBOARD)
    known = known_points(asked, tmp_path, flight.survey, None)
    again = known_of_survey(knowledge_from_table(knowledge_table(known)), flight.survey)
    np.testing.assert_array_equal(again.board_m, asked.target.points())
    assert again.board_sigma_m == 0.001
    assert not again.any.any()


def test_a_known_target_stands_beside_control_points(flight, tmp_path):
    write_control(tmp_path, flight.points_m[:2], "id,north_m,east_m,down_m,sigma_m")
    known = known_points(platform(flight, CHESSBOARD, control_points="control.csv"), tmp_path, flight.survey, None)
    taken = known_of_survey(known, flight.survey)
    assert taken.apart.sum() == 2
    assert taken.on_board.all()


def test_points_without_a_target_have_no_place_in_its_frame(flight, tmp_path):
    write_control(tmp_path, flight.points_m[:2], "id,north_m,east_m,down_m,sigma_m")
    known = known_points(platform(flight, control_points="control.csv"), tmp_path, flight.survey, None)
    taken = known_of_survey(knowledge_from_table(knowledge_table(known)), flight.survey)
    assert not taken.on_board.any()


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"target": CHESSBOARD | {"sigma_m": None}}, "target.sigma_m: found nothing, expected .*; add sigma_m"),
        (
            {"target": CHESSBOARD, "noise_model": "published"},
            "found target.known with noise_model published.*; leave target.known out",
        ),
        (
            {
                "target": CHESSBOARD,
                "source": {"kind": "scans", "dataset": "x", "points": "matching", "matching": {"ground_height_m": 0.0}},
            },
            "found target.known with source.points matching.*; leave target.known out",
        ),
        ({"target": {"kind": "points", "known": True}}, r"target\.known: found an unknown key"),
    ],
)
def test_a_target_that_cannot_be_known_is_refused(flight, change, told):
    with pytest.raises(InputError, match=told):
        Platform(**platform(flight).model_dump() | change)


def test_tie_points_cannot_be_control_points(flight):
    source = {"kind": "scans", "dataset": "x", "points": "matching", "matching": {"ground_height_m": 0.0}}
    ground = {"height_m": 0.0, "sigma_m": 1.0}
    matched = platform(flight, ground=ground).model_dump() | {"source": source}
    assert Platform(**matched).points.ground.height_m == 0.0
    with pytest.raises(
        InputError, match=r"found points.control_points with source.points matching.*or label the points"
    ):
        Platform(**matched | {"points": {"control_points": "control.csv", "ground": ground}})


def test_a_known_target_of_other_ids_is_told(flight, tmp_path):
    names = np.array([f"stone {k}" for k in range(12)], dtype=object)
    with pytest.raises(InputError, match=r"target.known.*0 of its 12 points in the scans.*3 or more"):
        known_points(platform(flight, CHESSBOARD), tmp_path, replace(flight.survey, names=names), None)
