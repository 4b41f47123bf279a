"""A published number that is not reproduced fails the run, loudly, and leaves the results to look at."""

import shutil

import pytest
import yaml
from tiny_project import ROOT, lines_with

pytestmark = pytest.mark.workflow


def test_number_that_is_not_reproduced_fails_the_run(copied):
    before = copied.results()
    paper = copied.folder / "config" / "paper"
    shutil.copytree(ROOT / "config" / "paper", paper)
    declared = yaml.safe_load((paper / "regression.yaml").read_text())
    (paper / "regression.yaml").write_text(yaml.safe_dump(declared | {"platforms": {}}))
    published = yaml.safe_load((paper / "published.yaml").read_text())
    published["table3"]["shrimp"]["hand_measured"]["pose"][1] += 0.002
    (paper / "published.yaml").write_text(yaml.safe_dump(published))
    run = copied.run()
    assert run.returncode != 0
    told = "shrimp, Table 3, hand_measured, r_y_m: published -0.198, obtained -0.2, tolerance 0.0005"
    assert len(lines_with(told, run.stderr)) == 1, run.stderr
    assert "Traceback" not in run.stderr
    after = copied.results()
    assert set(after) == {*before, "regression.parquet"}
    assert [path for path in before if after[path] != before[path]] == []
    assert not (copied.folder / "results" / "logs" / "regression.passed").exists()
