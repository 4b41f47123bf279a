"""Snakemake as a child process that ends with the command that started it."""

import contextlib
import os
import re
import subprocess
import sys
import termios
import threading
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from linepose.pipeline.parent_process import COMMAND

BY_KEYBOARD: Final = 128 + 2
"""Exit code of a run that was ended by the keyboard, as shells tell of a process that SIGINT has ended."""

_PATIENCE_S: Final = 10.0
_ROWS_AND_COLUMNS: Final = (24, 64)  # beside the stages at work on a line of 80
_BAR: Final = re.compile(r"\d+%\||\d+it ")  # of tqdm


@dataclass(frozen=True)
class Followed:
    """How a run that was followed has ended: its exit code, and why its messages could not all be kept, if so."""

    code: int
    log_fault: OSError | None


def run_snakemake(snakefile: Path, root: Path, arguments: Sequence[str]) -> int:
    """Run a workflow in the project's folder; its exit code. It ends when this process does, however that ends."""
    return _start(snakefile, root, arguments).wait()


def follow_snakemake(
    snakefile: Path,
    root: Path,
    arguments: Sequence[str],
    log: Path,
    hear: Callable[[str], None],
    hear_bar: Callable[[str], None] | None = None,
) -> Followed:
    """Run a workflow as `run_snakemake` does, with its messages in a file and told one by one to `hear`.

    With `hear_bar` its jobs take the error stream for a terminal and draw progress bars there, which are told to it
    and not kept. A file that cannot take all messages, as on a full disk, is told with the exit code.
    """
    log.parent.mkdir(parents=True, exist_ok=True)
    file = _Log(log)
    source, sink = os.pipe() if hear_bar is None else _terminal()
    try:
        child = _start(snakefile, root, ["--nocolor", *arguments], sink)
    finally:
        os.close(sink)
    with contextlib.closing(file), contextlib.closing(_Source(source)) as told:
        try:
            _hear_all(told.pieces(), file.keep, hear, hear_bar)
            code = child.wait()
        except KeyboardInterrupt:  # which a terminal sends to the child too; it goes on telling until it has ended
            end = threading.Timer(_PATIENCE_S, child.kill)
            end.start()
            _hear_all(told.pieces(), file.keep, lambda _: None, None)
            child.wait()
            end.cancel()
            code = BY_KEYBOARD
    return Followed(code, file.fault)


def files_of_workflow(snakefile: Path, root: Path, arguments: Sequence[str]) -> set[str]:
    """The files, by their paths in the project, that a run with these arguments would make or find made."""
    summary = [*_command(snakefile, root), *arguments, "--summary"]
    done = subprocess.run(summary, capture_output=True, text=True, check=False)
    return {line.split("\t")[0] for line in done.stdout.splitlines()} if done.returncode == 0 else set()


def _terminal() -> tuple[int, int]:
    """Both ends of a pseudo-terminal with a size: in one without, tqdm draws no bar."""
    source, sink = os.openpty()
    termios.tcsetwinsize(sink, _ROWS_AND_COLUMNS)
    return source, sink


class _Log:
    """A file of messages; one that it cannot take, as on a full disk, and those after it are not kept.

    `fault` is why, with the file's name.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self._file = path.open("w", 1, encoding="utf-8")
        self.fault: OSError | None = None

    def keep(self, message: str) -> None:
        """Write a message, unless one before it could not be."""
        if self.fault is None:
            try:
                self._file.write(message)
            except OSError as error:
                self._give_up(error)

    def close(self) -> None:
        """End the file."""
        try:
            self._file.close()
        except OSError as error:
            self._give_up(error)

    def _give_up(self, error: OSError) -> None:
        self.fault = self.fault or OSError(error.errno, os.strerror(error.errno or 0), str(self._path))


class _Source:
    """The reading end of a pipe or pseudo-terminal, in pieces that end in a line feed or carriage return."""

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor
        self._waiting: deque[bytes] = deque()
        self._rest = b""

    def close(self) -> None:
        os.close(self._descriptor)

    def pieces(self) -> Iterator[str]:
        """Every piece that nobody has taken yet, also where who took the last was interrupted."""
        while self._waiting or self._wait():
            yield self._waiting.popleft().decode(errors="replace")

    def _wait(self) -> bool:
        """Wait for a piece; whether there is one, or the other end is closed."""
        while not self._waiting and (chunk := self._read()):
            *pieces, rest = re.split(rb"[\r\n]+", self._rest + chunk)
            if _BAR.search(rest.decode(errors="replace")):  # its carriage return comes with the next one
                pieces, rest = [*pieces, rest], b""
            self._waiting.extend(piece for piece in pieces if piece)
            self._rest = rest
        if not self._waiting and self._rest:
            self._waiting, self._rest = deque([self._rest]), b""
        return bool(self._waiting)

    def _read(self) -> bytes:
        try:
            return os.read(self._descriptor, 65536)
        except OSError:  # how a pseudo-terminal says that its other end is closed
            return b""


def _hear_all(
    pieces: Iterator[str],
    keep: Callable[[str], object],
    hear: Callable[[str], None],
    hear_bar: Callable[[str], None] | None,
) -> None:
    for piece in pieces:
        if hear_bar is not None and _BAR.search(piece):
            hear_bar(piece.strip())
        else:
            keep(f"{piece}\n")
            hear(piece)


def _start(
    snakefile: Path, root: Path, arguments: Sequence[str], stderr: int | None = None
) -> "subprocess.Popen[bytes]":
    environment = os.environ | {COMMAND: str(os.getpid())}
    return subprocess.Popen([*_command(snakefile, root), *arguments], env=environment, stderr=stderr)


def _command(snakefile: Path, root: Path) -> list[str]:
    return [sys.executable, "-m", "snakemake", "--snakefile", str(snakefile), "--directory", str(root)]
