"""Each command as a user gives it: what it prints, what it writes, how it ends; faults are one line."""

import fcntl
import io
import logging
import os
import re
import subprocess
import sys
from types import SimpleNamespace

import pandas as pd
import pytest
import yaml
from typer.testing import CliRunner

from linepose.cli import workflow_files
from linepose.cli.app import app
from linepose.cli.check import _without_warnings
from linepose.config.platform import load_platform
from linepose.errors import InputError
from linepose.survey.observations import EULER_COLUMNS, POSITION_COLUMNS
from unit import made_up
from unit.recorded_files import write_platform_files

HYSPEX = "".join(f"{row} 151.0 -33.0 42.0 5.0 -10.0 30.0 {252818.25 + row / 100}\n" for row in (1, 2))
GIVEN = [
    *("--focal-length-mm", "8.2", "--pixel-pitch-um", "7.407407", "--pixels", "648"),
    *("--position-m", "0.2", "0", "-0.8", "--euler-deg", "-56", "0", "-90"),
]

HYSPEX = "1 151.0 -33.0 42.0 5.0 -10.0 30.0 252818.25\n2 151.0 -33.0 42.0 5.0 -10.0 30.0 252818.35\n"


@pytest.fixture
def here(tmp_path, monkeypatch):
    """An empty folder that commands run in."""
    monkeypatch.chdir(tmp_path)
    return tmp_path


def given(*arguments, answers=None):
    return CliRunner().invoke(app, [str(argument) for argument in arguments], input=answers)


def one_line(result) -> str:
    """The only line of a fault."""
    (line,) = result.stderr.strip().splitlines()
    assert line.startswith("linepose: ")
    assert "Traceback" not in result.output
    return line


def test_help_names_every_command_in_the_order_of_use():
    told = given("--help").stdout
    places = [told.index(f"│ {name} ") for name in ("new", "label", "check", "run", "show", "export")]
    assert places == sorted(places)


@pytest.mark.parametrize("command", ["new", "label", "check", "run", "show", "export"])
def test_every_command_has_help(command):
    result = given(command, "--help")
    assert result.exit_code == 0
    assert "--project" in result.stdout


def test_new_makes_a_project_and_a_platform_that_can_be_read(here):
    result = given("new", "mine", *GIVEN)
    assert result.exit_code == 0, result.output
    platform = load_platform(here / "config" / "platforms", "mine")
    assert platform.camera.focal_length_m == 8.2e-3
    assert platform.camera.pixel_pitch_m == 7.407407e-6
    assert platform.camera.principal_point_px == 323.5
    assert platform.hand_measured.euler_deg == (-56.0, 0.0, -90.0)
    assert platform.source.dataset == "mine"
    assert platform.experiments == {"basin": None, "repeatability": {"n_splits": 20}}
    assert yaml.safe_load((here / "config" / "config.yaml").read_text())["platforms"] == ["mine"]
    assert "linepose check mine" in result.stdout


def test_new_asks_for_what_is_not_given_until_it_fits(here):
    answers = "8.2\nseven\n7.4\n648\n\n0.2 0\n0.2, 0, -0.8\n-56 0 -90\nscan\nscans\n\ntable\n"
    result = given("new", "mine", answers=answers)
    assert result.exit_code == 0, result.output
    assert "'seven': expected a number above 0; try again" in result.stdout
    assert "'0.2 0': expected three numbers; try again" in result.stdout
    assert "'scan': expected one of labelled_views, scans; try again" in result.stdout
    platform = load_platform(here / "config" / "platforms", "mine")
    assert platform.source.kind == "scans"
    assert platform.hand_measured.position_m == (0.2, 0.0, -0.8)


@pytest.mark.parametrize("name", ["novatel", "sbet", "nmea", "rosbag", "resonon", "px4"])
def test_new_takes_every_navigation_format(here, name):
    log = ["--source", "scans", "--navigation-format", name, "--navigation", "log/*.bin"]
    result = given("new", "mine", *GIVEN, *log)
    assert result.exit_code == 0, result.output
    source = load_platform(here / "config" / "platforms", "mine").source
    assert (source.navigation.format, source.navigation.file) == (name, "log/*.bin")
    assert source.covariances == ("covariances.csv" if name in {"resonon", "px4"} else None)  # its logs hold none


@pytest.mark.parametrize(
    ("file", "text", "keys"),
    [
        ("log.txt", HYSPEX, {"format": "table", "preset": "hyspex"}),
        ("a.gps", "#INSPVAXA,COM1,0,73.5,FINESTEERING,1695,309428.0\n", {"format": "novatel"}),
        ("scan.nav", "$GPGGA,100000.00,5000.0000,N,00800.0000,E,4,12,0.8,52.3,M,47.7,M,,\n", {"format": "nmea"}),
        ("run.bag", "", {"format": "rosbag"}),
        (
            "a.csv",
            "time,lat,lon,alt,roll,pitch,yaw\n1700000000,50,8,99,1,2,90\n",
            {"format": "table", "coordinates": "geodetic", "angle_unit": "degrees", "time_unit": "s"},
        ),
        ("run.lcf", "", {"format": "resonon"}),
        ("sbet.out", "", {"format": "sbet"}),
    ],
)
def test_new_recognises_a_log(here, file, text, keys):
    (here / file).write_text(text)
    result = given("new", "mine", *GIVEN, "--navigation-file", file)
    assert result.exit_code == 0, result.output
    assert f"{file}: format {keys['format']}" in result.stdout
    navigation = load_platform(here / "config" / "platforms", "mine").source.navigation
    assert navigation.file == file
    assert {key: getattr(navigation, key) for key in keys} == keys


def test_new_names_a_log_as_it_lies_below_the_platforms_data(here):
    folder = here / "data" / "mine" / "log"
    folder.mkdir(parents=True)
    (folder / "a.txt").write_text(HYSPEX)
    assert given("new", "mine", *GIVEN, "--navigation-file", "data/mine/log/a.txt").exit_code == 0
    assert load_platform(here / "config" / "platforms", "mine").source.navigation.file == "log/a.txt"


PLACED = GIVEN[4:]
TABLE = "pixel;across_deg\n" + "".join(f"{pixel};{(pixel - 323.5) / 20}\n" for pixel in range(648))


@pytest.mark.parametrize(
    ("options", "answer", "scale"),
    [
        (["--field-of-view-deg", "38"], "38 deg", {"field_of_view_deg": 38.0}),
        (["--view-angles", "angles.csv"], "angles.csv", {"view_angles": "mine-view-angles.csv"}),
    ],
)
def test_new_writes_a_camera_as_it_is_sold_with_the_keys_that_go_with_it(here, options, answer, scale):
    (here / "angles.csv").write_text(TABLE)
    assert given("new", "mine", *options, *PLACED).exit_code == 0
    platforms = here / "config" / "platforms"
    written = yaml.safe_load((platforms / "mine.yaml").read_text())["camera"]
    assert {key: written[key] for key in scale} == scale
    assert {"focal_length_m", "pixel_pitch_m"}.isdisjoint(written)
    assert ("principal_point_px" in written) == ("field_of_view_deg" in scale)
    assert "focal_length_m" not in written["sigmas"]
    camera = load_platform(platforms, "mine").camera
    assert camera.sigmas.focal_length_m == pytest.approx(0.01 * camera.focal_length_m, rel=0.02)  # to two digits
    middle = "323.5\n" if "field_of_view_deg" in scale else ""
    assert given("new", "asked", *PLACED, answers=f"{answer}\n{middle}\n\n").exit_code == 0
    assert load_platform(platforms, "asked").camera == camera


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--field-of-view-deg", "38", "--focal-length-mm", "8"], "--focal-length-mm with --field-of-view-deg"),
        (["--field-of-view-deg", "38", "--pixel-pitch-um", "8"], "leave out --pixel-pitch-um"),
        (["--view-angles", "angles.csv", "--principal-point-px", "8"], "leave out --principal-point-px"),
        (["--view-angles", "none.csv"], "none.csv: found no such file, expected a CSV of view angles; correct --view"),
        (
            ["--view-angles", "short.csv"],
            "found 100 pixels (0 to 99), expected 648 pixels (0 to 647), as --pixels says",
        ),
        (["--view-angles", "config"], "config: found a folder, expected a CSV of view angles; correct --view-angles"),
        (["--field-of-view-deg", "400"], "field_of_view_deg: found 400.0, expected less than or equal to 179"),
    ],
)
def test_new_refuses_a_camera_told_twice_or_by_no_table(here, options, told):
    (here / "angles.csv").write_text(TABLE)
    (here / "short.csv").write_text("\n".join(TABLE.split("\n")[:101]))
    (here / "config").mkdir()
    assert told in one_line(given("new", "mine", *options, *PLACED))
    assert not list((here / "config").iterdir())


def test_new_keeps_another_table_of_its_name(here):
    (here / "angles.csv").write_text(TABLE)
    table = here / "config" / "platforms" / "mine-view-angles.csv"
    table.parent.mkdir(parents=True)
    table.write_text("mine")
    assert "another table of this name" in one_line(given("new", "mine", "--view-angles", "angles.csv", *PLACED))
    assert table.read_text() == "mine"
    assert given("new", "mine", "--view-angles", "angles.csv", *PLACED, "--force").exit_code == 0
    assert table.read_text() == TABLE


def test_new_refuses_what_is_no_finite_number(here):
    assert "found nan, expected finite numbers" in one_line(given("new", "mine", "--focal-length-mm", "nan"))


def test_new_names_no_covariances_where_the_preset_has_them(here):
    heading = "TIME, LATITUDE, LONGITUDE, ELLIPSOID HEIGHT, ROLL, PITCH, HEADING, NORTH SD, EAST SD, HEIGHT SD"
    (here / "a.txt").write_text(f"POS Export Utility\n {heading}, ROLL SD, PITCH SD, HEADING SD\n")
    assert given("new", "mine", *GIVEN, "--navigation-file", "a.txt").exit_code == 0
    source = load_platform(here / "config" / "platforms", "mine").source
    assert (source.navigation.preset, source.covariances) == ("pospac", None)


@pytest.mark.parametrize("name", ["navigation.parquet", "navigation.csv"])
def test_new_knows_our_own_table_of_poses(here, name):
    columns = ("time_us", *POSITION_COLUMNS, *EULER_COLUMNS)
    folder = here / "data" / "mine"
    folder.mkdir(parents=True)
    table = pd.DataFrame({column: [0, 1] for column in columns})
    (table.to_parquet if name.endswith("parquet") else table.to_csv)(folder / name, index=False)
    assert given("new", "mine", *GIVEN, "--navigation-file", f"data/mine/{name}").exit_code == 0
    assert load_platform(here / "config" / "platforms", "mine").source.navigation == name
    assert given("new", "mine", *GIVEN, "--source", "scans", "--force").exit_code == 0  # it is there: named unasked
    found = load_platform(here / "config" / "platforms", "mine").source.navigation
    assert found == ("navigation.parquet" if name.endswith("parquet") else "navigation.csv")


def test_new_tells_a_log_that_it_does_not_know(here):
    (here / "log.txt").write_text("time,x\n1,2\n")
    result = given("new", "mine", *GIVEN, "--navigation-file", "log.txt")
    assert "log.txt: found no log that is recognised, expected one of" in one_line(result)
    assert given("new", "mine", *GIVEN, "--navigation-file", "log.txt", "--navigation-format", "table").exit_code == 0
    assert "none.txt: found no such file" in one_line(given("new", "two", *GIVEN, "--navigation-file", "none.txt"))


@pytest.mark.parametrize(
    ("option", "numbers", "told"),
    [
        ("--position-m", ["0.2", "0"], "--position-m: found 0.2 0, expected three numbers: forward right down (m)"),
        ("--euler-deg", ["-56"], "--euler-deg: found -56, expected three numbers: roll pitch yaw (deg)"),
        ("--euler-deg", ["1", "2", "3", "4"], "found 1 2 3 4, expected three"),
    ],
)
def test_new_with_a_wrong_count_of_numbers_says_which_three(here, option, numbers, told):
    assert told in one_line(given("new", "mine", option, *numbers, *GIVEN[:6]))


@pytest.mark.parametrize(
    ("options", "column", "files"),
    [
        ([], "time_us (microseconds since 1970), north_m", "scans/*.hdr, labels.csv, navigation.csv, covariances.csv"),
        (
            ["--navigation-format", "table", "--navigation", "log.csv"],
            "columns: {time: time_us, position: [north_m, east_m, down_m]",
            "scans/*.hdr, labels.csv, log.csv, covariances.csv",
        ),
    ],
)
def test_new_says_which_columns_and_files_it_expects(here, options, column, files):
    result = given("new", "mine", *GIVEN, "--source", "scans", *options)
    text = (here / "config" / "platforms" / "mine.yaml").read_text()
    assert column in text
    assert ("angle_unit: radians # degrees, radians: Of roll" in text) == bool(options)
    assert f"next: put {files} into {here / 'data' / 'mine'}; mine.yaml says" in result.stdout
    assert result.stdout.endswith("then: linepose check mine\n")


def test_new_lists_the_formats_for_an_unknown_one(here):
    result = given("new", "mine", *GIVEN, "--source", "scans", "--navigation-format", "sbett")
    assert "did you mean sbet?" in one_line(result)
    assert not (here / "config" / "config.yaml").exists()


def test_new_without_an_answer_names_the_option(here):
    result = given("new", "mine", "--focal-length-mm", "8.2", answers="")
    assert result.exit_code == 2
    assert "--pixel-pitch-um" in result.stderr
    assert not (here / "config").exists()


def test_new_overwrites_only_by_force(here):
    given("new", "mine", *GIVEN)
    path = here / "config" / "platforms" / "mine.yaml"
    path.write_text("kept: true\n")
    refused = given("new", "mine", *GIVEN)
    assert refused.exit_code == 1
    assert "--force" in one_line(refused)
    assert path.read_text() == "kept: true\n"
    assert given("new", "mine", *GIVEN, "--force").exit_code == 0
    assert load_platform(path.parent, "mine").camera.n_pixels == 648


def test_new_adds_to_a_project_that_is_there(here):
    given("new", "first", *GIVEN)
    config = here / "config" / "config.yaml"
    config.write_text(config.read_text().replace("seed: 2017 # every", "seed: 3 # my own, every"))
    before = config.read_text().splitlines()
    (here / "below").mkdir()
    result = given("new", "second", *GIVEN, "--project", here / "below")
    assert result.exit_code == 0
    after = config.read_text().splitlines()
    assert [line for line in after if line not in before] == ["  - second"]
    assert len(after) == len(before) + 1
    given("new", "second", *GIVEN, "--force")
    assert config.read_text().splitlines() == after


def test_new_takes_a_target_as_it_was_printed_or_a_kind(here, platforms_folder):
    assert given("target", "--kind", "charuco", "--rows", "5", "--paper", "A0", "--output", "board.pdf").exit_code == 0
    assert given("new", "mine", *GIVEN, "--target", "board.yaml").exit_code == 0
    mine = load_platform(here / "config" / "platforms", "mine")
    assert (mine.target.kind, mine.target.rows, mine.source.points) == ("charuco", 5, "detection")
    assert given("new", "stones", *GIVEN, "--target", "points").exit_code == 0
    stones = load_platform(here / "config" / "platforms", "stones")
    assert (stones.target.kind, stones.source.points, stones.source.refinement) == ("points", "labels", "none")
    assert "found 'charucoo', expected a file, or one of rings" in one_line(
        given("new", "other", *GIVEN, "--target", "charucoo")
    )
    file = here / "config" / "platforms" / "stones.yaml"
    file.write_text(file.read_text().replace("points: labels", "points: detection"))
    with pytest.raises(InputError, match=r"source\.points: detection with target\.kind points"):
        load_platform(file.parent, "stones")


@pytest.mark.parametrize("name", ["a/b", "", "two words"])
def test_new_refuses_a_name_that_no_file_can_have(here, name):
    assert "letters, digits, - and _" in one_line(given("new", name, *GIVEN))


@pytest.fixture
def mine(here, platforms_folder):
    """A project with files for its platform."""
    given("new", "mine", *GIVEN)
    write_platform_files(here / "data" / "mine", load_platform(platforms_folder, "ladybird-sim"), 12)
    return here


def test_check_of_good_files_ends_well_in_plain_lines_that_hold_every_finding(mine, monkeypatch):
    from rich.console import Console

    from linepose.check import platform
    from linepose.cli.findings import findings_table, sigmas_table

    reports, check_platform = [], platform.check_platform
    monkeypatch.setattr(platform, "check_platform", lambda *given: reports.append(check_platform(*given)) or reports[0])
    result = given("check", "mine")
    assert result.exit_code == 0, result.output
    assert "no errors" in result.stdout.splitlines()[-1]
    assert "predicted sigmas" in result.stdout
    assert "\x1b" not in result.stdout
    assert "│" not in result.stdout
    console = Console(width=200, record=True, file=io.StringIO())
    console.print(findings_table(reports[0]))
    console.print(sigmas_table(reports[0]))
    text = console.export_text()
    assert all(finding.subject in text for finding in reports[0].findings)
    assert "the turn about forward" in text


def test_check_of_bad_files_ends_with_one_and_tells_all(mine):
    (mine / "data" / "mine" / "nav_covs.csv").unlink()
    view = sorted((mine / "data" / "mine" / "labelled_points").iterdir())[0]
    view.write_text(view.read_text().replace(",", ";"))
    result = given("check", "mine")
    assert result.exit_code == 1
    errors = [line for line in result.stdout.splitlines() if line.startswith("error")]
    assert len(errors) == 2
    assert "2 errors, no warnings" in result.stdout.splitlines()[-1]


@pytest.mark.parametrize("command", ["check", "run", "show", "export", "label"])
def test_outside_a_project_every_command_says_what_to_do(here, command):
    arguments = ["--format", "urdf"] if command == "export" else []
    result = given(command, "mine", *arguments)
    assert result.exit_code == 1
    assert "linepose new NAME" in one_line(result)


@pytest.mark.parametrize("command", ["run", "show", "export", "label"])
def test_unknown_platform_is_one_line_that_lists_the_known(mine, command):
    arguments = ["--format", "urdf"] if command == "export" else []
    told = one_line(given(command, "yours", *arguments))
    assert "expected one of mine; correct the name, or write it with `linepose new yours`" in told
    assert "did you mean mine?" in one_line(given(command, "nine", *arguments))


def test_run_starts_snakemake_for_this_platform_only(mine, monkeypatch):
    started = []

    def start(command, env, stderr):
        started.append(command)
        assert env["LINEPOSE_RUN_PROCESS"] == str(os.getpid())  # with which it ends
        return SimpleNamespace(wait=lambda: 0)

    monkeypatch.setattr(subprocess, "Popen", start)
    result = given("run", "mine", "--cores", "2", "--", "--rerun-triggers", "mtime")
    assert result.exit_code == 0, result.output
    (command,) = started
    assert command[:3] == [sys.executable, "-m", "snakemake"]
    assert command[command.index("--cores") + 1] == "2"
    assert command[command.index("--config") + 1] == 'platforms=["mine"]'
    assert command[command.index("--directory") + 1] == str(mine)
    assert command[-2:] == ["--rerun-triggers", "mtime"]
    assert "linepose show mine" in result.stdout


def test_run_that_fails_ends_with_one(mine, monkeypatch):
    monkeypatch.setattr(subprocess, "Popen", lambda command, env, stderr: SimpleNamespace(wait=lambda: 1))
    result = given("run", "mine")
    assert result.exit_code == 1
    assert "results/logs" in one_line(result)


def test_run_ends_where_another_is_at_work(mine, monkeypatch):
    """Before anything else is looked at."""
    (mine / ".snakemake").mkdir()
    (mine / "config" / "platforms" / "mine.yaml").unlink()
    with (mine / ".snakemake" / "linepose-run.lock").open("w") as held:
        fcntl.flock(held, fcntl.LOCK_EX)
        monkeypatch.setattr(subprocess, "Popen", None)
        result = given("run", "mine")
    assert result.exit_code == 1
    assert "another run at work here" in one_line(result)


def test_run_without_the_workflow_says_where_it_is(mine, monkeypatch, tmp_path):
    monkeypatch.setattr(workflow_files, "__file__", str(tmp_path / "site-packages" / "linepose" / "cli" / "x.py"))
    result = given("run", "mine")
    assert result.exit_code == 1
    assert "install linepose again" in one_line(result)


def test_run_takes_profiles_by_name_or_path_and_says_what_there_is(mine, monkeypatch):
    snakefile = workflow_files.find_workflow(mine)
    own = mine / "profiles" / "own" / "config.yaml"
    own.parent.mkdir(parents=True)
    own.write_text("jobs: 5\n")
    monkeypatch.chdir(mine)
    assert workflow_files.find_profile("own", mine, snakefile) == own.parent
    assert workflow_files.find_profile("profiles/own", mine, snakefile) == own.parent
    assert workflow_files.find_profile("ci", mine, snakefile) == snakefile.parent / "profiles" / "ci"
    assert workflow_files.says_cores(own.parent)
    assert not workflow_files.says_cores(snakefile.parent / "profiles" / "default")
    assert "ci, default, own" in one_line(given("run", "mine", "--profile", "none-such"))
    own.write_text("executor: none-such\n")
    assert "pip install snakemake-executor-plugin-none-such" in one_line(given("run", "mine", "--profile", "own"))


@pytest.fixture
def fleet(mine):
    """A project with two platforms, of which config.yaml names one."""
    platforms = mine / "config" / "platforms"
    (platforms / "mine-2.yaml").write_text((platforms / "mine.yaml").read_text())
    return mine


@pytest.mark.parametrize(
    ("arguments", "configured", "chosen"),
    [
        (["--all"], ["mine*"], ["mine", "mine-2"]),
        (["--all"], ["mine"], ["mine"]),
        (["mi*"], ["mine"], ["mine", "mine-2"]),
        (["mine-2", "mine"], ["mine"], ["mine-2", "mine"]),
    ],
)
def test_run_takes_several_platforms(fleet, monkeypatch, arguments, configured, chosen):
    started = []
    monkeypatch.setattr(
        subprocess, "Popen", lambda command, env, stderr: started.append(command) or SimpleNamespace(wait=lambda: 0)
    )
    (fleet / "config" / "config.yaml").write_text(yaml.safe_dump({"platforms": configured}))
    result = given("run", *arguments)
    assert result.exit_code == 0, result.output
    (command,) = started
    assert command[command.index("--config") + 1] == f"platforms={chosen}".replace("'", '"')


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--all", "mine"], "--all: found mine beside it, expected names or --all"),
        ([], "NAME: found nothing, expected a platform's name, a pattern of names, or --all"),
        (["mine", "mine"], "NAME: found mine twice"),
        (["tractor-*"], "NAME: found 'tractor-*', which fits no file"),
    ],
)
def test_run_refuses_what_names_no_platform_or_one_twice(fleet, arguments, told):
    assert told in one_line(given("run", *arguments))


@pytest.mark.parametrize("command", ["check", "show"])
def test_other_commands_take_no_pattern(fleet, command):
    result = given(command, "mine*")
    assert result.exit_code == 1
    assert "letters, digits, - and _" in " ".join(result.output.split())


def test_new_platform_that_a_pattern_names_is_not_added(fleet):
    config = fleet / "config" / "config.yaml"
    config.write_text("platforms: ['mine*']\n")
    assert "added" not in given("new", "mine-3", *GIVEN).stdout
    assert config.read_text() == "platforms: ['mine*']\n"


@pytest.mark.parametrize("cores", ["0", "two"])
def test_wrong_usage_ends_with_two(mine, cores):
    assert given("run", "mine", "--cores", cores).exit_code == 2
    assert given("frobnicate").exit_code == 2


@pytest.fixture
def finished(mine, monkeypatch):
    """The made-up results in the place of the platform's own."""
    made_up.write_results(mine / "results" / "mine")
    return mine


def test_show_tells_what_a_model_removed_that_removes(finished):
    path = finished / "config" / "platforms" / "mine.yaml"
    path.write_text(path.read_text().replace("noise_model: adjustment", "noise_model: published"))
    result = given("show", "mine")
    assert result.exit_code == 0, result.output
    (told,) = [line for line in result.stdout.splitlines() if line.startswith("quaternion")]
    assert re.search(r"4 of 6 observations accepted \(removed: \d, \d\), -log L [-\d.]+, noise model published$", told)


def test_show_tells_pose_verdict_and_where_files_are(finished):
    result = given("show", "mine")
    assert result.exit_code == 0, result.output
    lines = result.stdout.splitlines()
    for name, value in zip(("r_x", "r_y", "r_z"), made_up.OPTIMUM[:3], strict=True):
        (line,) = [line for line in lines if line.startswith(f"{name} ")]
        assert f"{value:.4f} m" in line
    assert any(line.startswith("roll") and "deg" in line for line in lines)
    assert lines[0] == "mine"
    assert lines[2].endswith("  minus by hand  in its sigmas")
    assert any("all 6 observations, each with its weight" in line for line in lines)
    assert any("half of chi squared" in line for line in lines)
    assert not any("-log L" in line for line in lines)
    assert "not made yet: figures and report; the run goes on with: linepose run mine" in lines
    assert "report.html" not in result.stdout


def test_show_names_figures_and_report_once_they_are_there(finished):
    folder = finished / "results" / "mine"
    (folder / "figures").mkdir()
    (folder / "report.html").touch()
    told = given("show", "mine").stdout
    assert f"figures {folder / 'figures'}, report {folder / 'report.html'}" in told
    assert "not made yet" not in told


def test_show_before_a_run_says_what_to_do(mine):
    assert "linepose run mine" in one_line(given("show", "mine"))


def test_export_writes_below_the_results_or_where_it_is_told(finished):
    result = given("export", "mine", "--format", "urdf")
    assert result.exit_code == 0, result.output
    assert (finished / "results" / "mine" / "exports" / "mine.urdf").is_file()
    result = given("export", "mine", "-f", "json", "-o", finished / "pose.json", "--child-frame", "my_camera")
    assert result.exit_code == 0, result.output
    assert "my_camera" in (finished / "pose.json").read_text()


def test_export_tells_its_formats(finished):
    from linepose.pipeline.exports.registry import EXPORTS

    told = given("export", "--list")
    assert told.exit_code == 0
    assert all(f"{key} " in told.stdout for key in EXPORTS.names())
    assert "urdf" in one_line(given("export", "mine"))
    assert "did you mean urdf?" in one_line(given("export", "mine", "--format", "urd"))


def test_label_is_for_scans(mine):
    assert "source.kind" in one_line(given("label", "mine"))


def test_program_starts_quickly_and_without_the_science():
    """Help must not wait for numba, pandas and matplotlib."""
    code = "import sys; from linepose.cli import app; print(*sys.modules)"
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not {"numba", "pandas", "matplotlib", "scipy"} & set(told.stdout.split())


def test_check_leaves_warnings_on_for_what_comes_after():
    logger = logging.getLogger("linepose")
    before = logger.level
    with _without_warnings():
        assert not logger.isEnabledFor(logging.WARNING)
    assert logger.level == before
