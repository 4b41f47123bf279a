"""Mistakes that a newcomer makes, planted one by one: each is named, with what to do; the clean files pass."""

import re

import numpy as np
import pandas as pd
import pytest
import yaml

from linepose.check.finding import Level
from linepose.check.platform import check_platform

VIEW_COLUMNS = ["time_us", "point", "u_px", "north", "east", "down", "roll", "pitch", "yaw"]
HOUR_US = 3_600_000_000


@pytest.fixture(scope="module")
def clean_report(clean_project):
    return check_platform("mine", clean_project)


def change_views(root, change):
    """Apply a change to the table of every view file."""
    for path in sorted((root / "data" / "mine" / "labelled_points").glob("*.csv")):
        table = pd.read_csv(path, header=None, names=VIEW_COLUMNS)
        change(table)
        table.to_csv(path, header=False, index=False)


def change_covariances(root, change):
    """Apply a change to times (K,) and matrices (K, 12, 12) of the covariance file."""
    path = root / "data" / "mine" / "nav_covs.csv"
    table = pd.read_csv(path, header=None)
    times, matrices = table[0].to_numpy().copy(), table.iloc[:, 1:].to_numpy(dtype=float, copy=True)
    times, matrices = change(times, matrices.reshape(-1, 12, 12))
    pd.concat([pd.Series(times), pd.DataFrame(matrices.reshape(-1, 144))], axis=1).to_csv(
        path, header=False, index=False
    )


def change_platform(root, change):
    path = root / "config" / "platforms" / "mine.yaml"
    values = yaml.safe_load(path.read_text())
    change(values)
    path.write_text(yaml.safe_dump(values))


def degrees(root):
    change_views(root, lambda t: t.update(np.degrees(t[["roll", "pitch", "yaw"]])))


def seconds(root):
    change_views(root, lambda t: t.__setitem__("time_us", t["time_us"] // 1_000_000))


def latitude(root):
    def change(t):
        t["north"], t["east"] = t["north"] / 111_000 - 90, t["east"] / 111_000

    change_views(root, change)


def other_sensor(root):
    change_platform(root, lambda p: p["camera"].update(n_pixels=320, principal_point_px=160.0))


def twice(root):
    path = sorted((root / "data" / "mine" / "labelled_points").glob("*.csv"))[2]
    path.write_text(path.read_text() + path.read_text().splitlines()[0] + "\n")


def change_view(root, change):
    """Apply a change to the table of the third view file."""
    path = sorted((root / "data" / "mine" / "labelled_points").glob("*.csv"))[2]
    table = pd.read_csv(path, header=None, names=VIEW_COLUMNS)
    change(table)
    table.to_csv(path, header=False, index=False)


def exchanged(root):
    change_view(root, lambda t: t.__setitem__("point", t["point"].replace({6: 7, 7: 6})))


def wrong_dot(root):
    """Point 12's label lies where 11 was, which has none."""

    def change(t):
        t["point"] = t["point"].replace({11: 12, 12: 11})
        t.loc[t["point"] == 11, "u_px"] = np.nan

    change_view(root, change)


def one_dot(root):
    def change(t):
        t.loc[t["point"] == 6, t.columns != "point"] = t[t["point"] == 7].drop(columns="point").to_numpy()

    change_view(root, change)


def mistyped(root):
    change_view(root, lambda t: t.__setitem__("point", t["point"].astype(str).replace({"6": "1e6"})))


def lopsided(root):
    def change(times, matrices):
        matrices[5, 0, 1] += 0.5 * matrices[5, 0, 0]
        return times, matrices

    change_covariances(root, change)


def square_degrees(root):
    def change(times, matrices):
        matrices[:, 3:6, 3:6] *= np.degrees(1.0) ** 2
        return times, matrices

    change_covariances(root, change)


def gps_clock(root):
    """A log that starts and ends with the survey, in GPS time."""
    change_covariances(root, lambda times, matrices: (times + HOUR_US, matrices))


def hours(root):
    change_covariances(root, lambda times, matrices: (times + 10 * HOUR_US, matrices))


def cut_short(root):
    change_covariances(root, lambda times, matrices: (times[:-30], matrices[:-30]))


def other_columns(root):
    """What the chosen columns hold looks like a velocity, 6-8 like an attitude."""

    def change(times, matrices):
        matrices[:, range(3, 6), range(3, 6)] = np.array([4e-3, 4e-3, 3e-3]) ** 2
        matrices[:, range(6, 9), range(6, 9)] = np.radians([0.01, 0.01, 0.1]) ** 2
        return times, matrices

    change_covariances(root, change)


def behind(root):
    change_platform(root, lambda p: p["hand_measured"].update(euler_deg=[124.0, 0.0, -90.0]))


def far_off(root):
    change_platform(root, lambda p: p["hand_measured"].update(euler_deg=[-20.0, 15.0, -90.0]))


def millimetres(root):
    change_platform(root, lambda p: p["camera"].update(focal_length_m=8.2))


def tape_in_mm(root):
    change_platform(root, lambda p: p["hand_measured"].update(position_m=[200, 0, -800]))


def roll_sign(root):
    change_views(root, lambda t: t.__setitem__("roll", -t["roll"]))


def flipped_line(root):
    change_views(root, lambda t: t.__setitem__("u_px", 647 - t["u_px"]))


def from_east(root):
    change_views(root, lambda t: t.__setitem__("yaw", np.pi / 2 - t["yaw"]))


def no_covariances(root):
    (root / "data" / "mine" / "nav_covs.csv").unlink()


def no_folder(root):
    (root / "data" / "mine").rename(root / "data" / "yours")


PLANTED = {
    degrees: (Level.ERROR, "body pose", "beyond 2 pi", "degrees to radians"),
    seconds: (Level.ERROR, "view files", r"\(and 11 more like it\)", "look like seconds"),
    latitude: (Level.ERROR, "body pose", "latitude and longitude", "metres"),
    other_sensor: (Level.ERROR, "labels", "outside the sensor's 320", "camera.n_pixels"),
    twice: (Level.ERROR, "labels", r"twice in an observation.*view003.csv, row 16", "keep one row"),
    exchanged: (Level.WARNING, "labels", "exchanged: 6 and 7 in observation 3$", "exchange the two labels"),
    wrong_dot: (Level.WARNING, "labels", "another point is expected: 12 at 11 in observation 3$", "correct or remove"),
    one_dot: (Level.ERROR, "labels", "on one dot: [67] and [67] of observation 3$", "on its own dot"),
    mistyped: (Level.WARNING, "labels", "point 1000000: seen once only", "check its name"),
    lopsided: (Level.ERROR, "covariances", "row 6", "column order"),
    square_degrees: (Level.WARNING, "covariances", "angle sigmas", "deg2"),
    hours: (Level.ERROR, "time", "no point lies within", "time zone of 10 h"),
    gps_clock: (Level.ERROR, "time", "no point lies within", "time zone of 1 h"),
    cut_short: (Level.ERROR, "time", "of 180 points", "complete the navigation log"),
    other_columns: (Level.WARNING, "attitude columns", "columns 6-8", r"covariance_columns: \[6, 7, 8\]"),
    behind: (Level.ERROR, "hand measurement", "behind the camera", "first follow the advice on conventions"),
    far_off: (Level.WARNING, "hand measurement", "its sigmas explain", "zyx intrinsic"),
    millimetres: (Level.ERROR, "camera", "8.2 m", "metres"),
    tape_in_mm: (Level.ERROR, "hand measurement", "825 m from the body's origin", "in metres"),
    from_east: (Level.WARNING, "body pose", "off its heading", "first follow the advice on conventions"),
    roll_sign: (Level.ERROR, "conventions", "roll has the other sign", r"set navigation.corrections: \[roll_sign\]$"),
    flipped_line: (Level.ERROR, "conventions", "scan line is flipped", r"set hand_measured.euler_deg: \["),
    no_covariances: (Level.ERROR, "covariances", "no such file", "restore it"),
    no_folder: (Level.ERROR, "data set", "no folder mine", "put them in"),
}


def test_clean_files_pass(clean_report):
    assert clean_report.of(Level.ERROR) == ()
    assert {"platform file", "camera", "labels", "covariances", "time", "body pose", "hand measurement"} <= {
        finding.subject for finding in clean_report.of(Level.OK)
    }
    assert [one.name for one in clean_report.predicted][:3] == ["r_x", "r_y", "r_z"]


@pytest.mark.parametrize("plant", PLANTED, ids=lambda plant: plant.__name__)
def test_planted_mistake_is_named(project, plant):
    plant(project)
    level, subject, found, advice = PLANTED[plant]
    mine = [f for f in check_platform("mine", project).of(level) if f.subject == subject and re.search(found, f.found)]
    assert len(mine) == 1
    assert re.search(advice, mine[0].advice)


def test_a_tape_in_millimetres_is_told_alone(project):
    tape_in_mm(project)
    (told,) = [one for one in check_platform("mine", project).findings if one.level > Level.OK and one.advice]
    assert "in metres" in told.advice


def test_only_one_finding_advises_what_to_change(project):
    """Yaw from east: the body moves off its heading and the points lie wrong, for one reason."""
    from_east(project)
    advice = [f.advice for f in check_platform("mine", project).findings if f.advice and f.subject != "covariances"]
    assert [one for one in advice if not one.startswith("first follow")] == [
        "set navigation.corrections: [yaw_mirrored]"
    ]
    change_platform(project, lambda p: p["navigation"].update(corrections=["yaw_mirrored"]))
    assert check_platform("mine", project).of(Level.ERROR) == ()


def test_clean_files_have_none_of_the_planted_findings(clean_report):
    for _, subject, found, _ in PLANTED.values():
        worse = [f for f in clean_report.findings if f.level > Level.OK and f.subject == subject]
        assert not any(re.search(found, finding.found) for finding in worse)


def test_all_findings_come_in_one_pass(project):
    for plant in (degrees, lopsided, millimetres, twice):
        plant(project)
    report = check_platform("mine", project)
    assert {finding.subject for finding in report.of(Level.ERROR)} == {"body pose", "covariances", "camera", "labels"}


def test_every_fault_of_the_platform_file_is_told(project):
    def spoil(values):
        values["camera"]["pixels"] = values["camera"].pop("n_pixels")
        values["hand_measured"]["position_m"] = [0.1, 0.2]
        values["navigation"]["maximum_gap_s"] = -1

    change_platform(project, spoil)
    found = " ".join(finding.found for finding in check_platform("mine", project).of(Level.ERROR))
    for key in ("camera.pixels", "camera.n_pixels", "hand_measured.position_m", "navigation.maximum_gap_s"):
        assert key in found


def test_unknown_platform_is_an_error_that_lists_the_known(clean_project):
    report = check_platform("yours", clean_project)
    assert report.level == Level.ERROR
    assert "mine" in report.findings[0].found


def test_level_passes_only_ask_for_tilt(project):
    """The passes of the survey without roll: the weak direction and the motion that mends it are told."""
    files = sorted((project / "data" / "mine" / "labelled_points").glob("*.csv"))
    for path in files[:6]:  # those that the channel rolls
        path.unlink()
    (told,) = [f for f in check_platform("mine", project).of(Level.WARNING) if f.subject == "predicted sigmas"]
    assert "r_z" in told.found
    assert re.search("roll spreads over [0-4]\\.", told.found)
    assert re.match("drive four more passes with the vehicle (rolled|pitched) by 4 deg", told.advice)


def test_simulated_platform_is_checked_before_it_is_made(project, platforms_folder):
    (project / "config" / "platforms" / "sim.yaml").write_text((platforms_folder / "ladybird-sim.yaml").read_text())
    report = check_platform("sim", project)
    assert report.level < Level.ERROR
    assert len(report.predicted) == 6
    known = "like: sim\nnoise_model: adjustment\nexperiments: {}\ntarget: {kind: rings, known: true, sigma_m: 1.0e-3}\n"
    (project / "config" / "platforms" / "known.yaml").write_text(known)
    report = check_platform("known", project)
    assert report.level < Level.ERROR
    assert "of 15 the place on the target, to 1 mm" in "".join(one.found for one in report.findings)


def test_planned_strips_are_checked_before_they_are_flown(project, platforms_folder):
    (project / "config" / "platforms" / "drone.yaml").write_text((platforms_folder / "drone-sim.yaml").read_text())
    report = check_platform("drone", project)
    assert report.level == Level.OK
    assert len(report.predicted) == 6
    assert [one.found[:9] for one in report.findings if one.subject == "planned strips"] == ["10 strips"]
