"""Each usual mistake, planted by hand, is named; data without a mistake are left in peace."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from linepose.check.conventions.examine import Examination, Explanation, HandSigmas, examine
from linepose.check.conventions.mistakes import AS_GIVEN, GPS_MINUS_UTC_S, usual_mistakes
from unit.check.conventions.conftest import Recorded

SIGMAS = HandSigmas(0.1, float(np.deg2rad(2.0)))


def with_survey(recording, **changes):
    return replace(recording, survey=replace(recording.survey, **changes))


def with_angles(recording, change):
    return with_survey(recording, euler_rad=change(*np.moveaxis(recording.survey.euler_rad, -1, 0)))


def with_columns(recording, *columns):
    """Position columns in another order, with a sign: (2, 1, -3) for east, north, up."""
    position = recording.survey.position_m
    return with_survey(
        recording, position_m=np.stack([np.sign(c) * position[..., abs(c) - 1] for c in columns], axis=-1)
    )


def stacked(*angles):
    return np.stack(angles, axis=-1)


def with_hand(recording, position, rotation):
    return replace(recording, pose=np.concatenate([position, rotation.as_rotvec()]))


def ros(recording):
    turned = with_angles(recording, lambda roll, pitch, yaw: stacked(roll, -pitch, np.pi / 2 - yaw))
    return with_columns(turned, 2, 1, -3)


def other_order(recording):
    """Angles of a program that composes them as Rx Ry Rz."""
    euler = recording.survey.euler_rad
    rotation = Rotation.from_euler("ZYX", euler.reshape(-1, 3)[:, ::-1])
    return with_survey(recording, euler_rad=rotation.as_euler("XYZ").reshape(euler.shape))


def inverted(recording):
    euler = recording.survey.euler_rad
    rotation = Rotation.from_euler("ZYX", euler.reshape(-1, 3)[:, ::-1]).inv()
    return with_survey(recording, euler_rad=rotation.as_euler("ZYX")[:, ::-1].reshape(euler.shape))


def hand(recording):
    return recording.pose[:3], Rotation.from_rotvec(recording.pose[3:])


def in_left_up(recording):
    position, rotation = hand(recording)
    return with_hand(recording, position * [1, -1, -1], Rotation.from_euler("x", np.pi) * rotation)


def in_right_forward_up(recording):
    position, rotation = hand(recording)
    axes = Rotation.from_matrix([[0, 1, 0], [1, 0, 0], [0, 0, -1]])
    return with_hand(recording, axes.apply(position), axes * rotation)


def in_radians(recording):
    position, rotation = hand(recording)
    return with_hand(recording, position, Rotation.from_euler("ZYX", np.deg2rad(rotation.as_euler("ZYX"))))


def hand_in_other_order(recording):
    position, rotation = hand(recording)
    return with_hand(recording, position, Rotation.from_euler("ZYX", rotation.as_euler("XYZ")[::-1]))


def turned_camera(about, angle):
    def plant(recording):
        position, rotation = hand(recording)
        return with_hand(recording, position, rotation * Rotation.from_euler(about, angle))

    return plant


PLANTED = {
    "positions are east, north, up where": lambda r: with_columns(r, 2, 1, -3),
    "north and east are swapped": lambda r: with_columns(r, 2, 1, 3),
    "the height counts upwards": lambda r: with_columns(r, 1, 2, -3),
    "roll has the other sign": lambda r: with_angles(r, lambda a, b, c: stacked(-a, b, c)),
    "pitch has the other sign": lambda r: with_angles(r, lambda a, b, c: stacked(a, -b, c)),
    "yaw has the other sign": lambda r: with_angles(r, lambda a, b, c: stacked(a, b, -c)),
    "counter-clockwise from east": lambda r: with_angles(r, lambda a, b, c: stacked(a, b, np.pi / 2 - c)),
    "yaw is a quarter of a turn too large": lambda r: with_angles(r, lambda a, b, c: stacked(a, b, c + np.pi / 2)),
    "yaw is a quarter of a turn too small": lambda r: with_angles(r, lambda a, b, c: stacked(a, b, c - np.pi / 2)),
    "yaw counts from south": lambda r: with_angles(r, lambda a, b, c: stacked(a, b, c + np.pi)),
    "roll and pitch are swapped": lambda r: with_angles(r, lambda a, b, c: stacked(b, a, c)),
    "(ROS) where": ros,
    "the log's angles turn in the order x, y, z": other_order,
    "from world to body": inverted,
    "the log's angles are degrees": lambda r: with_angles(r, lambda *angles: np.rad2deg(stacked(*angles))),
    "converted to radians twice": lambda r: with_angles(r, lambda *angles: np.deg2rad(stacked(*angles))),
    "body frame of forward, left, up": in_left_up,
    "right, forward, up": in_right_forward_up,
    "the hand-measured height": lambda r: replace(r, pose=r.pose * [1, 1, -1, 1, 1, 1]),
    "the hand-measured angles are radians": in_radians,
    "the hand-measured angles turn in the order": hand_in_other_order,
    "from body to camera": lambda r: with_hand(r, r.pose[:3], Rotation.from_rotvec(-r.pose[3:])),
    "the body's in the camera frame": lambda r: with_hand(
        r, -Rotation.from_rotvec(-r.pose[3:]).apply(r.pose[:3]), Rotation.from_rotvec(-r.pose[3:])
    ),
    "the scan line is flipped": lambda r: with_survey(r, u_px=647 - r.survey.u_px),
    "is its -x, -y, z": turned_camera("z", np.pi),
    "is its y, -x, z": turned_camera("z", np.pi / 2),
    "is its -y, x, z": turned_camera("z", -np.pi / 2),
    "is its z, y, -x": turned_camera("y", -np.pi / 2),
    "is its x, -y, -z": turned_camera("x", np.pi),
}


def test_data_without_a_mistake_are_left_in_peace(recording):
    found = examine(Recorded(recording), SIGMAS)
    assert not found.is_mistaken
    assert found.best == (found.as_given,)


@pytest.mark.parametrize("name", PLANTED)
def test_planted_mistake_is_named(recording, name):
    """Among the best, which are few; nothing that the pose tells apart from it is."""
    found = examine(Recorded(PLANTED[name](recording)), SIGMAS)
    named = [one.mistake.name for one in found.best]
    assert any(name in one for one in named), [(e.mistake.name, e.neg_log_posterior) for e in found.explanations[:5]]
    assert len(named) <= 4
    assert found.best[0].mean_error_px < 15


@pytest.mark.parametrize("shift_s", [GPS_MINUS_UTC_S, -GPS_MINUS_UTC_S])
def test_clock_of_the_other_time_scale_is_named(recording, shift_s):
    found = examine(Recorded(recording, right_shift_s=shift_s), SIGMAS)
    (best,) = found.best
    assert best.mistake.clock_shift_s == shift_s
    assert "GPS" in best.mistake.name
    assert np.isnan(found.as_given.mean_error_px)


@pytest.mark.parametrize(
    ("given_px", "undone_px", "believed"),
    [(3.0, 1.0, True), (200.0, 18.0, True), (50.0, 18.0, False), (824.0, 60.0, False), (np.nan, 4.0, True)],
)
def test_a_mistake_is_believed_only_where_undoing_it_makes_the_points_fit(given_px, undone_px, believed):
    given = Explanation(AS_GIVEN, 1e4, given_px, np.zeros(6))
    undone = Explanation(usual_mistakes()[0], 1e3, undone_px, np.zeros(6))
    assert Examination((undone, given), given).is_mistaken == believed


def test_points_behind_the_camera_are_no_explanation(recording):
    backwards = next(one for one in usual_mistakes() if "is its -x, y, -z" in one.name)
    found = examine(Recorded(recording), SIGMAS, [backwards])
    assert found.explanations[-1].neg_log_posterior == np.inf


def test_names_are_different():
    names = [mistake.name for mistake in usual_mistakes()]
    assert len(set(names)) == len(names)
