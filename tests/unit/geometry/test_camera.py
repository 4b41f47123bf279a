import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from linepose.errors import InputError
from linepose.geometry.camera import (
    Camera,
    carried_onto_line,
    normalised_from_pixel,
    off_line,
    pixel_directions,
    pixel_from_normalised,
    rays,
)
from linepose.settings import faults_of

SIZE = {"n_pixels": 2000, "principal_point_px": 999.5}
TABLE = {"pixel": [0, 600, 1300, 1999], "across_deg": [-20.0, -8.0, 6.0, 21.0], "along_deg": [0.1, 0.0, 0.0, 0.1]}

MILLIMETRES = {"focal_length_m": 8e-3, "pixel_pitch_m": 8e-6}


def test_focal_length_counts_pixels(camera):
    assert camera.focal_length_px == 8e-3 / 8e-6


def test_a_field_of_view_tells_the_focal_length():
    """Of 90 deg half the line is as wide as the focal length is long, whatever the pitch."""
    for pitch in ({}, {"pixel_pitch_m": 8e-6}):
        camera = Camera(field_of_view_deg=90, **SIZE, **pitch)
        assert camera.focal_length_px == pytest.approx(1000, rel=1e-14)
        assert camera.sigmas.focal_length_m == pytest.approx(0.01 * camera.focal_length_m)
        ends = np.degrees(np.arctan(normalised_from_pixel(camera, [-0.5, 1999.5])))
        np.testing.assert_allclose(ends, [-45, 45])


def test_the_sigma_of_a_field_of_view_is_one_of_the_focal_length():
    camera = Camera(field_of_view_deg=40, sigmas={"field_of_view_deg": 0.1}, **SIZE)
    wider = Camera(field_of_view_deg=40.001, **SIZE)
    by_deg = (camera.focal_length_m - wider.focal_length_m) / 0.001
    assert camera.sigmas.focal_length_m == pytest.approx(0.1 * by_deg, rel=1e-4)


def test_a_table_tells_focal_length_and_principal_point():
    camera = Camera(view_angles=TABLE, n_pixels=2000)
    np.testing.assert_allclose(normalised_from_pixel(camera, camera.principal_point_px), 0, atol=1e-15)
    x = np.tan(np.deg2rad(TABLE["across_deg"]))
    np.testing.assert_allclose(normalised_from_pixel(camera, TABLE["pixel"]), x, rtol=1e-13)
    np.testing.assert_allclose(pixel_directions(camera, [0, 1999])[:, 1], np.tan(np.deg2rad(0.1)), rtol=1e-13)
    assert camera.focal_length_px == pytest.approx(1999 / (x[-1] - x[0]))


def test_a_camera_told_by_angles_is_read_back_as_it_is():
    for camera in (Camera(view_angles=TABLE, n_pixels=2000), Camera(field_of_view_deg=50, **SIZE)):
        assert Camera.model_validate(camera.model_dump(mode="json")) == camera
        assert camera.replaced(k1=0.1).replaced(k1=0.0) == camera


@pytest.mark.parametrize(
    ("values", "found"),
    [
        (
            {"field_of_view_deg": 40, "focal_length_m": 8e-3},
            "found focal_length_m and field_of_view_deg, expected one of them",
        ),
        (
            {"field_of_view_deg": 40, "view_angles": TABLE},
            "found field_of_view_deg and view_angles, expected one of them",
        ),
        ({"field_of_view_deg": 180}, "field_of_view_deg: found 180, expected less than or equal to 179"),
        ({"field_of_view_deg": "34 deg"}, "field_of_view_deg: found '34 deg', expected a valid number"),
        ({"field_of_view_deg": [34]}, r"field_of_view_deg: found \[34\], expected a valid number"),
        ({"field_of_view_deg": "3_4"}, "field_of_view_deg: found '3_4'"),
        ({"field_of_view_deg": 1e-9}, "field_of_view_deg: found 1e-09, expected greater than or equal to 0.01"),
        ({"field_of_view_deg": 34, "pixel_pitch_m": "x"}, "pixel_pitch_m: found 'x'"),
        (
            {"field_of_view_deg": 34, "sigmas": {"field_of_view_deg": 0}},
            "sigmas.field_of_view_deg: found 0, expected gr",
        ),
        ({"view_angles": "angles.csv"}, "view_angles: found 'angles.csv', expected keys and values"),
        ({**MILLIMETRES, "smile": 1e300}, r"smile: found 1e\+300, expected less than or equal to 1000000"),
        *(
            (
                {**MILLIMETRES, "sigmas": {name: 1e9}},
                f"sigmas.{name}: found 1000000000.0, expected less than or equal to",
            )
            for name in ("k1", "k3", "p2", "tilt", "smile")
        ),
        ({**MILLIMETRES, "sigmas": {"k1": 1e-300}}, "sigmas.k1: found 1e-300, expected 0, or 1e-15 and more"),
        (
            {"field_of_view_deg": 40, "sigmas": {"focal_length_m": 1e-4}},
            "sigmas.focal_length_m: found a sigma in metres .* told by field_of_view_deg, expected .* for 1 % of",
        ),
        ({"field_of_view_deg": True}, "field_of_view_deg: found True"),
        ({}, "focal_length_m: found nothing"),
        (
            {"view_angles": TABLE | {"across_deg": [3.0, 2.0, 1.0, 0.0]}},
            "^Camera: view_angles.across_deg: found 2 after 3 in row 2, expected angles that rise .*; turn all signs$",
        ),
        ({"view_angles": TABLE | {"pixel": [0, 600, 500, 1999]}}, "pixels that rise from row to row"),
        (
            {"view_angles": TABLE | {"along_deg": [0.0]}},
            "along_deg: found 1 values, expected 4, as many angles as pixels",
        ),
        (
            {"view_angles": TABLE | {"pixel": [1, 600, 1300, 1999]}},
            r"view_angles: found 1999 pixels \(1 to 1999\), expected 2000 pixels",
        ),
        ({"view_angles": TABLE, "n_pixels": 1300}, "found 2000 pixels .*, expected 1300 pixels"),
        ({"view_angles": TABLE | {"along_deg": [0.0, 0.0, 90.0, 0.0]}}, "along_deg: found 90 in row 3"),
        (
            {"field_of_view_deg": 40, "sigmas": {"focal_length_m": 1e-5, "field_of_view_deg": 1}},
            "sigmas: found focal_length_m and field_of_view_deg, expected one of them",
        ),
    ],
)
def test_a_camera_that_is_told_twice_or_wrongly_is_refused(values, found):
    with pytest.raises(InputError, match=found):
        Camera(**SIZE | values)


@pytest.mark.parametrize(
    ("values", "keys"),
    [
        ({"view_angles": TABLE | {"across_deg": [3.0, 2.0, 1.0, 0.0]}}, ["view_angles"]),
        ({"field_of_view_deg": "34 deg", "principal_point_px": 9.0}, ["field_of_view_deg"]),
        ({"field_of_view_deg": 34, "principal_point_px": 9.0, "n_pixels": 0}, ["n_pixels"]),
        ({"field_of_view_deg": 34, "sigmas": {"field_of_view_deg": -1}}, ["principal_point_px", "sigmas"]),
        (
            {
                "field_of_view_deg": 34,
                "principal_point_px": 9.0,
                "sigmas": {"field_of_view_deg": 0, "focal_length_m": None},
            },
            ["sigmas"],
        ),
    ],
)
def test_a_fault_of_what_tells_the_scale_is_told_once(values, keys):
    faults = faults_of(Camera, {"n_pixels": 2000} | values, "robot")
    assert [one.place.removeprefix("robot: ").split(".")[0] for one in faults] == keys


def test_the_narrowest_and_widest_field_and_finest_sigma_make_a_camera():
    for field_deg, n_pixels in ((0.01, 1_000_000), (179, 1)):
        camera = Camera(
            field_of_view_deg=field_deg,
            n_pixels=n_pixels,
            principal_point_px=0.0,
            pixel_pitch_m=1e-9 if n_pixels == 1 else 0.1,
        )
        assert 2 * np.degrees(np.arctan(n_pixels / 2 / camera.focal_length_px)) == pytest.approx(field_deg)


def test_points_are_carried_onto_a_bent_line(camera):
    bent = camera.replaced(tilt=0.01, smile=0.05)
    points = np.array([[0.5, 0.4, 2.0], [-0.6, -0.3, 1.5], [0.0, 0.1, 3.0]])
    ahead = np.array([0.1, 0.9, -0.2])
    step, at = carried_onto_line(bent, points, ahead)
    np.testing.assert_allclose(at, points - step[:, None] * ahead, rtol=1e-15)
    x = at[:, 0] / at[:, 2]
    np.testing.assert_allclose(at[:, 1] / at[:, 2], 0.01 * x + 0.05 * x**2, atol=1e-13)
    np.testing.assert_allclose(off_line(bent, at), 0, atol=1e-12)


def test_a_mirrored_camera_sees_the_same_from_the_other_end(camera):
    for one in (camera.replaced(p2=0.01, tilt=0.02, smile=0.03), Camera(view_angles=TABLE, n_pixels=2000, p2=0.01)):
        u = np.array([0.0, 17.5, one.n_pixels - 1])
        turned = pixel_directions(one.mirrored(), one.n_pixels - 1 - u)
        np.testing.assert_allclose(turned * [-1, -1, 1], pixel_directions(one, u), atol=1e-14)


def test_pixels_of_an_ideal_camera(camera):
    ideal = camera.replaced(k1=0.0, k2=0.0)
    assert normalised_from_pixel(ideal, 320.5) == 0.0
    np.testing.assert_allclose(normalised_from_pixel(ideal, 420.5), 0.1, rtol=1e-15)
    np.testing.assert_allclose(pixel_from_normalised(ideal, normalised_from_pixel(ideal, [0.0, 639.0])), [0.0, 639.0])


def test_pixels_of_a_distorted_camera(camera):
    pixel = pixel_from_normalised(camera, 0.2)
    assert pixel == pytest.approx((0.2 + camera.k1 * 0.008 + camera.k2 * 0.00032) * 1000 + 320.5, rel=1e-15)
    np.testing.assert_allclose(normalised_from_pixel(camera, pixel), 0.2, rtol=1e-14)


def test_every_ray_passes_through_its_point(camera, survey, true_pose, true_points):
    body = Rotation.from_euler("ZYX", survey.euler_rad[..., ::-1].reshape(-1, 3)).as_matrix().reshape(8, 4, 3, 3)
    r_bc = Rotation.from_rotvec(true_pose[3:]).as_matrix()
    centres, directions = rays(camera, r_bc, true_pose[:3], body, survey.position_m, survey.u_px)
    distance = np.linalg.norm(np.cross(true_points - centres, directions), axis=-1) / np.linalg.norm(
        directions, axis=-1
    )
    assert distance.max() < 1e-12  # rounding of metres
    assert np.all(np.sum((true_points - centres) * directions, axis=-1) > 0)


def test_ray_of_one_pixel(camera):
    ideal = camera.replaced(k1=0.0, k2=0.0)
    yawed = Rotation.from_euler("z", 90, degrees=True).as_matrix()
    centre, direction = rays(ideal, np.eye(3), [1.0, 0.0, -0.5], yawed, [10.0, 20.0, 0.0], 420.5)
    np.testing.assert_allclose(centre, [10.0, 21.0, -0.5], atol=1e-15)
    np.testing.assert_allclose(direction, [0.0, 0.1, 1.0], atol=1e-15)


def test_a_bad_table_of_angles_is_one_fault_and_not_the_lack_of_what_it_tells():
    table = TABLE | {"across_deg": [0.0, 1.0, 0.5, 2.0]}
    (fault,) = faults_of(Camera, {"view_angles": table, "n_pixels": 2000}, "mine.yaml")
    assert str(fault).startswith("mine.yaml: view_angles.across_deg: found 0.5 after 1")
    (fault,) = faults_of(Camera, {"view_angles": {"pixel": [0, 1], "across_deg": [0, 1]}, "n_pixels": 2}, "mine.yaml")
    assert str(fault).startswith("mine.yaml: view_angles: found 2 rows, expected 4 rows or more")
