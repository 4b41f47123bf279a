"""Snakemake's messages of a run of several platforms, and the lines that a person sees of them."""

import pytest

from linepose.cli.platform_lines import PlatformLines

FAILED = """\
linepose.extract: data/b.csv: row 3: found x, expected a number; correct it
linepose.extract: 60 points in 4 views of data/c
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
