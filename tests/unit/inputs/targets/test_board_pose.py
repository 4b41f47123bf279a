"""Where a board stands, from its points in one scan of a camera whose line is tilted and bent."""

import numpy as np

from linepose.geometry import rotations
from linepose.geometry.camera import Camera, off_line, pixel_from_normalised
from linepose.inputs.rectified.rectify import LinePoses
from linepose.inputs.targets.board_pose import fit_board_pose
from linepose.inputs.targets.surfaces import plane

BENT = Camera(
    field_of_view_deg=40, n_pixels=600, principal_point_px=299.5, k1=-0.1, p2=0.01, tilt=0.02, smile=0.2, k3=0.05
)


def test_a_board_is_found_through_a_bent_line():
    n_lines = 400
    centre = np.stack([np.zeros(n_lines), np.linspace(-0.8, 0.8, n_lines), np.zeros(n_lines)], axis=-1)
    poses = LinePoses(centre, np.broadcast_to(np.eye(3), (n_lines, 3, 3)))
    board = np.stack(np.meshgrid(np.linspace(-0.4, 0.4, 5), np.linspace(-0.3, 0.3, 4)), axis=-1).reshape(-1, 2)
    turn = rotations.matrix_from_euler(np.array([0.1, -0.15, 0.4]))
    origin = np.array([0.02, 0.03, 2.0])
    world = origin + board @ turn[:, :2].T
    # the line whose off_line is none: the camera moves along its y, so that y falls by what it moves
    moved = off_line(BENT, world)
    line = np.interp(moved, centre[:, 1], np.arange(n_lines))
    seen = world - np.stack([0 * moved, moved, 0 * moved], axis=-1)
    position = np.stack([pixel_from_normalised(BENT, seen[:, 0] / seen[:, 2]), line], axis=-1)
    start = plane(np.array([0.0, 0.0, 1.8]), np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0]))
    found = fit_board_pose(board, position, poses, BENT, [start])
    np.testing.assert_allclose(found.world(board), world, atol=1e-6)
    assert found.misfit_px.max() < 1e-3
