"""Rectified scans: each cell leads back to the raw pixel and line that saw it."""

import numpy as np
import pytest

from linepose.errors import InputError
from linepose.geometry import rotations
from linepose.geometry.camera import Camera, rays
from linepose.inputs.rectified.rectify import line_poses, rectify
from linepose.inputs.rectified.surface import flat_ground

HEIGHT_M, CELL_M = 2.0, 0.004
LOOKS_DOWN = rotations.rotation_vector_from_matrix(np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]))
POSE = np.concatenate([[0.3, -0.1, 0.05], LOOKS_DOWN])


def camera(n_pixels=200, **lens):
    return Camera(
        focal_length_m=8e-3, pixel_pitch_m=16e-6, n_pixels=n_pixels, principal_point_px=(n_pixels - 1) / 2, **lens
    )


def drive(n_lines, length_m=1.0, backwards=False):
    """Body poses of a drive that weaves, sways and speeds up."""
    share = np.linspace(0, 1, n_lines)
    north = length_m * (0.6 * share + 0.4 * share**2) * (-1 if backwards else 1)
    position = np.stack([north, 0.03 * np.sin(5 * share), np.full(n_lines, -HEIGHT_M)], axis=-1)
    euler = np.stack([0.02 * np.sin(9 * share), 0.01 * np.cos(7 * share), 0.1 + 0.05 * np.sin(4 * share)], axis=-1)
    return position, euler


def chess(points_m, square_m=0.08):
    return np.where(np.floor(points_m[..., :2] / square_m).astype(int).sum(axis=-1) % 2, 3000.0, 300.0)


def scanned(lens, position, euler):
    """What the camera sees of ground that is a chessboard."""
    body = rotations.matrix_from_euler(euler)[:, None]
    matrix = rotations.matrix_from_rotation_vector(POSE[3:])
    centre, direction = rays(lens, matrix, POSE[:3], body, position[:, None], np.arange(lens.n_pixels))
    ground = centre - centre[..., 2:] / direction[..., 2:] * direction
    return chess(ground).astype(np.float32)


@pytest.mark.parametrize("distortion", [{}, {"k1": 0.1, "p2": 0.02, "tilt": 0.05, "smile": 1.0}], ids=["ideal", "bent"])
@pytest.mark.parametrize("backwards", [False, True])
@pytest.mark.parametrize("n_lines", [150, 1500])
def test_every_cell_leads_back_to_a_tenth_of_a_pixel_and_shows_the_ground(n_lines, backwards, distortion):
    lens, (position, euler) = camera(**distortion), drive(n_lines, backwards=backwards)
    poses = line_poses(position, euler, POSE)
    rectified = rectify(scanned(lens, position, euler), poses, lens, flat_ground(0.0), CELL_M)
    row, column = np.nonzero(np.isfinite(rectified.line))
    assert len(row) > 0.5 * rectified.line.size
    line, u_px = rectified.line[row, column], rectified.u_px[row, column].astype(float)
    at = [
        np.stack([np.interp(line, np.arange(n_lines), one) for one in values.T], axis=-1)
        for values in (position, euler)
    ]
    matrix = rotations.matrix_from_rotation_vector(POSE[3:])
    body = rotations.matrix_from_euler(at[1])
    centre, direction = rays(lens, matrix, POSE[:3], body, at[0], u_px)
    ground = centre - centre[..., 2:] / direction[..., 2:] * direction
    world = rectified.world(np.stack([column, row], axis=-1))
    inside = (line > 0) & (line < n_lines - 1)
    footprint = HEIGHT_M / lens.focal_length_px
    assert np.linalg.norm(ground - world, axis=-1)[inside].max() < 0.1 * footprint
    clear = np.abs((world[:, :2] / 0.08 + 0.5) % 1 - 0.5).min(axis=-1) > 0.15  # of a square, from its edges
    seen = rectified.intensity[row, column][clear & inside]
    assert np.mean((seen > 1650) == (chess(world)[clear & inside] > 1650)) > 0.999


def test_a_map_is_of_what_a_pixel_sees_by_default_and_bounded():
    lens, (position, euler) = camera(), drive(100)
    poses, scan = line_poses(position, euler, POSE), np.ones((100, 200), dtype=np.float32)
    assert rectify(scan, poses, lens, flat_ground(0.0)).cell_m == pytest.approx(HEIGHT_M / 500, rel=0.05)
    with pytest.raises(InputError, match="at most 40000000 cells"):
        rectify(scan, poses, lens, flat_ground(0.0), 1e-5)
    with pytest.raises(InputError, match="no ray that meets"):
        rectify(scan, poses, lens, flat_ground(-10.0))
