import numpy as np
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

from linepose.geometry.camera import distort, normalised_from_pixel, pixel_from_normalised, rays, undistort

X = np.linspace(-0.5, 0.5, 11)
K1, K2 = -0.08, 0.03


def left_over(camera, x):
    """Undistortion's error: 6 (k1 x^2)^3 x, and a fifth of it for what k2 and the fourth order add."""
    return 1.2 * 6 * abs(camera.k1) ** 3 * x**7


def test_focal_length_counts_pixels(camera):
    assert camera.focal_length_px == 8e-3 / 8e-6


def test_distortion_is_the_polynomial():
    assert distort(0.5, 0.1, 0.2) == 0.5 * (1 + 0.1 * 0.25 + 0.2 * 0.0625)


def test_undistortion_inverts_distortion_to_second_order():
    def error(scale):
        exact = np.array([brentq(lambda i, x=x: distort(i, scale * K1, scale * K2) - x, -1, 1, xtol=1e-16) for x in X])
        return np.abs(undistort(X, scale * K1, scale * K2) - exact).max()

    # left over is the third order: half the coefficients leave an eighth, up to the fourth order's few per cent
    assert 6.5 < error(1.0) / error(0.5) < 9.5
    assert error(1.0) < 1e-4


def test_pixels_of_an_ideal_camera(camera):
    ideal = camera.replaced(k1=0.0, k2=0.0)
    assert normalised_from_pixel(ideal, 320.5) == 0.0
    np.testing.assert_allclose(normalised_from_pixel(ideal, 420.5), 0.1, rtol=1e-15)
    np.testing.assert_allclose(pixel_from_normalised(ideal, normalised_from_pixel(ideal, [0.0, 639.0])), [0.0, 639.0])


def test_pixels_of_a_distorted_camera(camera):
    pixel = pixel_from_normalised(camera, 0.2)
    assert pixel == (0.2 + camera.k1 * 0.008 + camera.k2 * 0.00032) * 1000 + 320.5
    np.testing.assert_allclose(normalised_from_pixel(camera, pixel), 0.2, rtol=0, atol=left_over(camera, 0.2))


def test_every_ray_passes_through_its_point(camera, survey, true_pose, true_points):
    body = Rotation.from_euler("ZYX", survey.euler_rad[..., ::-1].reshape(-1, 3)).as_matrix().reshape(8, 4, 3, 3)
    r_bc = Rotation.from_rotvec(true_pose[3:]).as_matrix()
    centres, directions = rays(camera, r_bc, true_pose[:3], body, survey.position_m, survey.u_px)
    distance = np.linalg.norm(np.cross(true_points - centres, directions), axis=-1) / np.linalg.norm(
        directions, axis=-1
    )
    assert distance.max() < 2.0 * left_over(camera, 0.25)  # points are at most 2 m deep
    assert np.all(np.sum((true_points - centres) * directions, axis=-1) > 0)


def test_ray_of_one_pixel(camera):
    ideal = camera.replaced(k1=0.0, k2=0.0)
    yawed = Rotation.from_euler("z", 90, degrees=True).as_matrix()
    centre, direction = rays(ideal, np.eye(3), [1.0, 0.0, -0.5], yawed, [10.0, 20.0, 0.0], 420.5)
    np.testing.assert_allclose(centre, [10.0, 21.0, -0.5], atol=1e-15)
    np.testing.assert_allclose(direction, [0.0, 0.1, 1.0], atol=1e-15)
