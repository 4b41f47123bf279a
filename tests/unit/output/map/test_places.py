import dataclasses

import numpy as np
import pytest

from linepose.errors import InputError
from linepose.geometry.camera import Camera, rays
from linepose.geometry.rotations import (
    left_jacobian_so3,
    matrix_from_euler,
    matrix_from_rotation_vector,
    rotation_vector_from_matrix,
)
from linepose.output.map.ground import Ground, flat_ground, plane_through
from linepose.output.map.places import count_states
from linepose.output.map.sources import SOURCES, radii_of_95
from linepose.pipeline.adjusted_intrinsics import AdjustedIntrinsics
from unit.output.map.made_up_scan import CAMERA, LEVELS, ORIGIN, POSE, POSE_COVARIANCE, scan


def on_plane(centre, direction, normal, offset):
    along = (offset - centre @ normal) / (direction @ normal)
    return centre + along[..., None] * direction


def test_places_are_where_the_rays_of_the_camera_model_meet_the_plane():
    plane = plane_through(ORIGIN + np.array([[0, 0, 0], [4, 0, 0.3], [0, 4, -0.2]]), 0.01)
    strip = scan(ground=plane)
    found = strip.places(5, 9)
    position, euler, _ = strip.bodies(5, 9)
    pixel = np.broadcast_to(np.arange(CAMERA.n_pixels), (4, CAMERA.n_pixels))
    centre, direction = rays(
        CAMERA, strip.mounted.turn, POSE[:3], matrix_from_euler(euler)[:, None], position[:, None], pixel
    )
    north_east_down = on_plane(centre, direction, plane.normal, plane.offset)
    expected = np.moveaxis(north_east_down[..., [1, 0, 2]] * [1, 1, -1], -1, 1)
    np.testing.assert_allclose(found.place_m, expected, atol=2e-8)
    assert found.is_found.all()


def test_a_distorted_camera_sees_the_ground_where_plain_arithmetic_says():
    """To 1 mm, of the table too: each pixel's ray written out, the lens undone by bisection."""
    angles = np.rad2deg(np.arctan((np.arange(60) - 28.3) / 100))
    table = {"pixel": list(range(60)), "across_deg": (angles + 3e-4 * angles**2).tolist()}
    tabulated = Camera(view_angles=table | {"along_deg": (0.2 + 0.01 * angles).tolist()}, n_pixels=60)
    for camera in (BENT, tabulated):
        strip = scan(camera=camera)
        found, pixels = strip.places(5, 6).place_m[0], np.arange(60.0)
        if camera is BENT:
            low, high = np.full(60, -1.0), np.full(60, 1.0)
            for _ in range(60):
                x = (low + high) / 2
                u = 29.0 + 100 * (x + 0.02 * x**3 - 0.01 * x**5 + 0.02 * x**7 - 0.06 * x**2)
                low, high = np.where(u < pixels, x, low), np.where(u < pixels, high, x)
            y = 0.03 * x + 0.2 * x**2
        else:
            x, y = np.tan(np.deg2rad(table["across_deg"])), np.tan(np.deg2rad(0.2 + 0.01 * angles))
        position, euler, _ = (one[0] for one in strip.bodies(5, 6))
        body = matrix_from_euler(euler)
        centre = position + body @ POSE[:3]
        ray = np.stack([x, y, np.ones(60)], axis=1) @ matrix_from_rotation_vector(POSE[3:]).T @ body.T
        ground = centre + (-42.0 - centre[2]) / ray[:, 2:] * ray
        np.testing.assert_allclose(found[:2].T, ground[:, [1, 0]], rtol=0, atol=1e-6)
        np.testing.assert_allclose(strip.places_of([5] * 60, pixels)[:, :2], found[:2].T, rtol=0, atol=1e-6)


def ideal(s, k1, k2, k3=0.0, p2=0.0):
    """x whose distorted one is s, by steps that each leave a small share of the error."""
    x = s
    for _ in range(40):
        x = x + s - x * (1 + k1 * x**2 + k2 * x**4 + k3 * x**6) - 3 * p2 * x**2
    return x


BENT = CAMERA.replaced(
    k3=0.02,
    p2=-0.02,
    tilt=0.03,
    smile=0.2,
    sigmas=CAMERA.sigmas.replaced(k3=0.02, p2=0.004, tilt=0.002, smile=0.01),
)


def drawn(strip, source, line, pixels, rng, n):
    """Places (n, P, 3) east, north, up of pixels of a line whose errors of one source, or all, are drawn."""
    camera, (position, euler, reported) = strip.mounted.camera, (one[0] for one in strip.bodies(line, line + 1))

    def normal(of, *shape):
        return rng.normal(size=shape) if source in (of, "all") else np.zeros(shape)

    pose = POSE + normal("pose", n, 6) @ np.linalg.cholesky(POSE_COVARIANCE).T
    body_error = normal("navigation", n, 6) @ np.linalg.cholesky(strip.mounted.scaled(reported[None])[0]).T
    of_camera, s = normal("intrinsics", n, 8, 1), camera.sigmas
    centre_px = camera.principal_point_px + of_camera[:, 0] * s.principal_point_px
    focal_px = (camera.focal_length_m + of_camera[:, 1] * s.focal_length_m) / camera.pixel_pitch_m
    along = pixels + normal("pixel", n, len(pixels)) * s.u_px * strip.mounted.levels.pixel
    names = ("k1", "k2", "k3", "p2", "tilt", "smile")
    *lens, tilt, smile = (
        getattr(camera, name) + of_camera[:, 2 + i] * getattr(s, name) for i, name in enumerate(names)
    )
    x = ideal((along - centre_px) / focal_px, *lens)
    y = tilt * x + smile * x**2
    late = normal("pixel", n, len(pixels), 1) * strip.mounted.levels.lateness * strip.motion(line, line + 1)[0]
    position, euler = (
        np.asarray(one) + body_error[:, None, part] + late[..., part]
        for one, part in ((position, np.s_[:3]), (euler, np.s_[3:]))
    )
    body, turn = matrix_from_euler(euler), matrix_from_rotation_vector(pose[:, 3:])
    centre = position + np.einsum("npij,nj->npi", body, pose[:, :3])
    direction = np.einsum("npij,njk,npk->npi", body, turn, np.stack([x, y, np.ones_like(x)], axis=-1))
    down = strip.ground.offset + normal("ground", n, 1) * strip.ground.sigma_m
    reach = (-down - centre[..., 2]) / direction[..., 2]
    return (centre + reach[..., None] * direction)[..., [1, 0, 2]] * [1, 1, -1]


@pytest.mark.parametrize("camera", [CAMERA, BENT], ids=["straight", "bent"])
@pytest.mark.parametrize("source", [*SOURCES, "all"])
def test_sigmas_are_those_of_drawn_errors(source, camera):
    strip, pixels = scan(levels=LEVELS, camera=camera), np.array([0, 31, 59])
    sigma = strip.places(7, 8, SOURCES if source == "all" else [source]).sigma_m[0][:, pixels]
    draws = drawn(strip, source, 7, pixels, np.random.default_rng(3), 20_000)
    spread = draws.std(axis=0).T
    np.testing.assert_allclose(sigma[:2], spread[:2], rtol=0.05)  # the spread's own sigma is 0.5 %
    np.testing.assert_allclose(sigma[2], spread[2], rtol=0.05, atol=1e-7)
    off = np.linalg.norm((draws - draws.mean(axis=0))[..., :2], axis=-1)
    np.testing.assert_allclose(np.quantile(off, 0.95, axis=0), sigma[3], rtol=0.05)


def test_pose_and_intrinsics_of_an_adjustment_err_together():
    """Sigmas of all sources beside draws in which pose and intrinsics are of one joint distribution."""
    rng = np.random.default_rng(4)
    by_each = np.zeros((6, 3))
    by_each[3:, 0], by_each[2, 1], by_each[4, 2] = [-6e-3, 2e-3, 1e-3], 150.0, -0.2  # of the pose by px, m and smile
    covariance = np.diag([1.0, 4e-10, 4e-4])
    covariance[0, 1] = covariance[1, 0] = 1e-5
    intrinsics = AdjustedIntrinsics(
        ("principal_point_px", "focal_length_m", "smile"),
        np.array([29.0, 8e-3, BENT.smile]),
        covariance,
        by_each,
        np.array([29.0, 8e-3, 0.0]),
        np.array([2.0, 1e-4, 0.5]),
    )
    turned = left_jacobian_so3(POSE[3:])
    own = np.diag([0.004, 0.004, 0.004, 1e-3, 1e-3, 1e-3]) ** 2
    steps_covariance = by_each @ covariance @ by_each.T + own
    by_parameters = np.eye(6)
    by_parameters[3:, 3:] = np.linalg.inv(turned)
    strip = scan(camera=BENT)
    mounted = dataclasses.replace(
        strip.mounted, covariance=by_parameters @ steps_covariance @ by_parameters.T, intrinsics=intrinsics
    )
    strip = dataclasses.replace(strip, mounted=mounted)
    n, pixels = 20_000, np.array([0, 31, 59])
    off = rng.normal(size=(n, 3)) @ np.linalg.cholesky(covariance).T
    steps = off @ by_each.T + rng.normal(size=(n, 6)) * np.sqrt(np.diag(own))
    pose = POSE + steps @ by_parameters.T
    camera = strip.mounted.camera
    focal = (camera.focal_length_m + off[:, 1:2]) / camera.pixel_pitch_m
    lens = [getattr(camera, name) for name in ("k1", "k2", "k3", "p2")]
    x = ideal((pixels - camera.principal_point_px - off[:, :1]) / focal, *lens)
    y = camera.tilt * x + (camera.smile + off[:, 2:]) * x**2
    position, euler, _ = (one[0] for one in strip.bodies(7, 8))
    body = matrix_from_euler(euler)
    ray = np.stack([x, y, np.ones_like(x)], axis=-1)
    direction = np.einsum("ij,njk,npk->npi", body, matrix_from_rotation_vector(pose[:, 3:]), ray)
    centre = (position + pose[:, :3] @ body.T)[:, None]
    places = centre + ((-42.0 - centre[..., 2:]) / direction[..., 2:]) * direction
    both = strip.places(7, 8, ["pose", "intrinsics"]).sigma_m[0][:2, pixels]
    np.testing.assert_allclose(both, places.std(axis=0).T[[1, 0]], rtol=0.03)
    apart = [strip.places(7, 8, [one]).sigma_m[0][:2, pixels] for one in ("pose", "intrinsics")]
    assert np.max(np.abs(np.hypot(*apart) / both - 1)) > 0.2


def test_motion_is_that_from_line_to_line_whatever_the_block():
    strip = scan()
    position, euler, _ = strip.bodies(0, 40)
    whole = strip.motion(0, 40)
    np.testing.assert_allclose(
        whole[10], np.concatenate([position[11] - position[9], euler[11] - euler[9]]) / 2, atol=1e-8
    )
    np.testing.assert_allclose(np.concatenate([strip.motion(0, 7), strip.motion(7, 40)]), whole, atol=1e-8)
    np.testing.assert_allclose(scan(n_lines=1).motion(0, 1), np.zeros((1, 6)))


def test_radius_of_95_percent_is_known_at_both_ends():
    np.testing.assert_allclose(radii_of_95()[[0, -1]], [1.959964, 2.447747], rtol=1e-3)


def test_variances_of_the_sources_add_up():
    strip = scan()
    parts = sum(strip.places(0, 2, [source]).sigma_m[:, :3].astype(float) ** 2 for source in SOURCES)
    np.testing.assert_allclose(np.sqrt(parts), strip.places(0, 2).sigma_m[:, :3], rtol=1e-5)


def test_a_correction_moves_the_body():
    moved = scan(correction=np.array([0.1, -0.2, 0.0, 0.0, 0.0, 0.0])).places(0, 3).place_m
    expected = np.broadcast_to([[-0.2], [0.1], [0.0]], (3, 3, 60))
    np.testing.assert_allclose(moved - scan().places(0, 3).place_m, expected, atol=1e-8)


def hilly(heights, cell=0.05, corner=(20.0, -20.0)):
    return Ground(
        0.03,
        np.array([0.0, 0.0, -1.0]),
        0.0,
        np.asarray(heights, dtype=np.float32),
        (ORIGIN[0] + corner[0], ORIGIN[1] + corner[1]),
        (cell, cell),
    )


def test_a_flat_elevation_model_is_the_flat_ground():
    on_grid, flat = scan(ground=hilly(np.full((800, 800), 42.0))).places(0, 4), scan().places(0, 4)
    np.testing.assert_allclose(on_grid.place_m, flat.place_m, atol=1e-6)
    np.testing.assert_allclose(on_grid.sigma_m, flat.sigma_m, rtol=1e-5)


def test_a_sloping_elevation_model_is_the_plane():
    north, east = 20.0 - 0.05 * np.arange(800)[:, None], -20.0 + 0.05 * np.arange(800)
    plane = plane_through(ORIGIN + np.array([[0, 0, 0], [4, 0, -0.4], [0, 4, 0.8]]), 0.03)
    heights = 42.0 + 0.1 * north - 0.2 * east
    on_grid, on_plane_ = scan(ground=hilly(heights)).places(0, 4), scan(ground=plane).places(0, 4)
    np.testing.assert_allclose(on_grid.place_m, on_plane_.place_m, atol=2e-5)  # heights are kept in four bytes
    np.testing.assert_allclose(on_grid.sigma_m, on_plane_.sigma_m, rtol=2e-3)


def test_holes_edges_and_rays_that_miss_are_counted():
    heights = np.full((800, 800), 42.0)
    heights[395:405] = np.nan
    assert count_states(scan(ground=hilly(heights)).places(0, 40).state)["n_in_hole"] > 0
    beside = scan(ground=hilly(np.full((800, 410), 42.0))).places(0, 1)
    assert 0 < count_states(beside.state)["n_outside"] < CAMERA.n_pixels
    assert np.array_equal(np.isnan(beside.place_m[:, 0]), beside.state > 0)
    assert count_states(scan(ground=flat_ground(50.0)).places(0, 1).state)["n_missed"] == CAMERA.n_pixels


@pytest.mark.parametrize("ground", [flat_ground(50.0), hilly(np.tile([41.0, 42.0, 43.0, 42.0], (800, 200)))])
def test_a_camera_that_looks_at_the_sky_and_past_the_horizon_sees_no_ground(ground):
    """Some rays end at the horizon, where they would take steps without number."""
    strip = scan(ground=ground)
    for roll in (-np.pi / 2 + 0.06, -np.pi + 0.06):
        pose = np.concatenate([POSE[:3], rotation_vector_from_matrix(matrix_from_euler([roll, 0.0, 0.0]))])
        found = dataclasses.replace(strip, mounted=dataclasses.replace(strip.mounted, pose=pose)).places(0, 2)
        met = found.is_found
        assert not met.all()
        assert np.all(np.isnan(found.place_m[:, 0]) == ~met)
        if roll < -2.0:
            assert not met.any()


def test_a_ray_that_passes_a_wall_ends_at_it_and_is_counted():
    flat = scan().places(0, 1).place_m[0]
    heights = np.full((800, 800), 42.0)
    wall = 41  # column of a thin wall two metres high
    first, last = flat[1, 0], flat[1, -1]  # northing of the line's ends
    column = int((flat[0, wall] - ORIGIN[1] + 20.0) / 0.05)
    heights[:, column - 1 : column + 2] += 2.0
    found = scan(ground=hilly(heights)).places(0, 1)
    assert first != last
    assert count_states(found.state)["n_met_twice"] > 0
    assert np.nanmax(found.place_m[0, 2]) > 42.5


def test_lines_outside_the_log_are_told_with_their_scan():
    strip = scan()
    with pytest.raises(InputError, match=r"strip, line 0: found time .*, as of 40 lines, expected a time within"):
        strip.navigation.check(strip.time_us + 10**9, "strip")
    thin = dataclasses.replace(strip.navigation, maximum_pose_gap_s=0.01)
    with pytest.raises(InputError, match=r"a gap of 0\.050 s in the navigation log"):
        thin.check(strip.time_us, "strip")
    strip.navigation.check(strip.time_us, "strip")


def test_points_on_a_line_span_no_plane():
    with pytest.raises(InputError, match="3 points on a line"):
        plane_through([[0, 0, 0], [1, 1, 0], [2, 2, 0]])
