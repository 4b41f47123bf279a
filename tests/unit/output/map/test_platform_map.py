"""A whole platform on the map: what the places of its pixels rest on."""

import numpy as np
import pandas as pd
import pytest

from linepose.geometry.camera import rays
from linepose.geometry.rotations import matrix_from_euler
from linepose.output.map.budget import ALL, AS_REPORTED
from linepose.output.map.platform_map import files_of, platform_map, write_maps
from linepose.output.map.sources import SOURCES
from linepose.output.map.tables import MAP_TABLES, map_tables
from linepose.pipeline.calibration import HAND_MEASURED, Calibration
from linepose.tables import read_table, write_table
from unit import made_up
from unit.output.map.adjusted_platform import HEIGHT_M, adjusted_calibration, adjusted_scans

PIXELS = np.array([0, 323, 647])


@pytest.fixture(scope="module")
def adjusted(tmp_path_factory):
    folder = tmp_path_factory.mktemp("adjusted")
    platform, data = adjusted_scans(folder)
    return adjusted_calibration(platform, folder / "results", data), data


def on_the_ground(camera, calibration, scan, line):
    """Easting, northing, height (3, P) of pixels of a line, by the camera model in plain numpy."""
    position, euler, _ = scan.bodies(line, line + 1)
    turn = calibration.matrix[:3, :3]
    centre, direction = rays(camera, turn, calibration.pose[:3], matrix_from_euler(euler)[0], position[0], PIXELS)
    reach = (-HEIGHT_M - centre[2]) / direction[:, 2]
    return ((centre + reach[:, None] * direction)[:, [1, 0, 2]] * [1, 1, -1]).T


def test_pixels_lie_where_the_adjusted_camera_puts_them(adjusted):
    calibration, data = adjusted
    section = calibration.platform_file.map
    scan = platform_map(calibration, section, data).scan_on_map(1)
    line = scan.shape[0] // 2
    found = scan.places(line, line + 1).place_m[0][:, PIXELS]
    pair = made_up.TABLES["adjusted_intrinsics"][0]().set_index("parameter")["value"]
    both = {name: float(pair[name]) for name in ("principal_point_px", "focal_length_m")}
    given = calibration.platform_file.intrinsics()
    np.testing.assert_allclose(found, on_the_ground(given.replaced(**both), calibration, scan, line), rtol=0, atol=1e-8)
    by_file = on_the_ground(given, calibration, scan, line)
    assert np.all(np.linalg.norm((found - by_file)[:2], axis=0) > 0.005)  # four pixels, two metres away


def test_the_hand_measured_pose_keeps_the_camera_of_the_file(adjusted):
    calibration, data = adjusted
    by_hand = Calibration.from_results(
        calibration.results.folder, calibration.platform_file, stage=HAND_MEASURED, data_folder=data
    )
    scan = platform_map(by_hand, calibration.platform_file.map, data).scan_on_map(1)
    assert scan.mounted.camera == calibration.platform_file.intrinsics()
    assert scan.mounted.intrinsics is None


def test_tables_hold_the_budget_and_the_counts_whether_made_now_or_before(adjusted, tmp_path):
    calibration, data = adjusted
    section = calibration.platform_file.map.model_copy(update={"cell_m": 0.05})
    maps = platform_map(calibration, section, data)
    made, again = (list(write_maps(maps, tmp_path / "map", cores)) for cores in (2, 1))
    assert [one.is_new for one in (*made, *again)] == [True, False]
    first, second = map_tables(made), map_tables(again)
    for name, schema in MAP_TABLES.items():
        pd.testing.assert_frame_equal(first[name], second[name])
        write_table(first[name], tmp_path / f"{name}.parquet", schema)
        pd.testing.assert_frame_equal(read_table(tmp_path / f"{name}.parquet", schema), first[name])
    row = first["map_scans"].iloc[0]
    lines, pixels = maps.scan_on_map(1).shape
    assert (row["scan"], row["n_pixels"], row["cell_m"]) == ("observation-01", lines * pixels, 0.05)
    assert row["n_cells"] > 0
    assert set(first["map_budget"]["source"]) == {*SOURCES, AS_REPORTED, ALL}
    assert {path.name for path in (tmp_path / "map").iterdir()} == set(files_of(made[0]))


def test_a_scan_that_is_done_is_made_again_where_its_intrinsics_are_others(adjusted, tmp_path):
    calibration, data = adjusted
    section = calibration.platform_file.map.model_copy(update={"cell_m": 0.05})
    maps = platform_map(calibration, section, data)
    assert [one.is_new for one in write_maps(maps, tmp_path)] == [True]
    assert [one.is_new for one in write_maps(maps, tmp_path)] == [False]
    by_file = Calibration.from_results(calibration.results.folder, calibration.platform_file, data_folder=data)
    wider = made_up.TABLES["adjusted_intrinsics"][0]()
    wider.loc[0, "covariance_with_principal_point_px"] *= 4
    by_file.results.in_memory["adjusted_intrinsics"] = wider
    assert [one.is_new for one in write_maps(platform_map(by_file, section, data), tmp_path)] == [True]
