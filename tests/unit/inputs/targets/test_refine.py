import numpy as np
import pytest

from linepose.inputs.targets.refine import METHODS, refine_points

SHAPE = (200, 80)


def spot(u, line, sigma_u=1.3, sigma_line=1.5, shear=0.0, background=120.0, height=900.0):
    """A Gaussian dot on dark print."""
    v, x = np.indices(SHAPE)
    x = x - u - shear * (v - line)
    light = background + height * np.exp(-0.5 * ((x / sigma_u) ** 2 + ((v - line) / sigma_line) ** 2))
    return light.astype(np.float32)


def with_ring(image, u, line, inner=6.5, outer=9.0):
    v, x = np.indices(SHAPE)
    radius = np.hypot(x - u, v - line)
    return np.where((radius > inner) & (radius < outer), 3000, image).astype(np.float32)


@pytest.mark.parametrize(("method", "tolerance"), [("peak", 0.11), ("centroid", 0.01)])
@pytest.mark.parametrize("fraction", [(0.0, 0.0), (0.31, -0.22), (-0.45, 0.4)])
@pytest.mark.parametrize("off", [(0, 0), (2, -1), (-1.6, 2.4)])
def test_centre_of_a_round_dot(method, tolerance, fraction, off):
    truth = np.array([40, 90]) + fraction
    # the peak stands on a grid of a tenth of a pixel
    found = METHODS[method](spot(*truth), *(truth + off))
    np.testing.assert_allclose(found, truth, atol=tolerance)


@pytest.mark.parametrize("sigma_line", [6.0, 15.0])
def test_centroid_of_a_dot_that_a_slow_pass_stretches(sigma_line):
    image = spot(40.3, 90.6, sigma_line=sigma_line, shear=0.05)
    found = METHODS["centroid"](image, 41.5, 93.0)
    np.testing.assert_allclose(found, (40.3, 90.6), atol=(0.02))


@pytest.mark.parametrize("method", METHODS)
def test_brighter_ring_within_reach_is_passed_over(method):
    image = with_ring(spot(40.2, 90.1), 40.2, 90.1)
    np.testing.assert_allclose(METHODS[method](image, 41.5, 89.5), (40.2, 90.1), atol=0.11)


def test_thick_ring_that_fills_most_of_its_ellipse_is_passed_over():
    image = with_ring(spot(40.2, 90.1, sigma_u=0.9, sigma_line=0.9), 40.2, 90.1, inner=4.0, outer=11.0)
    np.testing.assert_allclose(METHODS["centroid"](image, 42.2, 92.0), (40.2, 90.1), atol=0.11)


@pytest.mark.parametrize("method", METHODS)
def test_flat_print_has_no_dot(method):
    assert METHODS[method](np.full(SHAPE, 100, dtype=np.float32), 40.0, 90.0) is None


@pytest.mark.parametrize("truth", [(2.2, 90.0), (76.8, 90.0), (40.0, 2.3), (40.0, 196.7)])
@pytest.mark.parametrize(("method", "tolerance"), [("peak", 0.11), ("centroid", 0.05)])
def test_dot_by_the_edge_of_the_scan(method, tolerance, truth):
    np.testing.assert_allclose(METHODS[method](spot(*truth), *truth), truth, atol=tolerance)


def test_points_in_one_array_with_the_missing_as_nan():
    image = spot(40.0, 90.0)
    found = refine_points(METHODS["centroid"], image, [[41, 91], [10, 150]])
    np.testing.assert_allclose(found[0], (40.0, 90.0), atol=0.01)
    assert np.isnan(found[1]).all()


@pytest.mark.statistical
def test_centroid_of_a_noisy_dot_is_unbiased():
    rng = np.random.default_rng(5)
    truth, noise, n = np.array([40.3, 90.2]), 20.0, 200
    clean = spot(*truth)
    errors = (
        np.array(
            [
                METHODS["centroid"](clean + noise * rng.standard_normal(SHAPE).astype(np.float32), 41.0, 90.0)
                for _ in range(n)
            ]
        )
        - truth
    )
    sigma = errors.std(axis=0)
    # least possible sigma of a Gaussian dot's centre: noise / height * sqrt(2 / pi) sigma_u / sqrt(sigma_u sigma_line)
    least = noise / 900 * np.sqrt(2 / np.pi) * np.array([1.3, 1.5]) / np.sqrt(1.3 * 1.5)
    assert np.all(sigma > 0.8 * least)
    assert np.all(sigma < 2.0 * least)
    assert np.all(np.abs(errors.mean(axis=0)) < 4 * sigma / np.sqrt(n))
