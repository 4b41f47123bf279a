"""Projections against their rays and, for Eq. 28, against Monte Carlo and finite differences."""

from dataclasses import replace

import numpy as np
import pytest

from linepose.experiments import mapping
from linepose.experiments.mapping import perturbed, project, projection_covariance, spread_mm
from linepose.geometry.camera import pixel_from_normalised
from linepose.geometry.distance import geodesic_angle_rad
from linepose.geometry.plane import Plane
from linepose.geometry.rotations import matrix_from_euler, matrix_from_rotation_vector

POSE = np.array([0.2, -0.1, -0.8, -0.1, 0.15, -1.5])
PLANE = Plane(np.array([0.0, 0.0, 0.3]), np.array([0.1, -0.05, 1.0]) / np.linalg.norm([0.1, -0.05, 1.0]))


def test_projections_lie_on_the_plane_and_reproject_into_their_pixels(survey, camera):
    points = project(survey, camera, POSE, PLANE)
    np.testing.assert_allclose(PLANE.height_m(points), 0, atol=1e-12)
    for n in range(survey.n_observations):
        for m in range(survey.n_points):
            body = matrix_from_euler(survey.euler_rad[n, m])
            in_body = body.T @ (points[n, m] - survey.position_m[n, m]) - POSE[:3]
            x, y, z = matrix_from_rotation_vector(POSE[3:]).T @ in_body
            # the closed-form undistortion inverts to second order in k, here to 3 k1^2 x^5 = 0.003 px
            assert pixel_from_normalised(camera, x / z) == pytest.approx(survey.u_px[n, m], abs=0.01)
            assert y == pytest.approx(0, abs=1e-12)


def test_unobserved_points_are_not_projected(survey, camera):
    survey.u_px[3, 5] = np.nan
    points = project(survey, camera, POSE, PLANE)
    assert np.isnan(points[3, 5]).all()
    assert np.isfinite(np.delete(points.reshape(-1, 3), 3 * survey.n_points + 5, axis=0)).all()


def pose_covariance():
    root = np.random.default_rng(1).standard_normal((6, 6)) * np.array([0.02, 0.02, 0.02, 0.005, 0.005, 0.005])[:, None]
    return root @ root.T


def test_covariance_agrees_with_finite_differences_of_the_projection(survey, camera):
    """J C J^T with J by central differences of `project` in every input, one after the other."""
    covariance = pose_covariance()
    total = np.zeros((survey.n_observations, survey.n_points, 3, 3))
    step = 1e-6

    def derivative(of):
        return (of(step) - of(-step)) / (2 * step)

    by_pose = np.stack(
        [derivative(lambda h, k=k: project(survey, camera, POSE + h * np.eye(6)[k], PLANE)) for k in range(6)], axis=-1
    )
    total += by_pose @ covariance @ np.swapaxes(by_pose, -1, -2)
    axes = np.eye(3)
    by_body = [
        derivative(
            lambda h, k=k: project(replace(survey, position_m=survey.position_m + h * axes[k]), camera, POSE, PLANE)
        )
        for k in range(3)
    ] + [
        derivative(
            lambda h, k=k: project(replace(survey, euler_rad=survey.euler_rad + h * axes[k]), camera, POSE, PLANE)
        )
        for k in range(3)
    ]
    by_body = np.stack(by_body, axis=-1)
    total += by_body @ survey.covariance @ np.swapaxes(by_body, -1, -2)
    sigmas = camera.sigmas
    singles = [
        (
            derivative(lambda h: project(replace(survey, u_px=survey.u_px + 1e3 * h), camera, POSE, PLANE)) / 1e3,
            sigmas.u_px,
        ),
        *(
            (
                derivative(
                    lambda h, q=q, s=s: project(survey, camera.replaced(**{q: getattr(camera, q) + s * h}), POSE, PLANE)
                )
                / s,
                sigma,
            )
            for q, s, sigma in (
                ("focal_length_m", 1e-2, sigmas.focal_length_m),
                ("principal_point_px", 1e3, sigmas.principal_point_px),
                ("k1", 1.0, sigmas.k1),
                ("k2", 1.0, sigmas.k2),
            )
        ),
    ]
    for column, sigma in singles:
        total += sigma**2 * column[..., :, None] * column[..., None, :]
    # v is 0 in every observation: a pixel across the line turns the ray about the camera's x axis, seen at unit depth
    turn = 1 / camera.focal_length_px
    obtained = projection_covariance(survey, camera, POSE, covariance, PLANE)
    without_v = projection_covariance(
        survey, camera.replaced(sigmas=sigmas.model_copy(update={"v_px": 1e-6})), POSE, covariance, PLANE
    )
    np.testing.assert_allclose(without_v, total, rtol=1e-6, atol=1e-12)
    across = obtained - without_v
    body = matrix_from_euler(survey.euler_rad) @ matrix_from_rotation_vector(POSE[3:])
    points = project(survey, camera, POSE, PLANE)
    centres = survey.position_m + matrix_from_euler(survey.euler_rad) @ POSE[:3]
    for n, m in ((0, 0), (5, 7), (11, 3)):
        depth = body[n, m, :, 2] @ (points[n, m] - centres[n, m])
        ray = (points[n, m] - centres[n, m]) / depth
        moved = ray + sigmas.v_px * turn * body[n, m, :, 1]
        met = centres[n, m] + moved * -PLANE.height_m(centres[n, m]) / (moved @ PLANE.normal)
        np.testing.assert_allclose(np.sqrt(np.trace(across[n, m])), np.linalg.norm(met - points[n, m]), rtol=2e-3)


@pytest.mark.statistical
def test_covariance_agrees_with_monte_carlo(survey, camera):
    """A variance of 20,000 draws has a relative sigma of sqrt(2 / 20000) = 1 %; five of those, 1 % for curvature."""
    random = np.random.default_rng(2)
    covariance = pose_covariance()
    n, m, draws = 4, 6, 20_000
    one = replace(
        survey,
        u_px=np.repeat(survey.u_px[n, m], draws)[None] + random.normal(0, camera.sigmas.u_px, (1, draws)),
        position_m=np.tile(survey.position_m[n, m], (1, draws, 1)),
        euler_rad=np.tile(survey.euler_rad[n, m], (1, draws, 1)),
    )
    body = random.multivariate_normal(np.zeros(6), survey.covariance[n, m], draws)
    one = replace(one, position_m=one.position_m + body[:, :3], euler_rad=one.euler_rad + body[:, 3:])
    poses = random.multivariate_normal(POSE, covariance, draws)
    sigmas = camera.sigmas
    points = np.empty((draws, 3))
    for k in range(draws):
        drawn = camera.replaced(
            principal_point_px=camera.principal_point_px + random.normal(0, sigmas.principal_point_px),
            focal_length_m=camera.focal_length_m + random.normal(0, sigmas.focal_length_m),
        )
        points[k] = mapping.intersect(
            PLANE,
            *mapping.rays(
                drawn,
                matrix_from_rotation_vector(poses[k, 3:]),
                poses[k, :3],
                matrix_from_euler(one.euler_rad[0, k]),
                one.position_m[0, k],
                one.u_px[0, k],
            ),
        )
    exact = camera.replaced(sigmas=sigmas.model_copy(update={"v_px": 1e-6, "k1": 0.0, "k2": 0.0}))
    expected = projection_covariance(survey, exact, POSE, covariance, PLANE)[n, m]
    scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
    np.testing.assert_allclose(np.cov(points.T) / scale, expected / scale, atol=0.06)


def test_projected_points_cannot_leave_the_plane(survey, camera):
    covariance = projection_covariance(survey, camera, POSE, pose_covariance(), PLANE)
    np.testing.assert_allclose(covariance @ PLANE.normal, 0, atol=1e-16)
    np.testing.assert_allclose(covariance, np.swapaxes(covariance, -1, -2), atol=1e-18)


def test_perturbation_turns_each_body_axis():
    """Three turns of a small angle about orthogonal axes make sqrt(3) of it, to second order."""
    angle = np.radians(1.0)
    moved = perturbed(POSE, angle)
    assert geodesic_angle_rad(moved, POSE) == pytest.approx(np.sqrt(3) * angle, rel=angle)
    np.testing.assert_array_equal(moved[:3], POSE[:3])


def test_spread_is_the_rms_distance_to_each_points_mean():
    points = np.zeros((2, 3, 3))
    points[:, 0] = [[0, 0, 0], [0.002, 0, 0]]  # 1 mm each
    points[:, 1] = [[5, 1, 0], [5, 1, 0.006]]  # 3 mm each
    points[:, 2] = [[7, 7, 7], [np.nan] * 3]  # seen once
    assert spread_mm(points) == pytest.approx(np.sqrt((1 + 1 + 9 + 9) / 4), rel=1e-12)


def test_table_has_map_coordinates_and_every_observed_point(survey, camera):
    survey.u_px[0, 0] = np.nan
    table = mapping.mapping_table(survey, camera, {"calibrated": (POSE, pose_covariance())}, PLANE)
    assert len(table) == survey.u_px.size - 1
    first = table.iloc[0]
    assert (first["observation"], first["point"]) == (1, 1)
    expected = project(survey, camera, POSE, PLANE)[0, 1] + survey.origin_m
    np.testing.assert_array_equal(first[["north_m", "east_m", "down_m"]].to_numpy(dtype=float), expected)
    variance = projection_covariance(survey, camera, POSE, pose_covariance(), PLANE)[0, 1, 0, 1]
    assert first["covariance_north_east_m2"] == variance


def test_summary_separates_all_from_accepted(survey, camera):
    """The last observation is displaced by 1 m north: only the spread of all observations knows."""
    survey.position_m[-1, :, 0] += 1.0
    poses = {"before": (POSE + 0.01, pose_covariance()), "after": (POSE, pose_covariance())}
    table = mapping.mapping_table(survey, camera, poses, PLANE)
    points = PLANE.centre_m + np.random.default_rng(1).standard_normal((12, 3))
    summary = mapping.mapping_summary(table, PLANE, points, range(1, 12)).set_index(["pose", "observations"])
    for name, (pose, covariance) in poses.items():
        projected = project(survey, camera, pose, PLANE)
        assert summary.loc[(name, "all"), "spread_mm"] == pytest.approx(spread_mm(projected), rel=1e-6)
        assert summary.loc[(name, "accepted"), "spread_mm"] == pytest.approx(spread_mm(projected[:-1]), rel=1e-6)
        traces = np.trace(projection_covariance(survey, camera, pose, covariance, PLANE), axis1=-2, axis2=-1)
        assert summary.loc[(name, "all"), "sigma_mm"] == pytest.approx(1e3 * np.sqrt(traces.mean()), rel=1e-9)
    assert summary["n_projected"].tolist() == [144, 132, 144, 132]
    rms = 1e3 * np.sqrt(np.mean(((points - PLANE.centre_m) @ PLANE.normal) ** 2))
    assert summary["plane_rms_mm"].to_numpy() == pytest.approx(rms)
