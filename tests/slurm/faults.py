"""A job cancelled, a node drained, the head process killed, too little memory: nothing lost, nothing run twice."""

import re
import signal
import subprocess
import sys
import time
from pathlib import Path

from cluster import slurm
from project import CELL, LOCAL, SLURM, differences, run, start, tiny

N_SURVEYS = 24
PATIENCE_S = 900
PART = re.compile(r"output: (results/coverage/parts/\S+)")
LINE = re.compile(r"linepose: SLURM job \d+ .*", re.MULTILINE)


def faults(folder: Path) -> list[str]:
    """What was found; ends the test at the first thing that does not hold."""
    expected = tiny(folder / "faultless", N_SURVEYS)
    run(expected, *LOCAL, CELL)
    return [
        *cancelled_and_drained(folder, expected),
        *head_killed(folder, expected),
        *too_little_memory(folder),
    ]


def cancelled_and_drained(folder: Path, expected: Path) -> list[str]:
    """One node takes no further jobs and a job is cancelled: it is tried again on the other."""
    project = tiny(folder / "cancelled", N_SURVEYS)
    process = start(project, *SLURM, CELL)
    job = jobs_at_work(project)[0]
    node = (slurm("squeue", "--noheader", "--jobs", job, "--format=%N") or "").strip()
    slurm("scontrol", "update", f"nodename={node}", "state=drain", "reason=test")
    slurm("scancel", job)
    try:
        ended(process, project)
    finally:
        slurm("scontrol", "update", f"nodename={node}", "state=resume")
    told = one_line(project, "CANCELLED")
    same(project, expected)
    return [f"node {node} drained and a job on it cancelled: the same bytes; {told}"]


def head_killed(folder: Path, expected: Path) -> list[str]:
    """The process that hands out jobs is killed; the next takes its jobs over."""
    project = tiny(folder / "killed", N_SURVEYS)
    process = start(project, *SLURM, CELL)
    jobs_at_work(project)
    process.send_signal(signal.SIGKILL)
    process.wait()
    at_work = running_jobs(project)
    before = (project / "run.log").read_text()
    ended(start(project, *SLURM, CELL), project)
    after = (project / "run.log").read_text().removeprefix(before)
    if "of an earlier run on SLURM" not in after:
        sys.exit(f"slurm-test: found no word of the killed run's jobs in {project}/run.log:\n{after}")
    again = PART.findall(after.partition("of an earlier run on SLURM")[2].partition("Building DAG")[2])
    if len(set(PART.findall(before))) < len(at_work) + len(set(again)):
        sys.exit(f"slurm-test: found {again} made again after {at_work} were at work:\n{after}")
    same(project, expected)
    return [f"head process killed with {len(at_work)} jobs at work: these were awaited, {len(set(again))} others begun"]


def too_little_memory(folder: Path) -> list[str]:
    """A job that takes more than it asked for is ended by SLURM, and told in one line."""
    project = tiny(folder / "memory", N_SURVEYS)
    process = start(project, *SLURM, "--retries", "0", "--set-resources", "compile:mem_mb=60", "--", CELL)
    if process.wait(PATIENCE_S) == 0:
        sys.exit("slurm-test: found a job that 60 MB were enough for, expected that SLURM ends it")
    return [f"too little memory: {one_line(project, 'OUT_OF_MEMORY')}"]


def jobs_at_work(project: Path) -> list[str]:
    """Numbers of a project's jobs, once parts of its cell are at work."""
    deadline = time.monotonic() + PATIENCE_S
    while "rule coverage_part" not in (project / "run.log").read_text():
        wait_until(deadline, project)
    while not (jobs := running_jobs(project)):
        wait_until(deadline, project)
    return jobs


def running_jobs(project: Path) -> list[str]:
    """Numbers of a project's jobs that are at work."""
    rows = (slurm("squeue", "--noheader", "--states=RUNNING", "--format=%A|%Z") or "").split()
    return [row.partition("|")[0] for row in rows if row.endswith(f"|{project}")]


def wait_until(deadline: float, project: Path) -> None:
    """Wait a moment; end the test when it has taken too long."""
    if time.monotonic() > deadline:
        sys.exit(f"slurm-test: no job at work after {PATIENCE_S} s:\n{(project / 'run.log').read_text()}")
    time.sleep(0.2)


def ended(process: "subprocess.Popen[str]", project: Path) -> None:
    """Wait for a run; end the test where it failed."""
    if process.wait(PATIENCE_S):
        sys.exit(f"slurm-test: found a run that failed in {project}:\n{(project / 'run.log').read_text()}")


def one_line(project: Path, state: str) -> str:
    """The line about the job that SLURM ended; ends the test where there is another number of them than one."""
    lines = [line for line in LINE.findall((project / "run.log").read_text()) if state in line]
    if len(lines) != 1:
        sys.exit(f"slurm-test: found {len(lines)} lines about {state}:\n{(project / 'run.log').read_text()}")
    return lines[0]


def same(project: Path, expected: Path) -> None:
    """End the test where the results differ."""
    if unlike := differences(project, expected):
        sys.exit(f"slurm-test: found other bytes in {', '.join(unlike)} of {project}, expected those of {expected}")
