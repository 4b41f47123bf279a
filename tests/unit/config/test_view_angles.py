"""The CSV of view angles that a platform's file names."""

import os
from pathlib import Path

import numpy as np
import pytest
import yaml

from linepose.config.platform import Platform, camera_keys, load_platform, platform_faults
from linepose.config.view_angles import read_view_angles
from linepose.errors import InputError
from linepose.geometry.camera import normalised_from_pixel
from unit.made_up import PLATFORM

CONFIG = Path(__file__).parents[3] / "config"
ROWS = "pixel,across_deg,along_deg\n1,-2.0,0.1\n2,-1.0,0.0\n3,0.5,0.0\n4,2.0,0.1\n"
FALLING = "pixel,across_deg\n0,2\n1,1\n2,-1\n3,-2\n"


@pytest.fixture
def written(tmp_path):
    def write(rows=ROWS, **camera):
        (tmp_path / "angles.csv").write_text(rows, encoding="utf-8")
        values = PLATFORM | {
            "camera": {"view_angles": "angles.csv", "n_pixels": 4} | camera,
            "noise_model": "adjustment",
        }
        (tmp_path / "robot.yaml").write_text(yaml.safe_dump(values), encoding="utf-8")
        return tmp_path

    return write


def test_a_platform_has_the_table_beside_its_file(written):
    camera = load_platform(written(), "robot").intrinsics()
    assert camera.view_angles.pixel == (0, 1, 2, 3)  # counted from 1 in the file
    np.testing.assert_allclose(np.degrees(np.arctan(normalised_from_pixel(camera, [0, 1, 2, 3]))), [-2, -1, 0.5, 2])


def test_columns_are_found_by_name_and_comments_passed_over(written):
    folder = written("# a lens\nacross_deg, pixel\n-2.0,0\n\n-1.0,1\n0.5,2\n2.0,3\n")
    assert read_view_angles(folder / "angles.csv") == {"across_deg": [-2.0, -1.0, 0.5, 2.0], "pixel": [0, 1, 2, 3]}
    assert load_platform(folder, "robot").camera.view_angles.along_deg == ()


@pytest.mark.parametrize("sign", [";", "\t", "; ", "  "])
@pytest.mark.parametrize("decimal", [".", ","])
def test_other_signs_between_cells_and_a_decimal_comma_are_read(written, sign, decimal):
    folder = written("\n".join(row.replace(",", sign).replace(".", decimal) for row in ROWS.split("\n")))
    expected = {"pixel": [0, 1, 2, 3], "across_deg": [-2.0, -1.0, 0.5, 2.0], "along_deg": [0.1, 0.0, 0.0, 0.1]}
    assert read_view_angles(folder / "angles.csv") == expected


@pytest.mark.parametrize(
    ("rows", "camera", "found"),
    [
        (ROWS, {"view_angles": "other.csv"}, "other.csv: found no such file"),
        (ROWS, {"focal_length_m": 8e-3}, "found view_angles with focal_length_m, expected one of them"),
        (ROWS, {"principal_point_px": 2.0}, "found view_angles with principal_point_px"),
        ("pixel,angle\n0,1\n", {}, "heading: found pixel, angle, expected columns pixel, across_deg and perhaps along"),
        ("", {}, "heading: found nothing"),
        (ROWS + "5,3.0\n", {}, "line 6: found 2 cells, expected 3"),
        (ROWS + "5,3,0,0,1\n", {}, "line 6: found 5 cells, expected 3, .*put semicolons between cells where decimals"),
        (ROWS + "5,3.0,x\n", {}, "line 6, along_deg: found 'x', expected a number"),
        (ROWS + "5,nan,0.0\n", {}, "line 6, across_deg: found 'nan', expected a number"),
        (
            ROWS.replace("0.5", "-1.0"),
            {},
            "angles.csv, line 4, across_deg: found -1 after -1, expected angles that rise",
        ),
        (FALLING, {}, "line 3, across_deg: .*; turn all signs"),
        (ROWS + "3,3.0,0.0\n", {}, "angles.csv, line 6, pixel: found pixel 3 again, .*; remove one of its rows"),
        ("# a lens\n" + ROWS + "2.5,3,0\n", {}, "line 7, pixel: found pixel 2.5 after 4, .*; sort the rows by pixel"),
        (ROWS.replace("2.0,0.1", "133.0,0.1"), {}, "line 2, across_deg: found -133, .*1 mrad is 0.0573 deg"),
        (ROWS.replace("0.0\n", "90\n"), {}, "line 3, along_deg: found 90, expected angles between -89 and 89 deg"),
        ("pixel,across_deg\n0,-1\n1,0\n2,1\n", {}, "angles.csv: found 3 rows, expected 4 rows or more"),
        (ROWS, {"n_pixels": 5}, r"angles.csv: found 4 pixels \(0 to 3\), expected 5 pixels \(0 to 4\)"),
        (
            "pixel,across_deg\n1,-2\n5,-1\n9,0\n12,2\n",
            {"n_pixels": 12},
            r"found 12 pixels \(1 to 12\), expected 12 pixels \(0 to 11\), .*; count pixels from 0: subtract 1",
        ),
        ("pixel;across_deg\n0;-1.234,5\n", {}, "line 2, across_deg: found '-1.234,5', expected a number"),
        ("pixel,across_deg\n0;-1\n", {}, "line 2: found semicolons between cells, expected commas, as in the heading"),
        ("pixel,across_deg\n0;-1,5\n", {}, "line 2: found semicolons between cells, expected commas, as in the head"),
        ("pixel\tacross_deg\n0,-1\n", {}, "line 2: found commas between cells, expected tabs, as in the heading"),
        ("pixel across_deg\n0;-1\n", {}, "line 2: found semicolons between cells, expected blanks, as in the heading"),
        ("pixel;across_deg\n0  -1,5\n", {}, "line 2: found blanks between cells, expected semicolons, as in the he"),
        (ROWS, {"n_pixels": 3}, r"angles.csv: found 4 pixels \(0 to 3\), expected 3 pixels \(0 to 2\)"),
        (ROWS, {"view_angles": ""}, "camera.view_angles: found '', expected a CSV of view angles; name the file"),
        (ROWS, {"view_angles": "../"}, "found a folder, expected a CSV of view angles; correct camera.view_angles"),
        (ROWS, {"view_angles": "/dev/full"}, "/dev/full: found a device or pipe, expected a CSV of view angles"),
    ],
)
def test_what_is_no_table_is_told_in_one_line(written, rows, camera, found):
    with pytest.raises(InputError, match=found):
        load_platform(written(rows, **camera), "robot")


@pytest.mark.parametrize(("n_pixels", "first"), [(4, 0), (4, 1), (200, 0), (None, 1)])
def test_swapped_columns_are_told_as_such(tmp_path, n_pixels, first):
    """Few pixels lie within the bounds of angles, and are told by the width alone; many lie beyond them."""
    n_rows = n_pixels or 120
    angles = np.linspace(-10.05, 10.05, n_rows)
    rows = [f"{angle:.4f},{first + k}" for k, angle in enumerate(angles)]
    (tmp_path / "angles.csv").write_text("\n".join(["pixel,across_deg", *rows]))
    with pytest.raises(InputError, match=r"angles.csv, heading: .* columns are swapped: exchange the headings"):
        read_view_angles(tmp_path / "angles.csv", n_pixels)
    (tmp_path / "angles.csv").write_text("\n".join(["across_deg,pixel", *rows]))
    assert len(read_view_angles(tmp_path / "angles.csv", n_pixels)["pixel"]) == n_rows


def test_whole_degrees_are_no_swapped_pixels(tmp_path):
    (tmp_path / "angles.csv").write_text("pixel,across_deg\n0.5,0\n10.5,1\n20.5,2\n30.5,3\n")
    assert read_view_angles(tmp_path / "angles.csv")["across_deg"] == [0.0, 1.0, 2.0, 3.0]
    (tmp_path / "angles.csv").write_text("pixel,across_deg\n0,0\n10,1\n10,2\n30,3\n")
    with pytest.raises(InputError, match="found pixel 10 again"):
        read_view_angles(tmp_path / "angles.csv")


def test_a_bad_table_is_one_fault(written):
    (fault,) = platform_faults(written(FALLING), "robot")
    assert fault.place.endswith("angles.csv, line 3, across_deg")


def test_what_is_no_small_text_is_not_read(written):
    path = written() / "angles.csv"
    path.write_bytes(ROWS.encode("utf-16"))
    with pytest.raises(InputError, match=r"angles.csv: found bytes that are no text in UTF-8, .*; save it as UTF-8"):
        read_view_angles(path)
    path.unlink()
    os.mkfifo(path)
    with pytest.raises(InputError, match="found a device or pipe"):
        read_view_angles(path)
    path.unlink()
    with path.open("wb") as file:
        file.truncate(10**12)  # of no blocks
    with pytest.raises(InputError, match="found 1000000000000 bytes, expected a CSV of view angles, at most 10000000"):
        read_view_angles(path)


def test_a_platform_like_another_has_its_own_table_alone(written):
    folder = written()
    (folder / "narrow.csv").write_text("pixel,across_deg\n0,-1\n1,0\n2,1\n3,2\n")
    (folder / "other.yaml").write_text("like: robot\ncamera: {view_angles: narrow.csv}\n")
    assert load_platform(folder, "other").camera.view_angles.along_deg == ()
    assert camera_keys(folder, "other") == {"view_angles", "n_pixels"}
    (folder / "short.yaml").write_text("like: robot\ncamera: {n_pixels: 3}\n")
    with pytest.raises(InputError, match=r"angles.csv: found 4 pixels .*, expected 3 pixels"):
        load_platform(folder, "short")
    (folder / "wide.yaml").write_text("like: robot\ncamera: {principal_point_px: 2}\n")
    with pytest.raises(InputError, match=r"wide.yaml: camera: .*leave out principal_point_px \(null where `like`"):
        load_platform(folder, "wide")


def test_a_simulated_platform_may_have_another_camera_in_truth(written):
    given = load_platform(CONFIG / "platforms", "ladybird-sim").model_dump(mode="json")
    planted = Platform.model_validate(given | {"true_camera": {"smile": 0.02, "principal_point_px": 320.0}})
    assert planted.true_intrinsics() == planted.camera.replaced(smile=0.02, principal_point_px=320.0)
    assert Platform.model_validate(given).true_intrinsics() == planted.camera
    path = written() / "robot.yaml"
    path.write_text(path.read_text() + "true_camera: {smile: 0.02}\n")
    with pytest.raises(InputError, match="a simulation or a flight with true_camera"):
        load_platform(path.parent, "robot")


def test_the_paper_s_models_have_no_sigmas_of_other_coefficients(written):
    path = written(sigmas={"k3": 0.1}) / "robot.yaml"
    text = path.read_text().replace("noise_model: adjustment", "noise_model: published")
    path.write_text(text)
    (path.parent / "angles.csv").write_text(ROWS.replace("0.1\n", "0.0\n"))
    with pytest.raises(InputError, match="sigmas of k3 with noise_model published, which has none"):
        load_platform(path.parent, "robot")


def test_the_paper_s_models_take_no_bent_line(written):
    folder = written()
    path = folder / "robot.yaml"
    path.write_text(path.read_text().replace("noise_model: adjustment", "noise_model: published"))
    with pytest.raises(InputError, match="a line that is tilted or bent with noise_model published"):
        load_platform(folder, "robot")
