"""What every script shares: its log, its threads, and errors told in one line."""

import logging
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from linepose.pipeline.fork_server.client import run_forked

_HUSHED = ("numba", "matplotlib", "fontTools", "PIL")


class _Marked(logging.Formatter):
    """Marks warnings, which `linepose run` shows although it shows one line a stage."""

    def format(self, record: logging.LogRecord) -> str:
        text = super().format(record)
        return text.replace(": ", ": warning: ", 1) if record.levelno == logging.WARNING else text


@contextmanager
def stage(job: Any) -> Iterator[logging.Logger]:
    """Run a stage: its messages go to the rule's log and to the terminal; a fault ends the job with one line.

    `job` is the `snakemake` object of the script. Tracebacks of unforeseen faults go to the log and the terminal.
    Each table that it writes says which settings, inputs and code made it. When Snakemake is killed the job ends too,
    or it would be in the way of the run that goes on. A job of one thread runs in a fork of its run's fork server.
    """
    code = run_forked(sys.argv[0], job.rule, Path(job.log[0]), job.threads)
    if code is not None:
        sys.exit(code)
    from linepose.errors import one_line
    from linepose.pipeline.job import begin_job, told_cost

    begun_s = time.monotonic()
    log = logging.getLogger(f"linepose.{job.rule}")
    handlers = [logging.FileHandler(str(job.log[0]), mode="w"), logging.StreamHandler()]
    for handler in handlers:
        handler.setFormatter(_Marked("%(name)s: %(message)s"))
    logging.basicConfig(level=logging.INFO, handlers=handlers)
    for name in _HUSHED:
        logging.getLogger(name).setLevel(logging.WARNING)
    begin_job(job)
    try:
        yield log
    except Exception as error:
        told = one_line(error)
        if told is None:
            log.exception("unforeseen fault: please report it with this log")
        else:
            log.error("%s", told)
        sys.exit(1)
    with Path(job.log[0]).open("a") as file:
        print(f"{log.name}: {told_cost(begun_s)}", file=file)
