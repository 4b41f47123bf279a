"""Snakemake's messages of real runs, and the lines that a person sees of them."""

import pytest

from linepose.cli.stage_lines import StageLines

PLANNED = """\
Using workflow specific profile /clone/profiles/default for setting default command line arguments.
Building DAG of jobs...
Job stats:
job                count
---------------  -------
check_data             1
optimise               1
all                    1
total                  3

Select jobs to execute...
Execute 2 jobs...
"""
BEGUN = """\
[Fri Nov 27 07:55:36 2026]
localrule {0}:
    input: results/datasets/mine.csv
    log: results/logs/mine/{0}.log
    jobid: 3
    resources: tmpdir=/tmp
"""
FINISHED = """\
[Fri Nov 27 07:50:29 2026]
Finished jobid: 5 (Rule: {0})
1 of 3 steps (33%) done
"""
FAILED = """\
RuleException:
CalledProcessError in file "/clone/workflow/rules/calibration.smk", line 41:
Command 'set -euo pipefail;  python reject_outliers.py' returned non-zero exit status 1.
[Fri Nov 27 07:55:47 2026]
Error in rule optimise:
    message: None
    jobid: 7
    output: results/mine/optima.parquet
    log: results/logs/mine/optimise.log (check log file(s) for error details)
Exiting because a job execution failed. Look above for error messages
WorkflowError:
At least one job did not complete successfully.
"""


@pytest.fixture
def lines():
    return StageLines()


def told(lines, text):
    return [line for message in text.splitlines() if (line := lines.hear(message)) is not None]


def test_stages_are_counted_and_each_is_one_line_with_its_last_word(lines):
    assert told(lines, PLANNED) == ["2 stages to run"]
    assert told(lines, BEGUN.format("check_data") + BEGUN.format("optimise")) == []
    assert lines.running == ["check_data", "optimise"]
    said = "linepose.optimise: all: -log L 3\nlinepose.optimise: inliers: -log L 1\n"
    said += "linepose.experiments.check_data: 13 files\n"
    assert told(lines, said + FINISHED.format("optimise")) == ["1/2 optimise: inliers: -log L 1"]
    assert lines.running == ["check_data"]
    assert told(lines, FINISHED.format("check_data") + FINISHED.format("all")) == ["2/2 check_data: 13 files"]


def test_failure_is_one_line_with_the_stages_word_and_its_log(lines):
    fault = "linepose.optimise: undefined at the start; check hand_measured\n"
    assert told(lines, BEGUN.format("optimise") + fault + FAILED) == [
        "optimise failed: undefined at the start; check hand_measured"
    ]
    assert (lines.told_why, lines.log) == (True, "results/logs/mine/optimise.log")


def test_stage_that_ends_without_a_word_is_told(lines):
    assert told(lines, FAILED) == ["optimise failed: it ended without a word"]


@pytest.mark.parametrize(
    "warning",
    [
        "linepose.diagnose: warning: all: 12 of 16 walkers moved",
        "linepose.inputs.labels.labelled_views: warning: view1.csv: no label for point 3: left out",
        "linepose: results/tiny/mcmc: all.parquet lost; the folder is made again",
    ],
)
def test_warnings_are_shown_at_once(lines, warning):
    assert told(lines, f"{warning}\n") == [warning]
    assert not lines.told_why


def test_run_that_another_is_in_the_way_of_is_told_by_that_alone(lines):
    busy = "linepose: /here: found another run at work here (process 7), expected one run at a time; wait for it"
    assert told(lines, f"{busy}\n") == [busy]
    assert (lines.told_why, lines.log) == (True, None)


def test_fault_outside_a_stage_is_kept_in_snakemakes_words(lines):
    text = 'Building DAG of jobs...\nWorkflowError in file "common.smk", line 38:\nconfig.yaml: found 3\n'
    assert told(lines, text) == []
    assert not lines.told_why
    assert lines.unexplained == ['WorkflowError in file "common.smk", line 38:', "config.yaml: found 3"]


def test_nothing_to_do_is_told(lines):
    nothing = "Nothing to be done (all requested files are present and up to date)."
    assert told(lines, nothing) == ["nothing to run: all results are up to date"]
