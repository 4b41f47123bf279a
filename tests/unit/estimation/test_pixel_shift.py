"""What a pixel's place moves: by hand for moves along and about each axis of the camera, and its sigma."""

import numpy as np
from numpy.testing import assert_allclose

from linepose.estimation.pixel_shift import Mounted, pixel_shift, shift_covariance
from linepose.geometry.camera import Camera

NAMES = ("principal_point_px", "focal_length_m")
CAMERA = Camera(focal_length_m=8e-3, pixel_pitch_m=8e-6, n_pixels=601, principal_point_px=300.0)  # 1000 px
FIRST = Mounted(CAMERA, np.zeros(6))  # body axes are those of the camera
RANGE_M = 10.0
PIXELS = {0.0: -0.3, 300.0: 0.0, 600.0: 0.3}  # to their slope along the line


def shifts(pose):
    second = Mounted(CAMERA, np.asarray(pose, dtype=float))
    return np.array([pixel_shift(FIRST, second, pixel, RANGE_M) for pixel in PIXELS])


def test_a_shift_of_the_camera_is_that_of_every_pixel():
    assert_allclose(shifts([0.02, -0.01, 0, 0, 0, 0]), [[0.02, -0.01]] * 3, atol=1e-12)


def test_down_spreads_the_line():
    assert_allclose(shifts([0, 0, 1.0, 0, 0, 0]), [[-slope, 0] for slope in PIXELS.values()], atol=1e-12)


def test_turns_move_as_trigonometry_says():
    small = 1e-3
    about_x = [[slope * RANGE_M * (1 / np.cos(small) - 1), -RANGE_M * np.tan(small)] for slope in PIXELS.values()]
    assert_allclose(shifts([0, 0, 0, small, 0, 0]), about_x, atol=1e-9)
    along = [[RANGE_M * (np.tan(np.arctan(slope) + small) - slope), 0] for slope in PIXELS.values()]
    assert_allclose(shifts([0, 0, 0, 0, small, 0]), along, atol=1e-9)
    about_axis = [[slope * RANGE_M * (np.cos(small) - 1), slope * RANGE_M * np.sin(small)] for slope in PIXELS.values()]
    assert_allclose(shifts([0, 0, 0, 0, 0, small]), about_axis, atol=1e-9)


def test_another_principal_point_moves_along_the_line():
    second = Mounted(CAMERA.replaced(principal_point_px=302.0), np.zeros(6))
    assert_allclose(pixel_shift(FIRST, second, 300.0, RANGE_M), [-2 * RANGE_M / 1000, 0], atol=1e-12)


def test_a_ray_that_misses_the_surface_has_no_place():
    assert np.all(np.isnan(shifts([0, 0, 0, np.pi, 0, 0])))
    assert np.all(np.isnan(shifts([0, 0, 11.0, 0, 0, 0])))


def test_sigma_at_the_centre_is_that_of_shift_and_turn():
    covariance = np.diag([0.01, 0.02, 0.0, 1e-3, 2e-3, 0.0, 0.0, 0.0]) ** 2
    found = shift_covariance(FIRST, Mounted(CAMERA, np.zeros(6)), 300.0, RANGE_M, covariance, NAMES)
    assert_allclose(np.sqrt(np.diag(found)), [np.hypot(0.01, 0.02), np.hypot(0.02, 0.01)], rtol=1e-5)


def test_a_smile_moves_the_line_s_end_across():
    """By smile x^2 of the range, and its sigma likewise."""
    smiling = CAMERA.replaced(smile=0.01)
    x = 300 / 1000
    found = pixel_shift(FIRST, Mounted(smiling, np.zeros(6)), 600.0, RANGE_M)
    assert_allclose(found, [0, 0.01 * x**2 * RANGE_M], atol=1e-12)
    covariance = np.diag([*[0.0] * 8, 0.002**2])
    of_shift = shift_covariance(FIRST, Mounted(smiling, np.zeros(6)), 600.0, RANGE_M, covariance, (*NAMES, "smile"))
    assert_allclose(np.sqrt(np.diag(of_shift)), [0, 0.002 * x**2 * RANGE_M], atol=1e-9)


def test_what_principal_point_and_turn_do_in_opposite_ways_cancels():
    """A turn about y by 1e-3 moves the centre as a principal point 1 px less does."""
    errors = np.array([0, 0, 0, 0, 1e-3, 0, 1.0, 0])
    found = shift_covariance(FIRST, Mounted(CAMERA, np.zeros(6)), 300.0, RANGE_M, np.outer(errors, errors), NAMES)
    assert_allclose(found, np.zeros((2, 2)), atol=1e-12)
    alone = shift_covariance(FIRST, Mounted(CAMERA, np.zeros(6)), 300.0, RANGE_M, np.diag(errors**2), NAMES)
    assert_allclose(np.sqrt(alone[0, 0]), np.sqrt(2) * 1e-3 * RANGE_M, rtol=1e-5)
