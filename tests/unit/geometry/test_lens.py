"""The lens: its inverse, its derivatives by complex steps and differences, and its table against SciPy's."""

import numpy as np
import pytest
from scipy.interpolate import PchipInterpolator
from scipy.optimize import brentq

from linepose.geometry import lens
from linepose.geometry.camera import Camera, pixel_from_normalised
from linepose.geometry.lens import COEFFICIENTS

X = np.linspace(-0.5, 0.5, 11)
PIXEL = np.arange(0.0, 400.0)
ACROSS_DEG = np.rad2deg(np.arctan((PIXEL - 210.3) / 400 * (1 + 0.05 * ((PIXEL - 200) / 400) ** 2)))
TABLE = {"pixel": PIXEL.tolist(), "across_deg": ACROSS_DEG.tolist(), "along_deg": (1e-4 * ACROSS_DEG**2).tolist()}
BENT = {"k1": -0.08, "k2": 0.03, "k3": -0.02, "p2": 0.004, "tilt": 0.003, "smile": -0.01}
POLYNOMIAL = Camera(focal_length_m=8e-3, pixel_pitch_m=2e-5, n_pixels=400, principal_point_px=199.5, **BENT)
TABULATED = Camera(view_angles=TABLE, n_pixels=400, **BENT)


@pytest.mark.parametrize("camera", [POLYNOMIAL, TABULATED], ids=["polynomial", "table"])
def test_undistortion_inverts_distortion(camera):
    found = lens.undistort(lens.distort(X, camera.lens), camera.lens)
    np.testing.assert_allclose(found, X, rtol=0, atol=1e-14)
    s = 0.37
    root = brentq(lambda x: float(lens.distort(x, camera.lens)) - s, 0, 1, xtol=1e-15)
    assert lens.undistort(s, camera.lens) == pytest.approx(root, abs=1e-14)


def test_no_direction_falls_beyond_where_the_lens_turns_back():
    turning = POLYNOMIAL.replaced(k1=-0.5, k2=0.0, k3=0.0, p2=0.0)
    largest = np.sqrt(1 / 1.5)  # where 1 - 1.5 x^2 is zero
    s = float(lens.distort(largest, turning.lens))
    assert np.isfinite(lens.undistort(0.99 * s, turning.lens))
    assert np.isnan(lens.undistort(1.01 * s, turning.lens))


def test_a_point_far_outside_does_not_fall_onto_the_line_again():
    """k1 alone would put x = 1.4 back at the middle."""
    folding = POLYNOMIAL.replaced(k1=-0.5, k2=0.0, k3=0.0, p2=0.0)
    assert abs(float(lens.distort(1.4, folding.lens))) < 0.1
    assert np.isnan(pixel_from_normalised(folding, 1.4))
    assert pixel_from_normalised(folding, 0.2) == pytest.approx(199.5 + 400 * (0.2 - 0.004))


def test_slopes_of_the_polynomials_are_those_of_complex_steps():
    """Exact to rounding: the imaginary part of a function at x + ih is h times its slope."""
    optics, step = POLYNOMIAL.lens, 1e-30
    z = X + 1j * step
    s = z * (1 + optics.k1 * z**2 + optics.k2 * z**4 + optics.k3 * z**6) + 3 * optics.p2 * z**2
    np.testing.assert_allclose(lens.distort(X, optics), s.real, rtol=1e-15, atol=1e-30)
    np.testing.assert_allclose(lens.distortion_slope(X, optics), s.imag / step, rtol=1e-14)
    y = optics.tilt * z + optics.smile * z**2
    np.testing.assert_allclose(lens.across_slope(X, optics), y.imag / step, rtol=1e-14)


def test_slopes_of_a_table_are_those_of_differences():
    optics, step = TABULATED.lens, 1e-6
    inside = X + 1e-4  # off the knots, where the slope has a bend
    for value, slope in ((lens.distort, lens.distortion_slope), (lens.across, lens.across_slope)):
        numeric = (value(inside + step, optics) - value(inside - step, optics)) / (2 * step)
        np.testing.assert_allclose(slope(inside, optics), numeric, rtol=0, atol=1e-8)


def test_derivatives_by_coefficients_are_those_of_differences():
    for camera in (POLYNOMIAL, TABULATED):
        along, bent = lens.by_coefficients(X, COEFFICIENTS)
        for k, name in enumerate(COEFFICIENTS):
            ends = [camera.lens.at({name: getattr(camera, name) + step}) for step in (0.5, -0.5)]
            for value, by in ((lens.distort, along), (lens.across, bent)):
                np.testing.assert_allclose(by[:, k], value(X, ends[0]) - value(X, ends[1]), rtol=0, atol=1e-15)


def test_a_table_is_interpolated_as_scipy_does_and_passes_through_its_rows():
    camera = TABULATED.replaced(**dict.fromkeys(COEFFICIENTS, 0.0))
    knots, s, slope, y, _ = camera.lens[6:]
    between = np.linspace(knots[0], knots[-1], 1001)
    np.testing.assert_allclose(lens.distort(between, camera.lens), PchipInterpolator(knots, s)(between), atol=1e-14)
    np.testing.assert_allclose(lens.across(between, camera.lens), PchipInterpolator(knots, y)(between), atol=1e-16)
    np.testing.assert_allclose(slope, PchipInterpolator(knots, s).derivative()(knots), rtol=1e-10)
    np.testing.assert_allclose(np.tan(np.deg2rad(ACROSS_DEG)), knots, rtol=1e-14)


def test_a_table_goes_on_straight_beyond_its_ends():
    optics = TABULATED.replaced(**dict.fromkeys(COEFFICIENTS, 0.0)).lens
    end = optics.knot_x[-1]
    first, second = (lens.distort(end + step, optics) - lens.distort(end, optics) for step in (0.1, 0.2))
    assert second == pytest.approx(2 * first, rel=1e-12)


@pytest.mark.parametrize("rows", [[0.3, 0.1, 0.5, 0.2, 0.9, 0.95], [0.0, 1.0, 1.0, 1.0, 2.0, 9.0]])
def test_slopes_at_knots_are_scipys(rows):
    x = np.array([0.0, 0.1, 0.35, 0.5, 0.9, 1.0])
    np.testing.assert_allclose(
        lens.monotone_slopes(x, np.array(rows)), PchipInterpolator(x, rows).derivative()(x), atol=1e-12
    )
