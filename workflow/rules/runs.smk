# How a run begins and ends, on this machine or with jobs on others, and what jobs ask of a scheduler.
import json
import os
import sys
from importlib.util import find_spec
from pathlib import Path

from snakemake.exceptions import WorkflowError
from snakemake.logging import logger

if find_spec("linepose") is None:
    expected = json.loads(os.environ.get("LINEPOSE_HEAD", "{}")).get("version", "")
    raise WorkflowError(
        f"linepose: node {os.uname().nodename}: found no package linepose in {sys.executable}, expected "
        f"linepose {expected or 'there'}; install it for that Python, or name another one's snakemake"
    )

from linepose.errors import LineposeError
from linepose.pipeline.cluster.node import check_node, hand_over
from linepose.pipeline.cluster.slurm import (
    Asked,
    check_asked,
    ended_jobs,
    largest_node,
    may_begin_again,
    wait_for_earlier_jobs,
)
from linepose.pipeline.fork_server.client import name_server
from linepose.pipeline.parent_process import COMMAND, SNAKEMAKE, exit_with_process
from linepose.pipeline.run_lock import check_no_run, hold_run_lock

# What a job asks of a scheduler, memory in MB and time in minutes; more with each attempt.
# Measured: 170 to 450 MB, and up to 770 in batches on two cores; Snakemake takes 300 MB beside it on a node.
LIGHT = {
    "mem_mb": lambda wildcards, attempt: 1000 * attempt,
    "runtime": lambda wildcards, attempt: 30 * attempt,
}
LONG = LIGHT | {"runtime": lambda wildcards, attempt: 240 * attempt}
BATCHES = LONG | {
    "mem_mb": lambda wildcards, threads, attempt: (700 + 300 * threads) * attempt
}

# Scripts end with the process that starts them, and that one with the `linepose run` that started it.
os.environ[SNAKEMAKE] = str(os.getpid())
name_server()
if COMMAND in os.environ and not workflow.remote_exec:  # which runs on this machine
    exit_with_process(COMMAND)


if workflow.remote_exec:
    try:
        check_node(Path())
    except LineposeError as error:
        raise WorkflowError(f"linepose: {error}") from None


def asked_of_nodes():
    """What the jobs of this run ask of their nodes."""
    jobs = [job for job in workflow.dag.needrun_jobs() if not job.is_local]
    return [
        Asked(job.rule.name, job.threads, int(job.resources.get("mem_mb") or 0))
        for job in jobs
    ]


def tell_ended_jobs(log):
    """One line on the error stream for each job that SLURM ended."""
    files = [Path(file) for file in ([log] if isinstance(log, str) else log or [])]
    for file in filter(Path.is_file, files):
        for line in ended_jobs(file.read_text()):
            print(line, file=sys.stderr)


onstart:
    try:
        check_no_run(Path())
        others = wait_for_earlier_jobs(Path(), logger.warning)
        hold_run_lock(Path())
        if workflow.non_local_exec:
            hand_over(Path())
        if workflow.executor_plugin.name == "slurm":
            check_asked(asked_of_nodes(), largest_node())
    except LineposeError as error:
        raise SystemExit(f"linepose: {error}") from None  # told on the error stream
    if others:  # plan anew, with what these have made
        if not may_begin_again(sys.argv):
            raise SystemExit(
                "linepose: the jobs of the earlier run have ended; start the same command again"
            )
        os.execv(sys.executable, sys.orig_argv)


onsuccess:
    tell_ended_jobs(log)


onerror:
    tell_ended_jobs(log)
