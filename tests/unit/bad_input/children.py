"""Readings in a child process, so that one that never ends or takes all memory is counted and ended."""

import multiprocessing
from collections.abc import Iterator, Sequence
from multiprocessing.connection import Connection

from unit.bad_input.outcome import HANG, TRACEBACK, Outcome, outcome
from unit.bad_input.reader import Reader

_PATIENCE_S = 120.0  # on a busy machine; a reading's own seconds are those of its process


def outcomes(reader: Reader, contents: Sequence[bytes]) -> Iterator[Outcome]:
    """What comes of each content of the reader's spoilt file, in their order."""
    done = 0
    while done < len(contents):
        context = multiprocessing.get_context("fork")
        ours, theirs = context.Pipe(duplex=False)
        child = context.Process(target=_read_all, args=(reader, contents[done:], theirs))
        child.start()
        theirs.close()
        for found in _received(ours, len(contents) - done):
            done += 1
            yield found
        child.kill()
        child.join()


def _read_all(reader: Reader, contents: Sequence[bytes], to: Connection) -> None:
    for data in contents:
        to.send(outcome(reader, data))


def _received(ours: Connection, count: int) -> Iterator[Outcome]:
    """Outcomes until the last, or until one that does not come: its process hangs, or has been ended by the system."""
    for _ in range(count):
        if not ours.poll(_PATIENCE_S):
            yield Outcome(HANG, f"no end within {_PATIENCE_S:g} s", _PATIENCE_S, 0)
            return
        try:
            yield ours.recv()
        except EOFError:
            yield Outcome(TRACEBACK, "the process ended", 0.0, 0)
            return
