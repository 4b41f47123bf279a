"""A script handed to the fork server of its run, which the first job starts. Imports the standard library alone.

Only jobs of one thread are handed over: how many threads the numerical libraries have is settled when they are loaded.
"""

import fcntl
import json
import os
import secrets
import socket
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Final

from linepose.pipeline.parent_process import SNAKEMAKE

FOLDER: Final = "LINEPOSE_FORK_SERVER"
"""Environment variable: the folder of the server's socket, of a name that nobody can guess."""

BEGUN: Final = b"b"
"""What a job sends when it begins; its exit code follows when it ends."""

_SERVER: Final = "linepose.pipeline.fork_server.server"
_WAITING: Final = 128


def name_server_folder() -> None:
    """Name the folder of this run's fork server; nothing is made before a job asks for it."""
    os.environ[FOLDER] = str(Path(tempfile.gettempdir()) / f"linepose-{secrets.token_hex(8)}")


def run_forked(script: str, threads: int) -> int | None:
    """The exit code of a script that the fork server ran; None where it did not begin, and is to run here.

    Output goes to this process's streams. The job ends with this process, and with Snakemake.
    """
    folder = os.environ.get(FOLDER)
    if not folder or threads > 1 or not _can_follow(int(os.environ[SNAKEMAKE])):
        return None
    try:
        connection = _connect(Path(folder))
    except OSError:
        return None
    with connection:
        return _run(connection, script)


def _can_follow(process: int) -> bool:
    """Whether this system, and what confines its processes, lets the server wait for another process to end."""
    if not hasattr(os, "pidfd_open"):
        return False
    try:
        os.close(os.pidfd_open(process))
    except OSError:
        return False
    return True


def _run(connection: socket.socket, script: str) -> int | None:
    environment = {name: value for name, value in os.environ.items() if name != FOLDER}
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
    if not code:
        fault = "found its process killed, expected its end; see whether memory was short, and run again"
        print(f"{Path(script).name}: {fault}", file=sys.stderr)
        return 137
    return code[0]


def _connect(folder: Path) -> socket.socket:
    """A connection to the server, which is started where there is none yet."""
    folder.mkdir(mode=0o700, exist_ok=True)
    address = str(folder / "socket")
    with (folder / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if not Path(address).exists():
            _start(address)
    connection = socket.socket(socket.AF_UNIX)
    try:
        connection.connect(address)
    except OSError:
        connection.close()
        raise
    return connection


def _start(address: str) -> None:
    with socket.socket(socket.AF_UNIX) as listener:
        listener.bind(address)
        listener.listen(_WAITING)
        subprocess.Popen(
            [sys.executable, "-m", _SERVER, str(listener.fileno()), os.environ[SNAKEMAKE]],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            pass_fds=[listener.fileno()],
        )
