"""Snakemake's messages of a run of several platforms, and the lines that a person sees of them."""

import os

import pytest

from linepose.cli.platform_lines import PlatformLines

FAILED = """\
linepose.extract: data/b.csv: row 3: found x, expected a number; correct it
linepose.extract: 60 measurements of 15 points in 4 views of data/c
Error in rule extract:
    message: None
    jobid: 7
    output: results/b/points.parquet
    log: results/logs/b/extract.log (check log file(s) for error details)
"""


@pytest.fixture
def told(tmp_path):
    lines = PlatformLines(tmp_path, 12)
    return lambda text: [line for message in text.splitlines() if (line := lines.hear(message)) is not None]


def test_a_platform_is_one_line_when_its_page_is_written(told):
    assert told("total 205\n") == ["204 stages to run"]
    assert told("linepose.extract: 60 points\nFinished jobid: 5 (Rule: extract)\n") == []
    assert told("linepose.report: b: Use this pose: every check passed. 1.2 MB\n") == [
        " 1/12 b: Use this pose: every check passed. 1.2 MB"
    ]
    assert told("Finished jobid: 6 (Rule: report)\n") == []
    assert told("linepose.extract: warning: c: a gap\n") == ["linepose.extract: warning: c: a gap"]


def test_what_failed_is_told_by_its_own_log_and_not_by_another_stages_word(told, tmp_path):
    log = tmp_path / "results" / "logs" / "b" / "extract.log"
    log.parent.mkdir(parents=True)
    log.write_text("linepose.extract: data/b.csv: row 3: found x, expected a number; correct it\n")
    assert told(FAILED) == [
        "extract failed: data/b.csv: row 3: found x, expected a number; correct it (results/logs/b/extract.log)"
    ]
    log.unlink()
    assert told(FAILED) == ["extract failed: it ended without a word (results/logs/b/extract.log)"]


def test_a_failure_on_a_node_is_told_by_the_rules_log_though_the_executors_stands_behind_it(told, tmp_path):
    log = tmp_path / "results" / "logs" / "b" / "extract.log"
    log.parent.mkdir(parents=True)
    log.write_text("linepose.extract: data/b.csv: row 3: found x, expected a number; correct it\n")
    of_node = FAILED.replace("extract.log (", "extract.log, /p/.snakemake/slurm_logs/rule_extract/4.log (")
    assert told(of_node.replace("Error in", "    Error in")) == [
        "extract failed: data/b.csv: row 3: found x, expected a number; correct it (results/logs/b/extract.log)"
    ]


def test_pages_that_nodes_wrote_are_told_at_the_end(tmp_path, monkeypatch):
    """Of those that were written in this run, and were not told when they were."""
    lines = PlatformLines(tmp_path, 3)
    lines.hear("linepose.report: a: Use this pose: every check passed. 1.2 MB")
    for name, written_s in (("a", 200), ("b", 200), ("c", 50)):
        summary = tmp_path / "results" / name / "summary.json"
        summary.parent.mkdir(parents=True)
        summary.write_text(name)
        os.utime(summary, (written_s, written_s))
    verdict = type("", (), {"sentence": "Do not use this pose."})
    monkeypatch.setattr(
        "linepose.output.report.summary_file.read_summary", lambda path: type("", (), {"verdict": verdict})
    )
    assert lines.unheard(["a", "b", "c"], since_s=100.0) == ["2/3 b: Do not use this pose."]
