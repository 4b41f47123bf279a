"""Planes: planted ones, Eq. 26 where it is well posed, and rays against a linear solve."""

import numpy as np
import pytest

from linepose.errors import EstimationError
from linepose.geometry.plane import Plane, fit_plane, fit_plane_by_height, intersect


def points_on(normal, centre, noise=0.0, n=200, seed=1):
    random = np.random.default_rng(seed)
    normal = np.asarray(normal, dtype=float) / np.linalg.norm(normal)
    across = np.linalg.svd(normal[None])[2][1:]
    return centre + random.uniform(-1, 1, (n, 2)) @ across + noise * random.standard_normal((n, 1)) * normal


@pytest.mark.parametrize("normal", [[0, 0, 1], [0.1, -0.2, 0.9], [1, 0, 0], [0.6, 0.8, 0]])
def test_plane_is_found_upright_or_flat(normal):
    centre = np.array([3.0, -2.0, 1.0])
    plane = fit_plane(points_on(normal, centre))
    assert abs(plane.normal @ normal) / np.linalg.norm(normal) == pytest.approx(1, abs=1e-12)
    assert plane.height_m(centre) == pytest.approx(0, abs=1e-12)
    assert plane.normal[2] >= 0


def test_agrees_with_equation_26_on_a_flat_plane():
    """`down = a north + b east + c`: the two differ by the noise's share in the regressors, noise^2 / extent^2."""
    noise = 1e-3
    points = points_on([0.1, -0.2, 0.95], np.zeros(3), noise)
    design = np.column_stack([points[:, :2], np.ones(len(points))])
    a, b, c = np.linalg.lstsq(design, points[:, 2], rcond=None)[0]
    normal = np.array([-a, -b, 1]) / np.linalg.norm([a, b, 1])
    extent = points[:, :2].std()
    np.testing.assert_allclose(fit_plane(points).normal, normal, atol=3 * (noise / extent) ** 2)
    by_height = fit_plane_by_height(points)
    np.testing.assert_allclose(by_height.normal, normal, atol=1e-12)
    assert by_height.height_m([0, 0, c]) == pytest.approx(0, abs=1e-12)


def test_equation_26_fails_on_an_upright_plane_where_this_fit_does_not():
    points = points_on([1, 0, 0], np.zeros(3), 1e-3)
    assert np.degrees(np.arccos(fit_plane_by_height(points).normal[2])) < 89
    assert abs(fit_plane(points).normal[0]) > np.cos(np.radians(0.1))


def test_missing_points_do_not_enter():
    points = points_on([0.1, -0.2, 0.9], np.ones(3))
    holes = np.concatenate([points, np.full((3, 3), np.nan)])
    np.testing.assert_array_equal(fit_plane(holes).normal, fit_plane(points).normal)


@pytest.mark.parametrize(
    "points", [np.eye(3)[:2], np.outer(np.arange(5), [1, 2, 3]), np.full((4, 3), np.nan)], ids=["two", "line", "nan"]
)
def test_points_that_span_no_plane_are_refused(points):
    with pytest.raises(EstimationError, match="span no plane"):
        fit_plane(points)


def test_rays_meet_the_plane_where_a_linear_solve_says():
    random = np.random.default_rng(5)
    plane = Plane(np.array([1.0, 2, 3]), np.array([0.6, 0.0, 0.8]))
    centres, directions = random.normal([0, 0, -9], 1, (20, 3)), random.normal([0, 0, 4], 1, (20, 3))
    met = intersect(plane, centres, directions)
    across = np.linalg.svd(plane.normal[None])[2][1:]
    for c, d, p in zip(centres, directions, met, strict=True):
        t, _, _ = np.linalg.solve(np.column_stack([d, -across.T]), plane.centre_m - c)
        np.testing.assert_allclose(p, c + t * d, rtol=1e-12, atol=1e-12)


def test_rays_that_miss_give_nan():
    plane = Plane(np.zeros(3), np.array([0.0, 0, 1]))
    away, along, towards = [0, 0, -1.0], [1.0, 0, 0], [0, 0, 1.0]
    met = intersect(plane, np.array([[0, 0, -2.0]] * 3), np.array([away, along, towards]))
    assert np.isnan(met[:2]).all()
    np.testing.assert_array_equal(met[2], [0, 0, 0])
