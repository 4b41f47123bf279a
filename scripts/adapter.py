"""What every script shares: its log, its threads, and errors told in one line."""

import logging
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from linepose.errors import one_line
from linepose.pipeline.parent_process import SNAKEMAKE, exit_with_process
from linepose.pipeline.provenance import FOR_THE_ORDER_ALONE, Provenance, provenance_of_job
from linepose.pipeline.run_lock import hold_job_lock
from linepose.tables import mark_tables

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
    or it would be in the way of the run that goes on.
    """
    exit_with_process(SNAKEMAKE)
    hold_job_lock(Path())
    os.environ.setdefault("NUMBA_NUM_THREADS", str(job.threads))
    log = logging.getLogger(f"linepose.{job.rule}")
    handlers = [logging.FileHandler(str(job.log[0]), mode="w"), logging.StreamHandler()]
    for handler in handlers:
        handler.setFormatter(_Marked("%(name)s: %(message)s"))
    logging.basicConfig(level=logging.INFO, handlers=handlers)
    for name in _HUSHED:
        logging.getLogger(name).setLevel(logging.WARNING)
    if any(Path(file).suffix in (".parquet", "") for file in job.output):
        mark_tables(_provenance(job).text())
    try:
        yield log
    except Exception as error:
        told = one_line(error)
        if told is None:
            log.exception("unforeseen fault: please report it with this log")
        else:
            log.error("%s", told)
        sys.exit(1)


def _provenance(job: Any) -> Provenance:
    found = [job.input.get(name, []) for name in FOR_THE_ORDER_ALONE]
    order_alone = {file for files in found for file in ([files] if isinstance(files, str) else files)}
    return provenance_of_job(dict(job.params.items()), [file for file in job.input if file not in order_alone])
