"""What SLURM says: whether it is there, what its nodes have, and what became of jobs."""

import re
import shutil
import subprocess
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from linepose.errors import InputError

_PLACE: Final = "SLURM"
_LOGS: Final = Path(".snakemake", "slurm_logs")
_ANSWER_WITHIN_S: Final = 30
_COMMENT: Final = "rule_"  # with which the executor's jobs are marked
_SUBMITTED: Final = re.compile(r"Job (\S+) has been submitted with SLURM jobid (\d+) \(log: (.+)\)")
_ENDED: Final = re.compile(r"SLURM-job '(\d+)' failed(?: due to a node failure)?, SLURM status is: '(\w+)'")
_TOLD: Final = re.compile(r"\s*linepose(?:\.\w+)*: (.*\bfound .*)")
_MEMORY: Final = re.compile(r"exceeded (?:job |step )?memory limit|oom[-_ ]kill", re.IGNORECASE)
_REMEDIES: Final = {
    "CANCELLED": "start the same command again: it goes on where it was",
    "OUT_OF_MEMORY": "give its rule more with --set-resources RULE:mem_mb=MB (after `linepose run`: behind --)",
    "TIMEOUT": "give its rule more with --set-resources RULE:runtime=MINUTES (after `linepose run`: behind --)",
    "NODE_FAIL": "leave the node out with --slurm-exclude-failed-nodes NODE (after `linepose run`: behind --)",
    "PREEMPTED": "start the same command again when the cluster has room",
}


@dataclass(frozen=True)
class Asked:
    """What a job asks of its node: the rule's name, processor cores, memory in MB."""

    rule: str
    cores: int
    memory_mb: int


@dataclass(frozen=True)
class Largest:
    """The largest node: processor cores, memory in MB."""

    cores: int
    memory_mb: int


def largest_node() -> Largest:
    """The most cores and the most memory that a node of this cluster has; raises InputError where there is no SLURM."""
    if shutil.which("sbatch") is None or shutil.which("sinfo") is None:
        found, remedy = "no sbatch on this machine", "run on the cluster's login node, or without --profile slurm"
        raise InputError(_PLACE, found, "the commands of a SLURM cluster", remedy)
    rows = [row.split("|") for row in _answer("sinfo", "--noheader", "--Node", "--format=%c|%m").splitlines()]
    nodes = [(int(cores.rstrip("+")), int(memory.rstrip("+"))) for cores, memory in rows]
    if not nodes:
        raise InputError(_PLACE, "no node", "a cluster that has some", "ask who runs the cluster")
    return Largest(max(cores for cores, _ in nodes), max(memory for _, memory in nodes))


def check_asked(jobs: Iterable[Asked], largest: Largest) -> None:
    """Raises InputError for a job that no node could ever be granted to: it would wait for ever."""
    for job in jobs:
        if job.cores > largest.cores:
            found, expected = f"{job.cores} cores asked for", f"at most {largest.cores}, as the largest node here has"
            raise InputError(job.rule, found, expected, f"set cores and max-threads of the profile to {largest.cores}")
        if job.memory_mb > largest.memory_mb:
            found, most = f"{job.memory_mb} MB asked for", largest.memory_mb
            remedy = f"give it less with --set-resources {job.rule}:mem_mb={most}"
            raise InputError(job.rule, found, f"at most {most}, as the largest node here has", remedy)


def wait_for_earlier_jobs(root: Path, tell: Callable[[str], None], look_s: float = 5.0) -> bool:
    """Wait for what a killed run left at work on SLURM in this folder; whether there was any.

    Jobs that have not begun are taken back, as nothing of them is lost; those at work go on, as what they make counts.
    Other jobs in the folder are left alone. Where SLURM does not answer, that is told and nothing awaited.
    """
    if not (root / _LOGS).is_dir() or shutil.which("squeue") is None:
        return False
    try:
        if not (jobs := _jobs_of(root)):
            return False
        _answer("scancel", "--state=PENDING", *jobs)
        many = f"{len(jobs)} job{'s' if len(jobs) > 1 else ''}"
        tell(f"linepose: {many} of an earlier run on SLURM: those that wait are taken back, the others awaited")
        while _jobs_of(root):
            time.sleep(look_s)
    except InputError as error:
        tell(f"linepose: {error}; jobs of an earlier run in this folder are not awaited")
        return False
    return True


def may_begin_again(arguments: Sequence[str]) -> bool:
    """Whether a command of Snakemake's, given again, finds its files from the folder that it has gone into."""
    for word, after in zip(arguments, [*arguments[1:], ""], strict=True):
        option, sign, value = word.partition("=")
        if option in {"--directory", "-d"} and not Path(value if sign else after).is_absolute():
            return False
    return True


def ended_jobs(log: str) -> list[str]:
    """One line for each job of a run that SLURM ended, from Snakemake's log, and whether it was tried again since."""
    submitted = _SUBMITTED.findall(log)
    logs = {number: Path(file) for _, number, file in submitted}
    job_of = {number: job for job, number, _ in submitted}
    last_of = {job: number for job, number, _ in submitted}
    ended = dict(_ENDED.findall(log))
    last = {number: last_of.get(job_of.get(number, ""), number) for number in ended}
    mended = {number: last[number] not in ended for number in ended}
    return [
        _told(number, state, logs.get(number, Path()), mended[number])
        for number, state in ended.items()
        if mended[number] or last[number] == number  # of several in vain the last alone
    ]


def _told(number: str, state: str, log: Path, mended: bool) -> str:
    """What became of a job: its own words where it has some, else SLURM's."""
    place = f"SLURM job {number} ({log.parent.relative_to(log.parents[2]) if len(log.parts) > 3 else 'no log'})"
    place += f" on {node}" if (node := _node_of(number)) else ""
    words = [found[1] for found in map(_TOLD.match, _lines(log)) if found]
    if any(_MEMORY.search(line) for line in _lines(log)):
        state = "OUT_OF_MEMORY"
    if mended:
        return f"linepose: {place}: {words[-1] if words else f'found {state}'}; it was tried again, nothing is lost"
    if words:
        return f"linepose: {place}: {words[-1]}"
    remedy = _REMEDIES.get(state, f"read {log}" if log.is_file() else "see whether its node has this folder")
    return f"linepose: {InputError(place, state, 'COMPLETED', remedy)}"


def _node_of(number: str) -> str | None:
    """The node on which a job was; None where SLURM does not say."""
    try:
        known = _answer("scontrol", "--oneliner", "show", "job", number)
    except (InputError, OSError):
        return None
    found = re.search(r"\bNodeList=([^(\s]\S*)", known)
    return found[1] if found else None


def _lines(log: Path) -> list[str]:
    return log.read_text(errors="replace").splitlines() if log.is_file() else []


def _jobs_of(root: Path) -> list[str]:
    """Numbers of this user's jobs that Snakemake's executor handed out and that wait or are at work in a folder."""
    rows = (row.split("|", 2) for row in _answer("squeue", "--me", "--noheader", "--format=%A|%Z|%k").splitlines())
    return [
        number
        for number, folder, comment in rows
        if comment.startswith(_COMMENT) and Path(folder).resolve() == root.resolve()
    ]


def _answer(*command: str) -> str:
    """What a command of SLURM prints; raises InputError where it does not answer."""
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=_ANSWER_WITHIN_S)
        told, failed = done.stderr.strip().splitlines(), done.returncode != 0
    except subprocess.TimeoutExpired:
        told, failed = [f"no answer in {_ANSWER_WITHIN_S} s"], True
    if failed:
        found = f"{command[0]}: {told[-1] if told else 'it failed'}"
        raise InputError(_PLACE, found, "an answer of the cluster", "ask who runs the cluster, and start again")
    return done.stdout
