from dataclasses import replace

import numpy as np

from linepose.geometry import rotations
from linepose.simulation.settings import GroundSettings, WaveSettings
from linepose.simulation.trajectory import body_poses, schedule

STEP_S = 1e-4


def test_straight_pass_moves_along_its_heading(settings):
    straight = replace(settings, ground=GroundSettings(body_height_m=1.0))
    times = schedule(straight)
    (before, after), euler = body_poses(straight, [times.start_s[0], times.end_s[0]])
    heading = np.deg2rad(112.0)
    np.testing.assert_allclose(after - before, -0.2 * 6.0 * np.array([np.cos(heading), np.sin(heading), 0]), atol=1e-12)
    np.testing.assert_allclose(euler, [[0, 0, heading]] * 2, atol=1e-12)


def test_arc_follows_its_instantaneous_heading(settings):
    middle = schedule(settings).middle_s[2]
    time = middle + np.linspace(-2.5, 2.5, 11)
    ahead, behind = body_poses(settings, time + STEP_S)[0], body_poses(settings, time - STEP_S)[0]
    yaw = body_poses(settings, time)[1][:, 2]
    velocity = (ahead - behind)[:, :2] / (2 * STEP_S)
    # central differences err by step^2/6 of the third derivative, far below rounding: 1e-16 * 3 m / 1e-4 s
    np.testing.assert_allclose(velocity, -0.2 * np.stack([np.cos(yaw), np.sin(yaw)], axis=-1), atol=1e-10)


def test_rotation_on_the_spot_only_turns(spot_settings):
    times = schedule(spot_settings)
    position, euler = body_poses(spot_settings, np.linspace(times.start_s[0], times.end_s[0], 7))
    np.testing.assert_allclose(position, np.tile(position[0], (7, 1)), atol=1e-12)
    np.testing.assert_allclose(np.ptp(euler[:, 2]), 0.05 * 6.0, atol=1e-12)


def test_body_axis_is_normal_to_the_hill(settings):
    waves = (WaveSettings(0.5, 10.0, 0.4, 0.3), WaveSettings(0.2, 6.0, 2.0))
    hill = replace(settings, ground=GroundSettings(body_height_m=0.0, waves=waves))
    middle = schedule(hill).middle_s[0]
    centre, euler = body_poses(hill, middle)
    moved = []
    for north, east in ((1e-6, 0.0), (0.0, 1e-6)):
        one = replace(hill.passes[0], north_m=hill.passes[0].north_m + north, east_m=hill.passes[0].east_m + east)
        moved.append(body_poses(replace(hill, passes=(one, *hill.passes[1:])), middle)[0] - centre)
    normal = np.cross(*moved)
    axis = rotations.matrix_from_euler(euler)[:, 2]
    np.testing.assert_allclose(axis, normal / np.linalg.norm(normal), atol=1e-5)
    assert np.degrees(np.arccos(axis[2])) > 3


def test_channel_adds_its_roll(settings):
    times = schedule(settings)
    rolled = body_poses(settings, times.middle_s[1])[1]
    level = replace(settings, passes=tuple(replace(one, channel_roll_rad=0.0) for one in settings.passes))
    np.testing.assert_allclose(rolled - body_poses(level, times.middle_s[1])[1], [np.deg2rad(4), 0, 0], atol=1e-12)


def test_path_is_continuous_from_pass_to_pass(settings):
    time = np.arange(0.0, schedule(settings).survey_end_s, 0.01)
    position, euler = body_poses(settings, time)
    # the fastest stretch is a transfer; a smooth blend peaks at 1.5 times its mean speed
    assert np.linalg.norm(np.diff(position, axis=0), axis=1).max() < 0.01 * 0.5
    turn = (np.diff(euler[:, 2]) + np.pi) % (2 * np.pi) - np.pi
    assert np.abs(turn).max() < 0.01 * 1.5 * np.pi / settings.transfer_s + 0.01 * np.deg2rad(2)
