"""The fork server of a run: it imports what scripts import, and forks a process for each. It ends with Snakemake."""

import ast
import contextlib
import gc
import importlib
import json
import multiprocessing
import os
import runpy
import select
import signal
import socket
import sys
import threading
import traceback
from pathlib import Path
from typing import Any

from linepose.pipeline.fork_server.client import BEGUN, is_own


def main() -> None:
    """Serve the listening socket and the Snakemake process that the arguments name, a descriptor and a process id."""
    descriptor, snakemake = (int(argument) for argument in sys.argv[1:])
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # a terminal sends it to the jobs too
    try:
        _serve(socket.socket(fileno=descriptor), snakemake)
    finally:
        os._exit(0)  # without waiting for jobs, which end by themselves when Snakemake has ended


def imported_modules(script: Path) -> list[str]:
    """The modules of this package that a script imports, at its top or further in."""
    nodes = list(ast.walk(ast.parse(script.read_bytes())))
    named = [node.module or "" for node in nodes if isinstance(node, ast.ImportFrom) and node.level == 0]
    named += [alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names]
    return sorted({name for name in named if name.partition(".")[0] == __package__.partition(".")[0]})


def _serve(listener: socket.socket, snakemake: int) -> None:
    try:
        end = os.pidfd_open(snakemake)
    except OSError:  # it has ended already
        return
    while True:
        ended_jobs = [process.sentinel for process in multiprocessing.active_children()]
        ready, _, _ = select.select([listener.fileno(), end, *ended_jobs], [], [])
        if end in ready:
            return
        if listener.fileno() in ready:
            with contextlib.suppress(OSError, ValueError):  # a client that was killed as it asked
                _begin(listener)


def _begin(listener: socket.socket) -> None:
    with listener.accept()[0] as connection:
        if not is_own(connection):
            return
        length, streams, _, _ = socket.recv_fds(connection, 8, 2)
        try:
            job = json.loads(_read(connection, int.from_bytes(length, "big")))
            for module in imported_modules(Path(job["folder"]) / job["script"]):
                with contextlib.suppress(Exception):  # the job meets it again, and tells it
                    importlib.import_module(module)
            gc.freeze()
            multiprocessing.get_context("fork").Process(target=_run, args=(job, connection, streams)).start()
        finally:
            for stream in streams:
                os.close(stream)


def _read(connection: socket.socket, length: int) -> bytes:
    text = bytearray()
    while len(text) < length:
        piece = connection.recv(length - len(text))
        if not piece:
            raise ValueError("the client is gone")
        text += piece
    return bytes(text)


def _run(job: dict[str, Any], connection: socket.socket, streams: list[int]) -> None:
    """Run a script in this process, a fork of the server, as if it had been started alone."""
    signal.signal(signal.SIGINT, signal.default_int_handler)
    os.environ.clear()
    os.environ.update(job["environment"])
    os.chdir(job["folder"])
    for stream, number in zip(streams, (1, 2), strict=True):
        os.dup2(stream, number)
    sys.argv = [job["script"]]
    connection.sendall(BEGUN)
    threading.Thread(target=_exit_with_client, args=(connection,), daemon=True).start()
    code = _exit_code(job["script"])
    sys.stdout.flush()
    sys.stderr.flush()
    connection.sendall(bytes([code]))
    connection.shutdown(socket.SHUT_RDWR)


def _exit_code(script: str) -> int:
    try:
        runpy.run_path(script, run_name="__main__")
    except SystemExit as end:
        if end.code is None or isinstance(end.code, int):
            return (end.code or 0) & 0xFF
        print(end.code, file=sys.stderr)
        return 1
    except BaseException:
        traceback.print_exc()
        return 1
    return 0


def _exit_with_client(connection: socket.socket) -> None:
    """End this process when the client's is gone: nobody would take its result."""
    with contextlib.suppress(OSError):
        connection.recv(1)
    if connection.fileno() >= 0:
        os._exit(1)


if __name__ == "__main__":
    main()
