"""Work in blocks, on all cores, in an order that does not matter."""

from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from typing import TypeVar

Item = TypeVar("Item")
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


def in_order(items: Iterable[Item], work: Callable[[Item], Result], n_cores: int) -> Iterator[tuple[Item, Result]]:
    """Each item with what `work` returns for it, in their order; few wait at a time, so that memory is bounded."""
    if n_cores <= 1:
        yield from ((item, work(item)) for item in items)
        return
    waiting: deque[tuple[Item, Future[Result]]] = deque()
    with ThreadPoolExecutor(n_cores) as pool:
        try:
            for item in items:
                waiting.append((item, pool.submit(work, item)))
                if len(waiting) > n_cores:
                    first, future = waiting.popleft()
                    yield first, future.result()
            yield from ((item, future.result()) for item, future in waiting)
        finally:
            pool.shutdown(cancel_futures=True)
