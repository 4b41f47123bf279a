"""Work in blocks, on all cores, in an order that does not matter."""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

Result = TypeVar("Result")


def in_blocks(total: int, size: int, work: Callable[[int, int], Result], n_cores: int) -> list[Result]:
    """What `work` returns for each block (first, end) of `size` of `total`, in their order, by as many threads."""
    blocks = [(first, min(first + size, total)) for first in range(0, total, size)]
    if n_cores <= 1:
        return [work(*block) for block in blocks]
    with ThreadPoolExecutor(n_cores) as pool:
        waiting = [pool.submit(work, *block) for block in blocks]
        try:
            return [one.result() for one in waiting]
        finally:
            pool.shutdown(cancel_futures=True)
