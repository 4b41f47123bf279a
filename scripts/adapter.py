"""What every script shares: its log, its threads, and errors told in one line."""

import logging
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from linepose.errors import LineposeError
from linepose.pipeline.parent_process import exit_with_parent

_HUSHED = ("numba", "matplotlib", "fontTools", "PIL")


@contextmanager
def stage(job: Any) -> Iterator[logging.Logger]:
    """Run a stage: its messages go to the rule's log and to the terminal; a fault ends the job with one line.

    `job` is the `snakemake` object of the script. Tracebacks of unforeseen faults go to the log and the terminal.
    When Snakemake is killed the job ends too, or it would be in the way of the run that goes on.
    """
    exit_with_parent(os.getppid())
    os.environ.setdefault("NUMBA_NUM_THREADS", str(job.threads))
    log = logging.getLogger(f"linepose.{job.rule}")
    logging.basicConfig(
        level=logging.INFO,
        format="%(name)s: %(message)s",
        handlers=[logging.FileHandler(str(job.log[0]), mode="w"), logging.StreamHandler()],
    )
    for name in _HUSHED:
        logging.getLogger(name).setLevel(logging.WARNING)
    try:
        yield log
    except LineposeError as error:
        log.error("%s", error)
        sys.exit(1)
    except Exception:
        log.exception("unforeseen fault: please report it with this log")
        sys.exit(1)
