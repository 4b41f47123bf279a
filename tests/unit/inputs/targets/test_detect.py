from dataclasses import replace

import numpy as np
import pytest
from scipy import ndimage

from linepose.inputs.scans.scan_files import Scan
from linepose.inputs.targets.detect import detect
from linepose.inputs.targets.dot_alone import dot_alone
from linepose.inputs.targets.refine import METHODS
from linepose.inputs.targets.ring_board import ring_board
from linepose.survey.targets.rings import RingsSection

TURN = np.deg2rad(20)
ROTATED = 330 * np.array([[np.cos(TURN), -np.sin(TURN)], [np.sin(TURN), np.cos(TURN)]])
WAYS = {
    "along": ((400, 300), [[0, 250], [420, 0]], [150, 200], 0.0),
    "across": ((300, 500), [[500, 0], [0, 350]], [250, 150], 0.0),
    "half turn": ((300, 500), [[-500, 0], [0, -350]], [250, 150], 0.0),
    "mirrored": ((300, 500), [[-500, 0], [0, 350]], [250, 150], 0.0),
    "mirrored upside down": ((300, 500), [[500, 0], [0, -350]], [250, 150], 0.0),
    "turned": ((400, 400), ROTATED, [200, 200], 0.0),
    "sheared": ((300, 600), [[450, 150], [60, 300]], [300, 150], 0.0),
    "stretched": ((1600, 250), [[0, 250], [1700, 0]], [125, 800], 0.0),
    "stretched, sheared, mirrored": ((1600, 300), [[60, 250], [-1500, 350]], [150, 800], 0.0),
    "bent": ((400, 300), [[0, 250], [420, 0]], [130, 200], 1e-3),
    "small": ((150, 120), [[0, 110], [130, 0]], [60, 75], 0.0),
}


def detected(picture):
    times = np.arange(len(picture.intensity))
    return detect(Scan(picture.intensity, times, "scan"), METHODS["centroid"])


@pytest.mark.parametrize("way", WAYS)
def test_every_point_with_its_id_and_place(drawn, way):
    shape, matrix, offset, bend = WAYS[way]
    picture = drawn(matrix, offset, shape, bend)
    found = detected(picture)
    assert found.doubt == ""
    np.testing.assert_array_equal(found.point, np.arange(15))
    dot = 0.01 * np.linalg.norm(matrix, axis=1)  # its diameter in pixels and lines
    np.testing.assert_array_less(np.abs(found.u_px - picture.truth[:, 0]), 0.06 * max(dot[0], 2.0))
    np.testing.assert_array_less(np.abs(found.line - picture.truth[:, 1]), 0.06 * max(dot[1], 2.0))


@pytest.mark.parametrize("covered", [(14,), (0,), (6, 7), (0, 4, 10)])
def test_covered_points_are_left_out(drawn, covered):
    found = detected(drawn([[0, 250], [420, 0]], [150, 200], covered=covered))
    np.testing.assert_array_equal(found.point, np.setdiff1d(np.arange(15), covered))


def test_column_beyond_the_scan_leaves_the_other_ids_right(drawn):
    picture = drawn([[500, 0], [0, 350]], [250, 150], (300, 400))  # points 4, 5 and 14 lie at u = 401
    found = detected(picture)
    np.testing.assert_array_equal(found.point, np.setdiff1d(np.arange(15), [4, 5, 14]))
    np.testing.assert_allclose(found.u_px, picture.truth[found.point, 0], atol=0.2)


def test_board_without_its_mark_is_doubtful(drawn):
    found = detected(drawn([[0, 250], [420, 0]], [150, 200], with_mark=False))
    assert "corner mark is not seen" in found.doubt
    assert len(found.point) == 0


def test_mark_beyond_the_scan_is_doubtful(drawn):
    found = detected(drawn([[-500, 0], [0, 350]], [230, 150], (300, 400)))  # the mark lies at u = 422
    assert "corner mark" in found.doubt
    assert len(found.point) == 0


@pytest.mark.parametrize("mirrored", [False, True])
def test_half_a_mark_at_the_scan_s_edge_is_enough(drawn, mirrored):
    matrix = np.array([[0.0, 250.0], [420.0, 0.0]])
    picture = drawn(matrix * ([[-1], [1]] if mirrored else 1), [150, 200])
    first = 38  # the line of the mark's middle
    cut_off = replace(picture, intensity=picture.intensity[first:], truth=picture.truth - [0, first])
    found = detected(cut_off)
    assert found.doubt == ""
    np.testing.assert_array_equal(found.point, np.arange(15))
    np.testing.assert_allclose(found.position, cut_off.truth, atol=0.3)


@pytest.mark.parametrize("with_mark", [False, True])
def test_a_mark_under_grass_is_not_taken_for_one_beyond_the_scan(drawn, with_mark):
    picture = drawn(ROTATED, [200, 190], (400, 400), with_mark=with_mark)
    corner = ROTATED @ [-0.385, 0.262] + [200, 190]  # below the scan's left edge once it is cut
    cut = int(corner[0]) + 10
    intensity = picture.intensity[:, cut:].copy()
    if not with_mark:
        u, line = (ROTATED @ [-0.385, -0.262] + [200 - cut, 190]).astype(int)
        intensity[line - 12 : line + 13, u - 12 : u + 13] = 4000 * 0.3
    found = detected(replace(picture, intensity=intensity))
    assert ("corner mark is not seen" in found.doubt) != with_mark


def ringed(dot, noise=8.0):
    """A dot of so much light, hardly a pixel wide and drawn out over lines with its ring, at (30.3, 81.4)."""
    jacobian = np.array([[90.0, 0.0], [300.0, 500.0]])  # the hole's radius is 0.0375 m: 3.4 pixels, 22 lines
    line, u = np.indices((160, 60))
    radius = np.linalg.norm((np.stack([u, line], axis=-1) - [30.3, 81.4]) @ np.linalg.inv(jacobian).T, axis=-1) / 0.0375
    ring = 3000 * np.exp(-(((radius - 1.3) / 0.3) ** 4))
    intensity = 200 + ring + dot * np.exp(-0.5 * (radius / 0.13) ** 2)
    return (intensity + noise * np.random.default_rng(0).standard_normal(u.shape)).astype(np.float32), jacobian


def test_a_dot_of_a_pixel_is_refined_without_the_ring_beside_it():
    intensity, jacobian = ringed(350.0)
    assert METHODS["centroid"](intensity, 30.0, 81.0) is None
    board = ring_board(RingsSection())
    found = dot_alone(intensity, np.array([30.0, 81.0]), jacobian, METHODS["centroid"], board)
    # a dot of a sigma of half a pixel, sampled and not integrated, is off by up to a tenth of the hole
    assert np.linalg.norm(np.linalg.inv(jacobian) @ (found - [30.3, 81.4])) < 0.1 * board.hole_radius_m


def test_a_hole_without_a_dot_has_none():
    intensity, jacobian = ringed(0.0)
    found = dot_alone(intensity, np.array([30.0, 81.0]), jacobian, METHODS["centroid"], ring_board(RingsSection()))
    assert np.isnan(found).all()


def test_ground_alone_has_no_board(drawn):
    found = detected(drawn([[0, 250], [420, 0]], [5000, 200]))
    assert found.doubt.startswith("no board")


def test_even_light_has_no_board():
    scan = Scan(np.full((50, 60), 7, dtype=np.float32), np.arange(50), "scan")
    assert detect(scan, METHODS["centroid"]).doubt.startswith("no board")


def test_tiny_scan_has_no_board():
    scan = Scan(np.zeros((3, 4), dtype=np.float32), np.arange(3), "scan")
    assert detect(scan, METHODS["centroid"]).doubt.startswith("no board")


def test_noise_of_a_dim_scan(drawn):
    picture = drawn([[0, 250], [420, 0]], [150, 200], noise=0.03)
    found = detected(picture)
    assert len(found.point) >= 12
    np.testing.assert_allclose(found.u_px, picture.truth[found.point, 0], atol=0.5)


OTHER_BOARDS = {
    "4 x 7": RingsSection.scaled(4, 7, 0.10),
    "7 x 4, mirrored": RingsSection.scaled(7, 4, 0.10),
    "2 x 3": RingsSection.scaled(2, 3, 0.20),
    "6 x 5, wide rows, thin rings": RingsSection(
        rows=6, columns=5, row_spacing_m=0.13, column_spacing_m=0.11, ring_outer_diameter_m=0.1
    ),
}


@pytest.mark.parametrize("name", OTHER_BOARDS)
def test_rings_of_any_rows_and_columns(name):
    section = OTHER_BOARDS[name]
    white = section.artwork().picture(0.002, 0.02).astype(np.float32)
    light = ndimage.zoom(ndimage.uniform_filter(0.05 + 0.75 * white, 3), (1.5, 0.8), order=1)
    scale = (np.array(light.shape) - 1) / (np.array(white.shape) - 1)
    truth = (section.points()[:, :2] / 0.002 + (np.array(white.shape[::-1]) - 1) / 2) * scale[::-1]
    if "mirrored" in name:
        light, truth = light[:, ::-1].copy(), truth * [-1, 1] + [light.shape[1] - 1, 0]
    found = detect(Scan((4000 * light).astype(np.float32), np.arange(len(light)), "scan"), METHODS["centroid"], section)
    assert found.doubt == ""
    np.testing.assert_array_equal(found.point, np.arange(len(truth)))
    np.testing.assert_allclose(found.position, truth, atol=0.5)


def test_rows_taken_for_columns_are_doubtful(drawn):
    found = detect(
        Scan(drawn([[0, 250], [420, 0]], [150, 200]).intensity, np.arange(400), "scan"),
        METHODS["centroid"],
        RingsSection(rows=2, columns=9),
    )
    assert found.doubt != ""
    assert len(found.point) == 0
