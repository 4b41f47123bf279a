"""How a job of the workflow begins: locked, bound to its run, its tables marked; and what it cost."""

import os
import resource
import sys
import time
from pathlib import Path
from typing import Any, Final

from linepose.pipeline.parent_process import SNAKEMAKE, exit_with_process
from linepose.pipeline.provenance import FOR_THE_ORDER_ALONE, Provenance, provenance_of_job
from linepose.pipeline.run_lock import hold_job_lock
from linepose.tables import mark_tables

_TABLES: Final = (".parquet", "")  # endings of files that say what made them, and of folders of such
_UNIT_BYTES: Final = 1 if sys.platform == "darwin" else 1024  # of the memory that the system tells


def begin_job(job: Any) -> None:
    """Hold the jobs' lock, end with Snakemake, and mark each table that is written with what made it.

    `job` is the `snakemake` object of a script.
    """
    exit_with_process(SNAKEMAKE)
    hold_job_lock(Path())
    os.environ.setdefault("NUMBA_NUM_THREADS", str(job.threads))
    if any(Path(file).suffix in _TABLES for file in job.output):
        mark_tables(_provenance(job).text())


def told_cost(begun_s: float) -> str:
    """What this process and those that it started cost since `begun_s` (of `time.monotonic`), in words.

    The memory is the largest of a single process.
    """
    usages = [resource.getrusage(whose) for whose in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    processor_s = sum(usage.ru_utime + usage.ru_stime for usage in usages)
    memory_mb = max(usage.ru_maxrss for usage in usages) * _UNIT_BYTES / 1e6
    elapsed_s = time.monotonic() - begun_s
    return f"took {elapsed_s:.1f} s, {processor_s:.1f} s of processor time, at most {memory_mb:.0f} MB in a process"


def _provenance(job: Any) -> Provenance:
    found = [job.input.get(name, []) for name in FOR_THE_ORDER_ALONE]
    order_alone = {file for files in found for file in ([files] if isinstance(files, str) else files)}
    return provenance_of_job(dict(job.params.items()), [file for file in job.input if file not in order_alone])
