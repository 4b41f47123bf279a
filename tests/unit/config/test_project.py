from pathlib import Path

import pytest
import yaml

from linepose.config.project import load_project
from linepose.errors import InputError

ROOT = Path(__file__).parents[3]
PLATFORM = {
    "camera": {"focal_length_m": 8e-3, "pixel_pitch_m": 8e-6, "n_pixels": 640, "principal_point_px": 320.0},
    "hand_measured": {"position_m": [0.0, 0.0, 0.0], "euler_deg": [0.0, 0.0, 0.0]},
    "source": {"kind": "labelled_views", "dataset": "robot", "views": "*.view.csv"},
}
STUDY = {"platforms": ["robot"], "data_folders": ["data", "shared"]}
SHA256 = "0" * 64


@pytest.fixture
def root(tmp_path):
    """A project folder with one platform."""
    (tmp_path / "config" / "platforms").mkdir(parents=True)
    (tmp_path / "config" / "platforms" / "robot.yaml").write_text(yaml.safe_dump(PLATFORM))
    return tmp_path


def list_files(root, *files):
    dataset = {"base_url": "http://127.0.0.1:9/", "sha256": dict.fromkeys(files, SHA256)}
    (root / "config" / "robot.yaml").write_text(yaml.safe_dump(dataset))
    return STUDY | {"datasets": {"robot": "config/robot.yaml"}}


def test_listed_data_set_that_is_nowhere_will_stand_in_the_first_folder(root):
    project = load_project(list_files(root, "a.view.csv", "nav_covs.csv"), root)
    folder = root / "data" / "robot"
    assert project.folder("robot") == folder
    assert project.files("robot") == [folder / "a.view.csv", folder / "nav_covs.csv"]
    assert project.sums("robot") == {"a.view.csv": SHA256, "nav_covs.csv": SHA256}


def test_listed_data_set_is_found(root):
    values = list_files(root, "a.view.csv")
    (root / "shared" / "robot").mkdir(parents=True)
    (root / "shared" / "robot" / "a.view.csv").touch()
    assert load_project(values, root).folder("robot") == root / "shared" / "robot"


def test_own_data_set_is_what_its_folder_holds(root):
    folder = root / "shared" / "robot"
    folder.mkdir(parents=True)
    for name in ("2.view.csv", "1.view.csv", "nav_covs.csv", "notes.txt"):
        (folder / name).touch()
    project = load_project(STUDY, root)
    assert project.folder("robot") == folder
    assert project.sums("robot") == {"1.view.csv": None, "2.view.csv": None, "nav_covs.csv": None}


def test_own_data_set_that_is_nowhere(root):
    with pytest.raises(InputError) as error:
        load_project(STUDY, root)
    assert str(error.value) == (
        f"{root}/config/platforms/robot.yaml: source.dataset: found no folder robot in data, shared, "
        f"expected a folder with the platform's files; put them in {root}/data/robot"
    )


@pytest.mark.parametrize(
    ("source", "missing", "key"),
    [
        ({}, "nav_covs.csv", "source.covariances"),
        ({"kind": "scans", "views": None, "navigation": "log.csv", "labels": "l.csv"}, "l.csv", "source.labels"),
        ({"kind": "scans", "views": None, "points": "detection", "navigation": "x/log.csv"}, "x/log.csv", "source.nav"),
    ],
)
def test_file_that_is_missing_is_told_with_its_key_before_a_run(root, source, missing, key):
    values = {name: value for name, value in (PLATFORM["source"] | source).items() if value is not None}
    (root / "config" / "platforms" / "robot.yaml").write_text(yaml.safe_dump(PLATFORM | {"source": values}))
    folder = root / "data" / "robot"
    (folder / "x").mkdir(parents=True)
    for name in ("covariances.csv", "log.csv", "a.view.csv"):
        (folder / name).touch()
    project = load_project(STUDY, root)
    with pytest.raises(InputError, match=f"{missing}: found no such file, expected .* platform robot .*correct {key}"):
        project.check_files()
    (folder / missing).touch()
    project.check_files()


def test_platform_that_is_nowhere(root):
    with pytest.raises(InputError) as error:
        load_project(STUDY | {"platforms": ["robot", "rover"]}, root)
    assert str(error.value) == (
        f"{root}/config/platforms/rover.yaml: found no such platform, expected one of robot; correct the name, "
        "or write it with `linepose new rover`"
    )


def test_committed_configuration_is_whole():
    project = load_project(yaml.safe_load((ROOT / "config" / "config.yaml").read_text()), ROOT)
    assert set(project.study.platforms) <= set(project.platforms)
    assert {platform.source.dataset for platform in project.platforms.values()} - {None} <= set(project.datasets)


@pytest.mark.parametrize("name", yaml.safe_load((ROOT / "config" / "config.yaml").read_text())["platforms"])
def test_each_platform_of_the_committed_study_runs_alone(name):
    """As `linepose run NAME` has it: nothing else in the configuration may need the others."""
    values = yaml.safe_load((ROOT / "config" / "config.yaml").read_text()) | {"platforms": [name]}
    assert load_project(values, ROOT).study.platforms == [name]
