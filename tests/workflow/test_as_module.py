"""The workflow as a module of another one, in a folder of its own, as snakedeploy writes it."""

import pytest
from tiny_project import ROOT, STUDY, TINY, Project

pytestmark = pytest.mark.workflow
MODULE = """configfile: "config/config.yaml"


module linepose:
    snakefile: "{snakefile}"
    config: config


use rule * from linepose
"""


@pytest.fixture
def other(tmp_path):
    """A folder with a configuration, and no workflow yet."""
    project = Project(tmp_path)
    project.configure(STUDY, {"tiny": TINY})
    return project


@pytest.mark.parametrize("snakefile", ["Snakefile", "workflow/Snakefile"])
def test_other_workflow_plans_and_runs_all_rules(other, snakefile):
    (other.folder / "Snakefile").write_text(MODULE.format(snakefile=ROOT / snakefile))
    run = other.run("--dry-run", snakefile=other.folder / "Snakefile")
    assert run.returncode == 0, run.stderr
    told = run.stdout + run.stderr
    for result in ("tiny/pose.parquet", "tiny/basin_summary.parquet", "report.html", "tiny/figures"):
        assert f"results/{result}" in told
    assert "regression" not in told  # the paper is of the clone
    if snakefile == "Snakefile":
        return  # whose rules are those of the other
    run = other.run("results/compiled/published.txt", snakefile=other.folder / "Snakefile")
    assert run.returncode == 0, run.stderr
    assert (other.folder / "results" / "compiled" / "published.txt").is_file()
