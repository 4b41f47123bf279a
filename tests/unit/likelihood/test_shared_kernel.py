"""The compiled geometry: projections and their derivatives against complex steps, matrices against numpy."""

import numpy as np
import pytest

from linepose.likelihood.block_system import covariance_blocks, factorise, inverse_of_factored, solve_blocks
from linepose.likelihood.shared_arrays import shared_arrays
from linepose.likelihood.shared_kernel import (
    FixedOptics,
    Levels,
    empty_lines,
    linearise,
    matrix_from_rotation_vector,
    optics_at,
)
from unit.likelihood import dense_shared
from unit.likelihood.small_survey import CAMERA, DISTORTED, POSE, Truth, make_survey

ROUNDING = 1e-11  # of double precision over a few dozen operations


@pytest.mark.parametrize("camera", [CAMERA, DISTORTED])
def test_derivatives_are_those_of_the_complex_step(camera):
    survey = make_survey(3, 2, Truth(0.5), seed=1, camera=camera)
    arrays, _ = shared_arrays(survey)
    parameters = np.array([*POSE, 0, 0, 0, 301.0, 8.1e-3])
    fixed = FixedOptics(camera.pixel_pitch_m, camera.k1, camera.k2, camera.sigmas.u_px, camera.sigmas.v_px)
    points = np.random.default_rng(1).normal([0, 0, 0.4], 0.2, (2, 3))
    lines = empty_lines(6)
    assert linearise(arrays, optics_at(parameters, fixed), Levels(0.7, 0.4, 1.2), points, lines)
    order, used = dense_shared.lines_of(survey)
    residual, design, by_body = dense_shared.linearised(survey, camera, parameters, order, used, points.ravel())
    assert np.allclose(lines.residual_px.ravel(), residual, rtol=0, atol=ROUNDING * 1e3)
    for row, (i, k) in enumerate(order):
        by_point = design[2 * row : 2 * row + 2, 3 * k : 3 * k + 3]
        assert np.allclose(lines.by_point[row], by_point, rtol=0, atol=ROUNDING * np.abs(by_point).max())
        shared = lines.by_shared[row] @ lines.by_shared[row].T
        expected = 0.7**2 * by_body[row] @ survey.covariance[i].mean(axis=0) @ by_body[row].T
        assert np.allclose(shared, expected, rtol=0, atol=ROUNDING * np.abs(expected).max())
        own = 0.4**2 * by_body[row] @ survey.covariance[i, k] @ by_body[row].T
        own += 1.2**2 * np.diag([camera.sigmas.u_px**2, camera.sigmas.v_px**2])
        uu, uv, vv = lines.precision[row]
        assert np.allclose(np.array([[uu, uv], [uv, vv]]) @ own, np.eye(2), rtol=0, atol=1e-10)
        assert lines.log_determinant[row] == pytest.approx(np.linalg.slogdet(own)[1], abs=ROUNDING)


@pytest.mark.parametrize("length", [0.0, 1e-9, 0.99e-4, 1.01e-4, 1.0, 3.1])
def test_rotation_matrix_is_that_of_the_exponential_series(length):
    vector = length * np.array([0.6, -0.64, 0.48])
    x, y, z = vector
    skew = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    expected, term = np.eye(3), np.eye(3)
    for order in range(1, 60):
        term = term @ skew / order
        expected = expected + term
    assert np.allclose(matrix_from_rotation_vector(vector), expected, rtol=0, atol=1e-14)


@pytest.fixture
def arrow_system():
    """Three blocks of six that meet twelve unknowns, and its dense matrix and right side."""
    random = np.random.default_rng(3)
    root = random.normal(size=(40, 30))
    dense = root.T @ root
    for first in range(3):
        for second in range(3):
            if first != second:
                dense[6 * first : 6 * first + 6, 6 * second : 6 * second + 6] = 0.0
    dense += 60 * np.eye(30)
    return dense, random.normal(size=30)


def test_block_elimination_solves_the_dense_system(arrow_system):
    dense, right = arrow_system
    blocks = np.stack([dense[6 * b : 6 * b + 6, 6 * b : 6 * b + 6] for b in range(3)])
    cross, kept = dense[:18, 18:].copy(), dense[18:, 18:].copy()
    first, second = right[:18].copy(), right[18:].copy()
    log_determinant, square = solve_blocks(blocks, cross, kept, first, second)
    solution = np.linalg.solve(dense, right)
    assert log_determinant == pytest.approx(np.linalg.slogdet(dense)[1], rel=1e-13)
    assert square == pytest.approx(right @ solution, rel=1e-12)
    assert np.allclose(np.concatenate([first, second]), solution, rtol=0, atol=1e-13)
    of_blocks, of_cross, of_kept = covariance_blocks(blocks, cross, kept)
    inverse = np.linalg.inv(dense)
    assert np.allclose(of_kept, inverse[18:, 18:], rtol=0, atol=1e-14)
    assert np.allclose(of_cross, inverse[:18, 18:], rtol=0, atol=1e-14)
    for b in range(3):
        assert np.allclose(of_blocks[b], inverse[6 * b : 6 * b + 6, 6 * b : 6 * b + 6], rtol=0, atol=1e-14)


def test_a_matrix_that_is_not_positive_has_no_factor(arrow_system):
    dense, right = arrow_system
    dense[20, 20] = -1.0
    blocks = np.stack([dense[6 * b : 6 * b + 6, 6 * b : 6 * b + 6] for b in range(3)])
    result = solve_blocks(blocks, dense[:18, 18:].copy(), dense[18:, 18:].copy(), right[:18].copy(), right[18:].copy())
    assert np.all(np.isnan(result))


def test_inverse_of_a_factor_is_that_of_the_matrix(arrow_system):
    dense, _ = arrow_system
    factor = dense.copy()
    factorise(factor)
    assert np.allclose(inverse_of_factored(factor), np.linalg.inv(dense), rtol=0, atol=1e-14)
