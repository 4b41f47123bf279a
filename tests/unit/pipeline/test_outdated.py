"""Results against the present settings, inputs and code."""

import shutil

import pandas as pd
import pyarrow as pa
import pytest
import yaml

from linepose import tables
from linepose.pipeline.code_digest import script_digest
from linepose.pipeline.outdated import Present, outdated_results, told
from linepose.pipeline.project_folder import load_platform_project
from linepose.pipeline.provenance import provenance_of_job
from linepose.pipeline.sections import platform_section, study_section
from linepose.tables import mark_tables, write_table

SCHEMA = pa.schema([pa.field("value", pa.float64(), nullable=False)])
BASIN = {"n_distances": 3}


@pytest.fixture
def root(tmp_path, platforms_folder, monkeypatch):
    """A project whose results say that its present state made them, as the workflow writes them."""
    shutil.copytree(platforms_folder, tmp_path / "config" / "platforms")
    (tmp_path / "config" / "config.yaml").write_text("platforms: [mine]\n")
    (tmp_path / "config" / "platforms" / "mine.yaml").write_text("like: ladybird-sim\n")
    (tmp_path / "scripts").mkdir()
    for name in ("made_up", "experiment"):
        (tmp_path / "scripts" / f"{name}.py").write_text("LIMIT = 1\n")
    monkeypatch.setattr(tables, "_marks", {})
    monkeypatch.chdir(tmp_path)
    project = load_platform_project("mine", tmp_path)
    platform, code = platform_section(project, "mine"), script_digest(tmp_path / "scripts" / "made_up.py")
    write("observations", {"platform": platform, "code": code}, [])
    study = {"search": study_section(project, "search"), "sampling": study_section(project, "sampling")}
    write("pose", {"platform": platform, "study": study, "code": code}, ["results/mine/observations.parquet"])
    code = script_digest(tmp_path / "scripts" / "experiment.py")
    write("basin", {"platform": platform, "sections": {"basin": BASIN}, "code": code}, [])
    return tmp_path


def write(name, parameters, inputs):
    mark_tables(provenance_of_job(parameters, inputs).text())
    write_table(pd.DataFrame({"value": [1.0]}), f"results/mine/{name}.parquet", SCHEMA)


def found(root, **changed):
    project = load_platform_project("mine", root)
    present = Present(project, root, "mine", root / "scripts", {"basin": BASIN})
    return outdated_results(Present(**(vars(present) | changed)))


def configure(root, file, values):
    path = root / "config" / file
    path.write_text(yaml.safe_dump(yaml.safe_load(path.read_text()) | values))


def test_nothing_is_outdated_where_nothing_has_changed(root):
    assert found(root) == []


def test_changed_setting_is_named_with_both_values(root):
    configure(root, "platforms/mine.yaml", {"camera": {"focal_length_m": 0.009}})
    results = found(root)
    assert [one.path for one in results] == [
        f"results/mine/{name}.parquet" for name in ("basin", "observations", "pose")
    ]
    line = "results/mine/basin.parquet and 2 more are outdated: camera.focal_length_m was 0.0082, is 0.009"
    assert told(results) == line


def test_changed_key_of_the_study_concerns_what_rests_on_it(root):
    configure(root, "config.yaml", {"search": {"x_tolerance": 1e-3}})
    (result,) = found(root)
    assert told([result]) == "results/mine/pose.parquet is outdated: search.x_tolerance was 1e-05, is 0.001"


def test_description_is_no_setting(root):
    configure(root, "platforms/mine.yaml", {"description": "other words"})
    assert found(root) == []


def test_changed_input_is_named(root):
    path = root / "results" / "mine" / "observations.parquet"
    mark_tables(tables.read_mark(path))
    write_table(pd.DataFrame({"value": [2.0]}), path, SCHEMA)
    (result,) = found(root)
    assert result.path == "results/mine/pose.parquet"
    assert "results/mine/observations.parquet is not the one it was made from" in result.difference


def test_changed_code_is_named_and_a_comment_is_none(root):
    script = root / "scripts" / "made_up.py"
    script.write_text("LIMIT = 1  # words\n")
    assert found(root) == []
    script.write_text("LIMIT = 200\n")
    from linepose.pipeline import code_digest

    code_digest._file.cache_clear()
    code_digest._digest.cache_clear()
    assert ["scripts/made_up.py" in one.difference for one in found(root)] == [True, True]
    assert found(root, scripts=None) == []


def test_experiments_are_compared_where_they_are_asked_for(root):
    changed = {"basin": {"n_distances": 4}}
    (result,) = found(root, experiments=changed)
    assert result.difference == "basin.n_distances was 3, is 4"
    assert found(root, experiments=changed, left_out=frozenset({"basin"})) == []
    assert found(root, experiments=None) == []


def test_result_that_does_not_say_what_made_it_is_outdated(root, monkeypatch):
    monkeypatch.setattr(tables, "_marks", {})
    write_table(pd.DataFrame({"value": [2.0]}), root / "results" / "mine" / "old.parquet", SCHEMA)
    (result,) = found(root)
    assert "does not say what made it" in result.difference


def test_missing_input_is_no_difference(root):
    (root / "results" / "mine" / "observations.parquet").unlink()
    assert found(root) == []


def test_changed_file_of_a_data_set_is_named(root):
    (root / "data" / "own").mkdir(parents=True)
    (root / "data" / "own" / "log.csv").write_text("1")
    sums = root / "results" / "datasets" / "own.csv"
    sums.parent.mkdir()
    from linepose.survey.datasets import check_dataset

    digest = check_dataset(root / "data" / "own", {"log.csv": None})["log.csv"]
    sums.write_text(f"file,sha256\nlog.csv,{digest}\n")
    write("points", {}, ["results/datasets/own.csv"])
    project = load_platform_project("mine", root)
    project = type(project)(**(vars(project) | {"folders": {"own": root / "data" / "own"}}))
    assert found(root, project=project) == []
    (root / "data" / "own" / "log.csv").write_text("2")
    (result,) = found(root, project=project)
    assert result.path == "results/mine/points.parquet"
    assert result.difference.startswith("data/own/log.csv is not the one")
