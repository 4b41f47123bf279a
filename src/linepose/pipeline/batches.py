"""Long work in batches: on several cores, each finished batch kept on disk, so that a killed run goes on where it was.

A batch's table must depend on the batch alone: then neither the number of cores, nor the size of the batches, nor when
the work was interrupted shows in the result.
"""

import contextlib
import hashlib
import json
import multiprocessing
import os
import shutil
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from pathlib import Path
from typing import Any, Final

import pandas as pd
import pyarrow as pa
from tqdm import tqdm

from linepose.pipeline.parent_process import exit_with_parent
from linepose.tables import read_table, write_table

Task = Callable[[str], pd.DataFrame]

FORKS: Final = sys.platform == "linux"
"""Whether a process with libraries loaded may be forked; where not, batches are made one after another."""

_task: Task | None = None


def run_batches(task: Task, names: Sequence[str], folder: Path, schema: pa.Schema, n_processes: int) -> pd.DataFrame:
    """The tables of all named batches, one below the other in the given order.

    `task` makes the table of the batch of a name; `folder` keeps each as NAME.parquet, written whole or not at all,
    and what it already holds is not made again. Works in `n_processes` processes of one thread each, on Linux; the
    caller must not have run compiled code on several threads before, which does not survive a fork.
    """
    waiting = [name for name in names if not _file(folder, name).is_file()]
    bar = tqdm(total=len(names), initial=len(names) - len(waiting), unit="batch", disable=None)
    with bar:
        for name, table in _made(task, waiting, n_processes):
            write_table(table, _file(folder, name), schema)
            bar.update()
    tables = [read_table(_file(folder, name), schema) for name in names]
    return pd.concat(tables, ignore_index=True) if tables else schema.empty_table().to_pandas()


def batch_ranges(count: int, size: int) -> dict[str, range]:
    """Consecutive ranges of at most `size` that cover 0 to `count`, by a name that sorts like them."""
    ranges = [range(first, min(first + size, count)) for first in range(0, count, size)]
    return {f"{cells.start:06d}-{cells.stop:06d}": cells for cells in ranges}


def share_of(count: int, scatter_item: str) -> range:
    """The consecutive numbers of 0 to `count` that fall to a part, named as Snakemake names it: "2-of-4"."""
    part, parts = (int(number) for number in scatter_item.split("-of-"))
    return range(count * (part - 1) // parts, count * part // parts)


def inputs_digest(settings: Mapping[str, Any], files: Iterable[Path | str]) -> str:
    """Digest of settings and of files' contents: names the folder whose batches belong to them and to nothing else."""
    digest = hashlib.sha256(json.dumps(settings, sort_keys=True, default=str).encode())
    for file in files:
        for path in sorted(Path(file).rglob("*.parquet")) if Path(file).is_dir() else [Path(file)]:
            digest.update(path.read_bytes())
    return digest.hexdigest()[:16]


def remove_finished(folder: Path) -> None:
    """Remove the batches of work whose result is written, and those of earlier work that was never finished."""
    shutil.rmtree(folder.parent, ignore_errors=True)
    with contextlib.suppress(OSError):  # what others keep there, or another job that has removed it
        folder.parent.parent.rmdir()


def _file(folder: Path, name: str) -> Path:
    return folder / f"{name}.parquet"


def _made(task: Task, names: Sequence[str], n_processes: int) -> Iterator[tuple[str, pd.DataFrame]]:
    """The batches of these names as they are finished, each with its name."""
    if not FORKS:
        _one_thread()
        yield from ((name, task(name)) for name in names)
        return
    with _workers(task, min(n_processes, max(len(names), 1))) as workers:
        running = {workers.submit(_run, name): name for name in names}
        try:
            for finished in as_completed(running):
                yield running[finished], finished.result()
        except BaseException:
            workers.shutdown(cancel_futures=True)
            raise


def _workers(task: Task, count: int) -> ProcessPoolExecutor:
    """Processes that share the task by forking, since a likelihood with its scratch arrays is not worth sending."""
    return ProcessPoolExecutor(count, multiprocessing.get_context("fork"), _begin, (task, os.getpid()))


def _begin(task: Task, parent: int) -> None:
    global _task
    _task = task
    _one_thread()
    exit_with_parent(parent)


def _one_thread() -> None:
    import numba

    numba.set_num_threads(1)


def _run(name: str) -> pd.DataFrame:
    if _task is None:
        raise RuntimeError("no task: this process was not started by run_batches")
    return _task(name)
