"""What SLURM says is told in one line, with commands of SLURM that are fakes."""

import re

import pytest

from linepose.errors import InputError
from linepose.pipeline.cluster.slurm import (
    Asked,
    Largest,
    check_asked,
    ended_jobs,
    largest_node,
    may_begin_again,
    wait_for_earlier_jobs,
)

LOG = """\
Job 26 has been submitted with SLURM jobid 4 (log: {log}).
    message: SLURM-job '4' failed, SLURM status is: '{state}'. Detailed failure reason unavailable
"""


@pytest.fixture
def command(tmp_path, monkeypatch):
    """Makes a command of SLURM that is a shell script; no others are there."""
    folder = tmp_path / "bin"
    folder.mkdir()
    monkeypatch.setenv("PATH", str(folder))

    def make(name, script):
        (folder / name).write_text(f"#!/bin/sh\n{script}\n")
        (folder / name).chmod(0o755)

    make("scontrol", "echo 'JobId=4 ReqNodeList=(null) NodeList=n2 BatchHost=n2'")
    return make


def test_the_largest_node_has_the_most_of_each(command):
    command("sbatch", "")
    command("sinfo", "echo '4|8000'; echo '64+|2000+'")
    assert largest_node() == Largest(64, 8000)


def test_no_slurm_is_one_line_that_says_where_to_run(command):
    with pytest.raises(InputError, match=r"SLURM: found no sbatch on this machine, expected .*login node"):
        largest_node()


@pytest.mark.parametrize("script", ["echo 'sinfo: error: Unable to contact slurm controller' >&2; exit 1", "exit 1"])
def test_a_slurm_that_does_not_answer_is_one_line(command, script):
    command("sbatch", "")
    command("sinfo", script)
    with pytest.raises(InputError, match=r"SLURM: found sinfo: .*, expected an answer of the cluster"):
        largest_node()


def test_a_profile_for_larger_machines_is_refused():
    largest = Largest(cores=2, memory_mb=4000)
    check_asked([Asked("basin", 2, 4000)], largest)
    with pytest.raises(
        InputError, match=r"basin: found 4 cores asked for, expected at most 2.*max-threads of the profile to 2"
    ):
        check_asked([Asked("basin", 4, 1000)], largest)
    with pytest.raises(InputError, match=r"basin: found 5000 MB asked for, .*--set-resources basin:mem_mb=4000"):
        check_asked([Asked("basin", 1, 5000)], largest)


def test_jobs_of_a_killed_run_are_taken_back_or_awaited(command, tmp_path):
    """Those of other folders and of other programs are left alone; the queue is empty of ours at the third look."""
    (tmp_path / ".snakemake" / "slurm_logs").mkdir(parents=True)
    count = tmp_path / "count"
    ours, foreign = f"7|{tmp_path}|rule_basin_wildcards_tiny", f"9|{tmp_path}|(null)"
    rows = f"echo '{ours}'; echo '8|/elsewhere|rule_basin'"
    looked = f"if [ -e {count} ]; then : > {count}.2; fi; : > {count}"
    command("squeue", f"echo '{foreign}'; if [ ! -e {count}.2 ]; then {rows}; fi; {looked}")
    command("scancel", f'echo "$@" >> {tmp_path}/cancelled')
    told = []
    assert wait_for_earlier_jobs(tmp_path, told.append, look_s=0.0)
    assert (tmp_path / "cancelled").read_text() == "--state=PENDING 7\n"
    assert len(told) == 1
    assert told[0].startswith("linepose: 1 job of an earlier run on SLURM")
    assert not wait_for_earlier_jobs(tmp_path, told.append, look_s=0.0)


@pytest.mark.parametrize(
    ("arguments", "may"),
    [
        (["snakemake", "--cores", "2"], True),
        (["snakemake", "--directory", "/a/b", "all"], True),
        (["snakemake", "--directory", "b", "all"], False),
        (["snakemake", "--directory=b"], False),
        (["snakemake", "-d", "b"], False),
    ],
)
def test_a_command_whose_paths_count_from_elsewhere_is_not_begun_again(arguments, may):
    assert may_begin_again(arguments) is may


def test_a_slurm_that_is_down_is_told_and_not_awaited(command, tmp_path):
    (tmp_path / ".snakemake" / "slurm_logs").mkdir(parents=True)
    command("squeue", "echo 'slurm_load_jobs error: Unable to contact' >&2; exit 1")
    told = []
    assert not wait_for_earlier_jobs(tmp_path, told.append)
    assert len(told) == 1
    assert "are not awaited" in told[0]


def test_a_folder_that_never_saw_slurm_asks_nothing(command, tmp_path):
    command("squeue", "exit 1")
    assert not wait_for_earlier_jobs(tmp_path, print)


@pytest.mark.parametrize(
    ("state", "own", "line"),
    [
        ("CANCELLED", "", "found CANCELLED, expected COMPLETED; start the same command again"),
        ("FAILED", "slurmstepd: error: Job 4 exceeded memory limit", "found OUT_OF_MEMORY, .*mem_mb"),
        ("TIMEOUT", "", "found TIMEOUT, expected COMPLETED; .*runtime"),
        ("FAILED", "linepose: node n2: found linepose 0.0.7, expected linepose 0.1.0 as on a; b", "n2: node n2: found"),
        ("FAILED", "linepose.extract: a.csv: found 3, expected 4; mend", "a.csv: found 3, expected 4; mend"),
        ("FAILED", "", "found FAILED, expected COMPLETED; read .*4.log"),
    ],
)
def test_one_line_for_a_job_that_slurm_ended(command, tmp_path, state, own, line):
    log = tmp_path / "rule_basin" / "tiny" / "4.log"
    log.parent.mkdir(parents=True)
    log.write_text(f"Building DAG of jobs...\n{own}\n")
    told = ended_jobs(LOG.format(log=log, state=state))
    assert len(told) == 1
    assert re.search(line, told[0]), told[0]
    assert told[0].startswith("linepose: SLURM job 4 (rule_basin/tiny) on n2: ")
    again = f"Job 26 has been submitted with SLURM jobid 5 (log: {log}).\n"
    (mended,) = ended_jobs(LOG.format(log=log, state=state) + again)
    assert mended.endswith("; it was tried again, nothing is lost")
    assert "found found" not in mended
    in_vain = again + f"SLURM-job '5' failed, SLURM status is: '{state}'."
    (last,) = ended_jobs(LOG.format(log=log, state=state) + in_vain)
    assert last.startswith("linepose: SLURM job 5 ")
    assert "tried again" not in last


def test_a_log_that_the_folder_never_got_is_told(command):
    told = ended_jobs(LOG.format(log="/nowhere/rule_basin/tiny/4.log", state="FAILED"))
    assert told[0].endswith("see whether its node has this folder")


def test_a_lost_node_is_told_and_a_controller_that_is_down_spoils_nothing(command):
    command("scontrol", "exit 1")
    log = LOG.format(log="/nowhere/rule_basin/tiny/4.log", state="NODE_FAIL")
    (told,) = ended_jobs(log.replace("failed,", "failed due to a node failure,"))
    assert "found NODE_FAIL, expected COMPLETED; leave the node out" in told
