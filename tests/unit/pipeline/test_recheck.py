"""A calibration on disk and a folder of new views: verdict, numbers, exit code; what cannot be compared is one line."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

import linepose
from linepose.cli.app import app
from linepose.config.new_platform import NewPlatform, write_platform
from linepose.config.new_project import make_project
from linepose.config.platform import load_platform
from linepose.pipeline.recheck import MOVES, recheck
from linepose.simulation.survey import reported_covariance, simulate_survey, without_faults
from unit.conftest import ROOT
from unit.recorded_files import write_labelled_views

BLOCK = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)
CALIBRATED, NEW = (0, 2, 4, 13, 15, 17, 19, 21), (1, 3, 5, 16)
MOVED_M = 0.15  # to the right, of which these views see some 0.03 m
QUICK = {"n_draws": 10, "n_samples": 400, "tails": False}


def survey_of(settings, camera, passes, seed, moved_m=0.0):
    """Of these passes, a day later for another seed, with the camera moved to the right."""
    pose = settings.true_pose + moved_m * np.eye(6)[1]
    drive = replace(settings, passes=tuple(settings.passes[i] for i in passes), true_pose=tuple(pose.tolist()))
    survey, _ = simulate_survey(camera, drive, seed)
    return replace(survey, time_us=survey.time_us + seed * 86_400_000_000 * (survey.time_us > 0))


@pytest.fixture(scope="module")
def project(tmp_path_factory):
    """A calibrated platform with labelled views, and two folders of new ones."""
    folder = tmp_path_factory.mktemp("project")
    simulated = load_platform(ROOT / "config" / "platforms", "ladybird-sim")
    settings, camera = without_faults(simulated.simulation), simulated.intrinsics()
    make_project(folder, "myrobot")
    config = folder / "config" / "config.yaml"
    config.write_text(yaml.safe_dump(yaml.safe_load(config.read_text()) | {"adjustment": QUICK}))
    new = NewPlatform(
        "myrobot", camera.focal_length_m, camera.pixel_pitch_m, 648, (0.2, 0.0, -0.8), (-56.0, 0.0, -90.0)
    )
    write_platform(folder / "config" / "platforms", new)
    reported = reported_covariance(settings.reported_sigma)
    write_labelled_views(folder / "data" / "myrobot", survey_of(settings, camera, CALIBRATED, 1), reported)
    write_labelled_views(folder / "new-views", survey_of(settings, camera, NEW, 2), reported)
    write_labelled_views(folder / "knocked", survey_of(settings, camera, NEW, 3, MOVED_M), reported)
    linepose.calibrate_platform("myrobot", folder).write(folder / "results" / "myrobot")
    return folder


@pytest.fixture(scope="module")
def calibration(project):
    platform = load_platform(project / "config" / "platforms", "myrobot")
    return linepose.Calibration.from_results(project / "results" / "myrobot", platform)


def given(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def test_page_on_rechecks_runs_and_the_calibration_holds(project, monkeypatch, capsys):
    monkeypatch.chdir(project)
    namespace: dict[str, object] = {}
    for block in BLOCK.findall((ROOT / "docs" / "recheck.md").read_text()):
        exec(compile(block, "recheck.md", "exec"), namespace)
    report = namespace["report"]
    assert report.holds
    assert (report.n_calibrated, report.n_views) == (len(CALIBRATED), len(NEW))
    told = capsys.readouterr().out
    assert all(name in told for name in ("True", "least_seen", *MOVES))
    table = report.table()
    assert np.all(np.abs(table["move"]) < 4 * table["sigma"])
    assert 0.01 < table.loc["right_m", "least_seen"] < MOVED_M / 2


def test_a_knocked_camera_ends_with_three_and_json_tells_the_move(project):
    result = given("recheck", "myrobot", "--data", project / "knocked", "--json", "--project", project)
    assert result.exit_code == 3, result.output
    told = json.loads(result.stdout)
    assert not told["holds"]
    assert told["tests"]["all six"]["p_value"] < 0.001
    assert list(told["moves"])[3:] == ["turn_forward_deg", "turn_right_deg", "turn_down_deg"]
    right = told["moves"]["right_m"]
    assert abs(right["move"] - MOVED_M) < 4 * right["sigma"]


def test_lines_for_people_name_the_verdict_and_each_number(project):
    from linepose.cli.recheck import lines_of
    from linepose.estimation.pose_change import PoseChange
    from linepose.pipeline.recheck import Recheck

    information = np.diag([1e4, 1e4, 0.0, 1e6, 1e6, 1e6])
    change = PoseChange(information, information @ [0.1, 0, 0, 0, 0, 0])
    lines = lines_of(Recheck("mine", 16, 5, change, 0.05, ("few draws",)))
    assert lines[0].startswith("mine: the camera has moved (p = ")
    assert lines[5].startswith("turn about forward  ")
    assert re.match(r"forward +0\.100 m +0\.010 m +0\.0\d\d m", lines[2])
    assert lines[4].split()[-2:] == ["not", "seen"]
    assert lines[-1] == "care: few draws"


@pytest.mark.parametrize(
    ("folder", "said"),
    [("data/myrobot", "measurements that the calibration rests on"), ("nowhere", "found no such folder")],
)
def test_views_that_tell_nothing_are_refused_in_one_line(project, folder, said):
    result = given("recheck", "myrobot", "--data", project / folder, "--project", project)
    assert result.exit_code == 1
    (line,) = result.stderr.strip().splitlines()
    assert said in line


def test_a_calibration_of_the_paper_is_refused(calibration):
    with pytest.raises(linepose.InputError, match="found published, expected adjustment"):
        recheck(replace(calibration, noise_model="published"), calibration.observations)


def test_a_calibration_of_other_settings_is_refused(calibration):
    views = calibration.observations.assign(time_us=0)
    other = replace(calibration, camera=calibration.camera.replaced(principal_point_px=400.0))
    with pytest.raises(linepose.InputError, match="that its observations and settings no longer give"):
        recheck(other, views, linepose.AdjustmentSection(**QUICK))
