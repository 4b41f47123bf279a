"""Advice on conventions, followed to the letter: what the message says goes into the platform file as it stands."""

import re
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
import yaml
from scipy.spatial.transform import Rotation

from linepose.check.conventions.examine import HandSigmas
from linepose.check.conventions.findings import convention_findings
from linepose.check.conventions.mistakes import usual_mistakes
from linepose.check.conventions.recording import Recording
from linepose.check.conventions.remedies import Remedy
from linepose.check.finding import Level
from linepose.check.hand_measured import hand_findings
from linepose.check.recorder import Recorder
from linepose.config.platform import Platform, load_platform
from linepose.geometry import rotations
from linepose.geometry.pose import euler_pose, rotation_vector_pose
from linepose.inputs.axes import FRD_FROM_FLU, NED_FROM_ENU
from linepose.pipeline.load import with_navigation
from linepose.survey.observations import EULER_COLUMNS, POSITION_COLUMNS, survey_from_table, table_from_survey
from unit.check.conftest import CONFIG
from unit.inputs import writers
from unit.recorded_files import simulated_survey, write_labelled_views

PASSES = slice(0, 12, 2)  # few, but of several headings and tilts
TURNS = 11  # more of an undoing whose order divides 12 are its inverse
SIGMAS = HandSigmas(0.1, float(np.deg2rad(2.0)))
SCANS = {"kind": "scans", "dataset": "mine"}
MISTAKES = {mistake.name: mistake for mistake in usual_mistakes()}
ALIKE = re.compile("the camera's axes are named otherwise: .* is its (?!y, -x, z|-x, -y, z|z, y, -x)")  # as others
REFUSED = "the log's angles are degrees"  # by the readers, where one of them is above 2 pi
IN_VIEWS = [  # of several together, those of ROS
    name
    for name, mistake in MISTAKES.items()
    if not (mistake.clock_shift_s or ALIKE.match(name) or name == REFUSED)
    and (mistake.n_changes == 1 or "attitude_axes" in mistake.corrections)
]


@dataclass(frozen=True)
class Made:
    """A survey without a mistake: its platform file's values, its table of points with poses, and its pose."""

    platform: Platform
    points: pd.DataFrame
    recording: Recording
    covariance: np.ndarray


@pytest.fixture(scope="module")
def made() -> Made:
    platform = load_platform(CONFIG / "platforms", "ladybird-sim")
    survey = simulated_survey(platform)
    survey = survey.select(survey.number[PASSES].tolist())
    points = table_from_survey(survey)[["observation", "point", "time_us", "u_px", *POSITION_COLUMNS, *EULER_COLUMNS]]
    recording = Recording(survey, platform.intrinsics(), platform.start_pose())
    return Made(platform, points, recording, np.nanmean(survey.covariance, axis=(0, 1)))


@dataclass
class Files:
    """A platform's files in a folder, whose file can be changed key by key."""

    folder: Path
    keys: dict
    points: pd.DataFrame

    def platform(self) -> Platform:
        (self.folder / "mine.yaml").write_text(yaml.safe_dump(self.keys))
        return load_platform(self.folder, "mine")

    def follow(self, words: str) -> None:
        """Write what one piece of advice says."""
        told = re.search(r"set (.*)", words)[1]
        for key, value in re.findall(r"([a-z_]+(?:\.[a-z_]+)+): (\[.*?\]|\S+?)(?= and |$)", told):
            *above, last = key.split(".")
            below = self.keys
            for name in above:
                below = below.setdefault(name, {})
            below[last] = yaml.safe_load(value)

    def findings(self, mistake):
        """What the doctor says, of this mistake alone."""
        platform = self.platform()
        recorder = Recorder(platform, self.folder, self.points, with_navigation(self.points, platform, self.folder))
        return convention_findings(platform, recorder.at, recorder.of, SIGMAS, [mistake])

    def check_followed(self, mistake) -> str:
        """The advice, after each of its ways was followed and the check was content."""
        (told,) = self.findings(mistake)
        assert told.level == Level.ERROR
        values = yaml.safe_load(yaml.safe_dump(self.keys))
        for words in re.split(r"; or, ", told.advice):
            self.keys = yaml.safe_load(yaml.safe_dump(values))
            self.follow(words)
            (after,) = self.findings(mistake)
            assert after.level == Level.OK, (told, after, self.keys)
            platform = self.platform()
            survey = survey_from_table(with_navigation(self.points, platform, self.folder))
            of_hand, _ = hand_findings(
                survey, platform.intrinsics(), platform.start_pose(), platform.start_covariance()
            )
            assert {one.level for one in of_hand} == {Level.OK}
        return told.advice


def files(made: Made, folder: Path, source: dict, **changes) -> Files:
    """Files of covariances, and of nothing else yet."""
    values = made.platform.model_dump(mode="json", include={"camera", "hand_measured"})
    values |= {"source": source, "navigation": {"maximum_pose_gap_s": 1e4}} | changes
    write_labelled_views(folder, made.recording.survey, made.covariance)
    return Files(folder, values, made.points)


def with_poses(points: pd.DataFrame, position: np.ndarray, euler: np.ndarray) -> pd.DataFrame:
    return points.assign(
        **dict(zip(POSITION_COLUMNS, position.T, strict=True)), **dict(zip(EULER_COLUMNS, euler.T, strict=True))
    )


def planted(mistake, recording: Recording) -> Recording:
    """The recording with the mistake: what undoes it, made backwards."""
    survey = recording.survey
    euler = survey.euler_rad
    if mistake.corrections == ("radians_twice",):
        return replace(recording, survey=replace(survey, euler_rad=np.radians(euler)))
    if mistake.corrections == ("angles_xyz",):
        return replace(recording, survey=replace(survey, euler_rad=other_order(euler)))
    six = euler_pose(recording.pose)
    if "angles are radians" in mistake.name:
        return replace(recording, pose=of_euler(six[:3], np.radians(six[3:])))
    if "hand-measured angles turn in the order" in mistake.name:
        return replace(recording, pose=of_euler(six[:3], other_order(six[3:])))
    for _ in range(TURNS):
        recording = mistake.undo(recording)
    return recording


def of_euler(position: np.ndarray, euler: np.ndarray) -> np.ndarray:
    return rotation_vector_pose(np.concatenate([position, euler]))


def other_order(euler_rad: np.ndarray) -> np.ndarray:
    """Angles of a program that composes them as Rx Ry Rz."""
    turns = Rotation.from_euler("ZYX", euler_rad.reshape(-1, 3)[:, ::-1])
    return turns.as_euler("XYZ").reshape(euler_rad.shape)


@pytest.mark.parametrize("name", IN_VIEWS)
def test_advice_on_every_mistake_in_labelled_views_helps(made, tmp_path, name):
    mistake = MISTAKES[name]
    bad = planted(mistake, made.recording)
    mine = files(made, tmp_path / "mine", {"kind": "labelled_views", "dataset": "mine"})
    six = euler_pose(bad.pose)
    mine.keys["hand_measured"] |= {"position_m": six[:3].tolist(), "euler_deg": np.degrees(six[3:]).tolist()}
    mine.keys["camera"]["principal_point_px"] = bad.camera.principal_point_px
    seen = np.isfinite(bad.survey.u_px)
    mine.points = with_poses(
        made.points, (bad.survey.position_m + bad.survey.origin_m)[seen], bad.survey.euler_rad[seen]
    )
    mine.check_followed(mistake)


def poses(made: Made) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Times, positions and angles at the points, in the order of time."""
    table = made.points.sort_values("time_us").drop_duplicates("time_us")
    columns = table[list(POSITION_COLUMNS)].to_numpy(), table[list(EULER_COLUMNS)].to_numpy()
    return table["time_us"].to_numpy(), *columns


def enu_flu(euler: np.ndarray) -> np.ndarray:
    """Angles of forward, left, up in east, north, up."""
    return rotations.euler_from_matrix(NED_FROM_ENU @ rotations.matrix_from_euler(euler) @ FRD_FROM_FLU)


TABLES = {
    "positions_enu": (lambda p, e: (p[:, [1, 0, 2]] * [1, 1, -1], e), "set source.navigation.coordinates: enu"),
    "north_east_swapped": (
        lambda p, e: (p[:, [1, 0, 2]], e),
        "set source.navigation.columns.position: [east_m, north_m, down_m]",
    ),
    "attitude_axes": (lambda p, e: (p, enu_flu(e)), "set source.navigation.attitude_axes: enu"),
    "positions_enu attitude_axes": (
        lambda p, e: (p[:, [1, 0, 2]] * [1, 1, -1], enu_flu(e)),
        "set source.navigation.coordinates: enu and source.navigation.attitude_axes: enu",
    ),
    "roll_pitch_swapped": (
        lambda p, e: (p, e[:, [1, 0, 2]]),
        "set source.navigation.columns.attitude: [pitch_rad, roll_rad, yaw_rad]",
    ),
    "yaw_sign": (lambda p, e: (p, e * [1, 1, -1]), "set navigation.corrections: [yaw_sign]"),
    "height_up": (lambda p, e: (p * [1, 1, -1], e), "set navigation.corrections: [height_up]"),
}


def of_names(names: str):
    return next(one for one in usual_mistakes() if one.corrections == tuple(names.split()))


@pytest.mark.parametrize("names", TABLES)
def test_advice_on_a_table_names_its_own_keys(made, tmp_path, names):
    plant, advice = TABLES[names]
    mine = files(made, tmp_path / "mine", SCANS | {"navigation": {"format": "table", "file": "log.csv"}})
    mine.keys["source"]["covariances"] = "nav_covs.csv"
    time_us, position, euler = poses(made)
    log = with_poses(pd.DataFrame({"time_us": time_us}), *plant(position, euler))
    log.to_csv(mine.folder / "log.csv", index=False)
    assert mine.check_followed(of_names(names)) == advice


def test_yaw_counter_clockwise_from_north_in_a_table_of_east_north_up(made, tmp_path):
    keys = {"format": "table", "file": "log.csv", "coordinates": "enu", "attitude_axes": "enu"}
    mine = files(made, tmp_path / "mine", SCANS | {"navigation": keys, "covariances": "nav_covs.csv"})
    time_us, position, euler = poses(made)
    from_north = enu_flu(euler) - [0, 0, np.pi / 2]
    log = with_poses(pd.DataFrame({"time_us": time_us}), position[:, [1, 0, 2]] * [1, 1, -1], from_north)
    log.to_csv(mine.folder / "log.csv", index=False)
    assert mine.check_followed(of_names("yaw_minus_90")) == "set navigation.corrections: [yaw_minus_90]"


@pytest.mark.parametrize(
    ("is_in_ned", "names", "advice"),
    [
        ((True, True), "positions_enu attitude_axes", "set source.navigation.attitude_axes: ned"),
        ((False, True), "attitude_axes", "set navigation.corrections: [attitude_axes]"),
    ],
    ids=["all in north, east, down", "attitude in north, east, down in a log of east, north, up"],
)
def test_advice_on_a_bag_names_its_own_key(made, tmp_path, is_in_ned, names, advice):
    mine = files(made, tmp_path / "mine", SCANS | {"navigation": {"format": "rosbag", "file": "log.bag"}})
    mine.keys["source"]["covariances"] = "nav_covs.csv"
    time_us, position, euler = poses(made)
    world = position if is_in_ned[0] else position[:, [1, 0, 2]] * [1, 1, -1]
    turns = Rotation.from_euler("ZYX", euler[:, ::-1]).as_quat()
    with writers.Bag(mine.folder / "log.bag", 1) as bag:
        for row, time in enumerate(time_us):
            bag.odometry("/odometry", time, world[row], turns[row], np.zeros((6, 6)))
    assert mine.check_followed(of_names(names)) == advice


@pytest.mark.parametrize("late_s", [18, -18])
def test_clock_of_the_other_time_scale_is_moved_by_a_key(made, tmp_path, late_s):
    mine = files(made, tmp_path / "mine", SCANS | {"navigation": {"format": "table", "file": "log.csv"}})
    mine.keys["source"] |= {"covariances": "nav_covs.csv"}
    mine.keys["navigation"]["maximum_gap_s"] = 100.0
    time_us, position, euler = poses(made)
    log = with_poses(pd.DataFrame({"time_us": time_us}), position, euler)
    around = log.iloc[[0, *range(len(log)), -1]].assign(time_us=[time_us[0] - 10**8, *time_us, time_us[-1] + 10**8])
    around.to_csv(mine.folder / "log.csv", index=False)
    mistake = next(one for one in usual_mistakes() if one.clock_shift_s == -late_s)
    mine.points = made.points.assign(time_us=made.points["time_us"] + late_s * 1_000_000)
    (told,) = mine.findings(mistake)
    assert told.advice == f"set source.time_offset_s: {float(-late_s)}"


def test_a_correction_that_is_there_already_is_taken_away(made, tmp_path):
    mine = files(made, tmp_path / "mine", {"kind": "labelled_views", "dataset": "mine"})
    mine.keys["navigation"]["corrections"] = ["pitch_sign"]
    assert mine.check_followed(of_names("pitch_sign")) == "set navigation.corrections: []"


def test_what_makes_the_fit_worse_is_not_advised(made, tmp_path, monkeypatch):
    """Advice that was tried and does not help is withheld, whatever the doctor thinks of the mistake."""
    mine = files(made, tmp_path / "mine", {"kind": "labelled_views", "dataset": "mine"})
    mine.points = mine.points.assign(pitch_rad=-mine.points["pitch_rad"])
    wrong = Remedy({"navigation.corrections": ["roll_sign"]})
    monkeypatch.setattr("linepose.check.conventions.findings.remedies", lambda *_: (wrong,))
    (told,) = mine.findings(of_names("pitch_sign"))
    assert (told.level, told.advice.split()[0]) == (Level.WARNING, "convert")
