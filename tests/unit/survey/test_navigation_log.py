import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import Rotation

from linepose.errors import InputError
from linepose.geometry import rotations
from linepose.inputs.navigation.log_file import read_navigation_log
from linepose.survey.navigation_log import (
    NavigationLog,
    associate_poses,
    interpolated_pose,
    nearest_pose,
)
from linepose.survey.observations import EULER_COLUMNS, POSITION_COLUMNS

START_US = 1_466_000_000_000_000
COLUMNS = [*POSITION_COLUMNS, *EULER_COLUMNS]


def table(n=50, step_us=10_000):
    time_s = np.arange(n) * step_us / 1e6
    return pd.DataFrame(
        {
            "time_us": START_US + step_us * np.arange(n),
            "north_m": 6e6 + 3.0 * time_s,
            "east_m": 3e5 - time_s,
            "down_m": -40.0,
            "roll_rad": 0.1,
            "pitch_rad": -0.05,
            "yaw_rad": (3.1 + 0.5 * time_s + np.pi) % (2 * np.pi) - np.pi,
        }
    )


def log_of(values):
    return NavigationLog(
        values["time_us"].to_numpy(), values[list(POSITION_COLUMNS)].to_numpy(), values[list(EULER_COLUMNS)].to_numpy()
    )


def points(*times):
    return pd.DataFrame({"observation": 7, "point": np.arange(len(times)), "time_us": np.array(times, dtype=np.int64)})


@pytest.mark.parametrize("name", ["log.parquet", "log.csv"])
def test_both_kinds_of_file_give_the_same_log(tmp_path, name):
    values = table()
    writer = values.to_parquet if name.endswith("parquet") else values.to_csv
    writer(tmp_path / name, index=False)
    log = read_navigation_log(tmp_path / name)
    assert log.source == str(tmp_path / name)
    np.testing.assert_array_equal(log.time_us, values["time_us"])
    np.testing.assert_allclose(log.position_m, values[list(POSITION_COLUMNS)], rtol=1e-15)
    np.testing.assert_allclose(log.euler_rad, values[list(EULER_COLUMNS)], atol=1e-15)


def test_nearest_time_stamp():
    log = log_of(table())
    position, euler = nearest_pose(log, START_US + np.array([0, 4_900, 5_100, 14_999, 490_000]))
    rows = [0, 0, 1, 1, 49]
    np.testing.assert_array_equal(position, log.position_m[rows])
    np.testing.assert_array_equal(euler, log.euler_rad[rows])


def test_interpolation_follows_a_steady_drive_through_the_turn_of_yaw():
    log = log_of(table())
    time_s = np.array([0.0, 0.0033, 0.0832, 0.0877, 0.2, 0.49])
    position, euler = interpolated_pose(log, START_US + np.rint(time_s * 1e6).astype(np.int64))
    np.testing.assert_allclose(position[:, 0] - 6e6, 3.0 * time_s, atol=1e-8)
    np.testing.assert_allclose(position[:, 1] - 3e5, -time_s, atol=1e-9)
    expected = np.stack([np.full(6, 0.1), np.full(6, -0.05), 3.1 + 0.5 * time_s], axis=-1)
    # a steady yaw at constant roll and pitch turns about the vertical: the slerp is exact
    difference = rotations.rotation_angle_rad(rotations.matrix_from_euler(euler), rotations.matrix_from_euler(expected))
    np.testing.assert_allclose(difference, 0, atol=1e-7)


def test_interpolated_attitude_turns_at_a_constant_rate():
    ends = np.array([[0.3, -0.2, 1.0], [-0.4, 0.5, 2.0]])
    log = NavigationLog(np.array([START_US, START_US + 1000]), np.zeros((2, 3)), ends)
    _, euler = interpolated_pose(log, START_US + np.array([250]))
    first, last = (Rotation.from_matrix(rotations.matrix_from_euler(one)) for one in ends)
    expected = first * Rotation.from_rotvec(0.25 * (first.inv() * last).as_rotvec())
    np.testing.assert_allclose(rotations.matrix_from_euler(euler[0]), expected.as_matrix(), atol=1e-12)


def test_unordered_times_keep_their_poses():
    log = log_of(table())
    times = START_US + np.array([333_000, 12_000, 333_000, 4_000])
    one_by_one = np.concatenate([interpolated_pose(log, times[[i]])[1] for i in range(4)])
    np.testing.assert_allclose(interpolated_pose(log, times)[1], one_by_one, atol=1e-12)


def test_points_get_the_pose_columns():
    found = associate_poses(points(START_US + 5_000), log_of(table()), interpolated_pose, 0.05)
    assert list(found.columns) == ["observation", "point", "time_us", *COLUMNS]
    assert found["north_m"].iloc[0] == pytest.approx(6e6 + 0.015, abs=1e-8)


@pytest.mark.parametrize("offset", [-1, 490_001])
def test_observation_outside_the_log_is_named(offset):
    with pytest.raises(
        InputError, match=r"navigation: observation 7, point 1: found time .* within the navigation log"
    ):
        associate_poses(points(START_US, START_US + offset), log_of(table()), nearest_pose, 1.0)


def test_observation_in_a_gap_is_named():
    values = table().drop(index=range(20, 30))
    inside, beside = START_US + 250_000, START_US + 185_000
    with pytest.raises(InputError, match=r"navigation: observation 7, point 1: found a gap of 0.110 s"):
        associate_poses(points(beside, inside), log_of(values), nearest_pose, 0.1)
    assert len(associate_poses(points(beside), log_of(values), nearest_pose, 0.1)) == 1
    assert len(associate_poses(points(inside), log_of(values), nearest_pose, 0.2)) == 1


def test_rows_out_of_order_are_sorted_and_repeats_passed_over(tmp_path, caplog):
    table().iloc[[0, 2, 1, 1, 3]].to_csv(tmp_path / "log.csv", index=False)
    log = read_navigation_log(tmp_path / "log.csv")
    np.testing.assert_array_equal(log.time_us, table()["time_us"].to_numpy()[:4])
    np.testing.assert_allclose(log.position_m[:, 0], table()["north_m"].to_numpy()[:4])
    assert "1 records that repeat the one before are passed over; 2 records behind later ones are sorted" in caplog.text


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda t: t.drop(columns="yaw_rad"), "no column yaw_rad"),
        (lambda t: t.iloc[:1], "1 rows, expected two or more"),
        (
            lambda t: pd.concat([t.iloc[:2], t.iloc[[1]].assign(down_m=9.0), t.iloc[2:]]),
            r"row 3, time_us: found time .* with another pose, expected one pose at a time; remove one of the rows",
        ),
        (
            lambda t: t.assign(down_m=np.where(t.index == 4, np.nan, 0.0)),
            "row 5, down_m: found nothing",
        ),
        (lambda t: t.assign(yaw_rad=180.0), r"row 1, roll_rad to yaw_rad: found angles .*, expected radians"),
        (lambda t: t.assign(time_us=t["time_us"] // 1000), "they look like milliseconds"),
        (lambda t: t.assign(roll_rad="left"), "mend the file"),
    ],
)
@pytest.mark.parametrize("kind", ["parquet", "csv"])
def test_log_that_cannot_be_used(tmp_path, change, told, kind):
    path = tmp_path / f"log.{kind}"
    values = change(table())
    (values.to_parquet if kind == "parquet" else values.to_csv)(path, index=False)
    with pytest.raises(InputError, match=told):
        read_navigation_log(path)


@pytest.mark.parametrize("name", ["log.parquet", "log.csv"])
def test_file_of_another_kind(tmp_path, name):
    (tmp_path / name).write_bytes(bytes(range(256)))
    with pytest.raises(InputError, match=name):
        read_navigation_log(tmp_path / name)
    with pytest.raises(InputError, match="no such file"):
        read_navigation_log(tmp_path / f"other-{name}")
