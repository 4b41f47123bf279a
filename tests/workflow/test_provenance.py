"""What results say of what made them, and that lost and outdated ones are made again, with and without .snakemake."""

import re
import shutil

import pandas as pd
import pytest
from tiny_project import QUICK, ROOT, STUDY, lines_with

from linepose.cli.freshness import all_outdated
from linepose.experiments.registry import SECTIONS, compared_platforms
from linepose.geometry.pose import POSE_COLUMNS
from linepose.pipeline.project_folder import load_platform_project
from linepose.pipeline.provenance import read_provenance
from linepose.pipeline.sections import present_section

pytestmark = pytest.mark.workflow
POSE = "results/tiny/pose.parquet"


def test_every_result_says_what_made_it(finished):
    project = load_platform_project("tiny", finished.folder, compared_platforms)
    experiments = {key: section.values(project.platforms["tiny"]) for key, section in SECTIONS.items()}
    made = {path: read_provenance(finished.folder / "results" / path) for path in finished.results()}
    assert [path for path, one in made.items() if one is None] == []
    for path, one in made.items():
        assert one.code, path
        assert str(finished.folder) not in one.text()
        assert str(ROOT) not in one.text()
        if path.startswith("tiny/"):
            for name, recorded in one.settings.items():
                assert present_section(project, "tiny", name, recorded, experiments) == recorded, (path, name)
    assert "results/tiny/observations.parquet" in made["tiny/optima.parquet"].inputs
    assert all_outdated(project, finished.folder, "tiny", ROOT / "scripts") == []


def test_rule_all_asks_for_every_result(finished):
    run = finished.run("--dry-run", "--forceall", "--config", "platforms=[tiny]")
    assert run.returncode == 0, run.stderr
    told = run.stdout + run.stderr
    targets = set(re.search(r"rule all:\n    input: (.*)", told)[1].split(", "))
    for path in finished.results():
        folder = f"results/{path.rpartition('/')[0]}"
        assert f"results/{path}" in targets or f"{folder}_files.txt" in targets, path


@pytest.mark.parametrize(
    "lost", ["optima.parquet", "mcmc/all.parquet", "figures/index.parquet", "simulated/labels.csv", "figures_files.txt"]
)
def test_lost_file_is_made_again(copied, lost):
    (copied.folder / "results" / "tiny" / lost).unlink()
    run = copied.linepose("run", "tiny", "--dry-run")
    assert run.returncode == 0, run.stderr
    rule = {"optima": "optimise", "mcmc": "sample", "simulated": "simulate"}.get(re.split("[./]", lost)[0], "figures")
    assert re.search(rf"^{rule}\s+1$", run.stdout + run.stderr, re.MULTILINE), run.stderr


def test_changed_setting_is_seen_and_the_results_made_again_without_snakemakes_records(copied):
    shutil.rmtree(copied.folder / ".snakemake")
    assert lines_with("outdated", copied.linepose("show", "tiny").stderr) == []
    before = pd.read_parquet(copied.folder / POSE)
    copied.configure(STUDY, {"tiny": QUICK | {"camera": {"focal_length_m": 0.009}}})
    for command in (["show", "tiny"], ["export", "tiny", "--format", "json"]):
        done = copied.linepose(*command)
        (line,) = lines_with("outdated", done.stderr)
        assert "camera.focal_length_m was 0.0082, is 0.009; to make it again: linepose run tiny" in line
    run = copied.linepose("run", "tiny", "--cores", "2")
    assert run.returncode == 0, run.stderr
    assert len(lines_with("camera.focal_length_m was 0.0082, is 0.009", run.stderr)) == 1
    assert lines_with("outdated", copied.linepose("show", "tiny").stderr) == []
    after = pd.read_parquet(copied.folder / POSE)
    assert not before[list(POSE_COLUMNS)].equals(after[list(POSE_COLUMNS)])
    assert lines_with("outdated", copied.linepose("run", "tiny", "--dry-run").stderr) == []
