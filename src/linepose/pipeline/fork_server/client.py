"""A script handed to the fork server of its run, which the first job starts. Imports the standard library alone.

Only jobs of one thread are handed over: how many threads the numerical libraries have is settled when they are loaded.
"""

import json
import os
import secrets
import socket
import struct
import subprocess
import sys
from pathlib import Path
from typing import Final

from linepose.pipeline.parent_process import SNAKEMAKE

NAME: Final = "LINEPOSE_FORK_SERVER"
"""Environment variable: the name of the server's socket, which no file stands for; where none, all run alone."""

BEGUN: Final = b"b"
"""What a job sends when it begins; its exit code follows when it ends."""

_SERVER: Final = "linepose.pipeline.fork_server.server"
_WAITING: Final = 128
_KILLED: Final = 128 + 9  # as shells tell of a process that SIGKILL has ended
_CREDENTIALS: Final = struct.Struct("3i")  # process, user, group


def name_server() -> None:
    """Name this run's fork server; nothing is started before a job asks for it."""
    os.environ[NAME] = f"linepose-{secrets.token_hex(8)}"


def is_own(connection: socket.socket) -> bool:
    """Whether the process at the other end is this user's: names of sockets without a file are open to all."""
    told = connection.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, _CREDENTIALS.size)
    return bool(_CREDENTIALS.unpack(told)[1] == os.getuid())


def run_forked(script: str, rule: str, log: Path, threads: int) -> int | None:
    """The exit code of a script that the fork server ran; None where it did not begin, and is to run here.

    Output goes to this process's streams. The job ends with this process, and with Snakemake. That its own process was
    killed is told in the log of its rule.
    """
    name = os.environ.get(NAME)
    if not name or threads > 1 or not _can_follow(os.environ.get(SNAKEMAKE, "")):
        return None
    try:
        connection = _connect(f"\0{name}")
    except (OSError, ValueError):
        return None
    with connection:
        code = _run(connection, script) if is_own(connection) else None
    if code == _KILLED:
        _tell_killed(rule, log)
    return code


def _can_follow(process: str) -> bool:
    """Whether this system, and what confines its processes, lets the server wait for another process to end."""
    if not hasattr(os, "pidfd_open"):
        return False
    try:
        os.close(os.pidfd_open(int(process)))
    except (OSError, ValueError, OverflowError):
        return False
    return True


def _run(connection: socket.socket, script: str) -> int | None:
    environment = {name: value for name, value in os.environ.items() if name != NAME}
    job = json.dumps({"script": script, "folder": str(Path.cwd()), "environment": environment}).encode()
    try:
        sys.stdout.flush()
        sys.stderr.flush()
        socket.send_fds(connection, [len(job).to_bytes(8, "big")], [1, 2])
        connection.sendall(job)
        if connection.recv(1) != BEGUN:
            return None
    except OSError:
        return None
    try:
        code = connection.recv(1)
    except OSError:
        code = b""
    except KeyboardInterrupt:  # which the job has from the terminal too
        return 130
    return code[0] if code else _KILLED


def _tell_killed(rule: str, log: Path) -> None:
    told = f"linepose.{rule}: found its process killed, expected its end; see whether memory was short, and run again"
    print(told, file=sys.stderr)
    with log.open("a") as file:
        print(told, file=file)


def _connect(address: str) -> socket.socket:
    """A connection to the server, which the first that finds none starts."""
    with socket.socket(socket.AF_UNIX) as listener:
        try:
            listener.bind(address)
        except OSError:  # there is one
            pass
        else:
            listener.listen(_WAITING)
            _start(listener)
    connection = socket.socket(socket.AF_UNIX)
    try:
        connection.connect(address)
    except OSError:
        connection.close()
        raise
    return connection


def _start(listener: socket.socket) -> None:
    subprocess.Popen(
        [sys.executable, "-m", _SERVER, str(listener.fileno()), os.environ[SNAKEMAKE]],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        pass_fds=[listener.fileno()],
    )
