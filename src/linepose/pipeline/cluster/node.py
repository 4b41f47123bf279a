"""What a job on another machine must find there: the project's folder, room in it, this package, the right time.

The process that plans hands over what it is in an environment variable, which schedulers pass on to their jobs, and
each job compares before it works.
"""

import json
import os
import secrets
import shutil
import socket
import sys
import tempfile
import time
from importlib.metadata import version
from pathlib import Path
from typing import Final

from linepose.errors import InputError

HEAD: Final = "LINEPOSE_HEAD"
"""Environment variable: what the process that plans hands over to its jobs, as JSON."""

_TOKEN: Final = Path(".snakemake", "linepose-head.txt")
_LEAST_FREE_MB: Final = 200
_MOST_CLOCK_ERROR_S: Final = 10.0


def hand_over(root: Path) -> None:
    """Hand version, time and a token in the project's folder to the jobs of this process.

    Raises InputError where the folder has no room, or where the clock here is not that of its files.
    """
    check_room(root, "here")
    check_clock(root, "here")
    token = secrets.token_hex(8)
    (root / _TOKEN).parent.mkdir(exist_ok=True)
    (root / _TOKEN).write_text(token)
    told = {"version": version("linepose"), "host": socket.gethostname(), "token": token, "time_s": time.time()}
    os.environ[HEAD] = json.dumps(told)


def check_node(root: Path) -> None:
    """Raises InputError where this machine is not fit for the jobs of the process that handed over; else nothing.

    Without a process that handed over there is nothing to compare with.
    """
    if HEAD not in os.environ:
        return
    head, here = json.loads(os.environ[HEAD]), f"node {os.environ.get('SLURMD_NODENAME') or socket.gethostname()}"
    if version("linepose") != head["version"]:
        found, expected = f"linepose {version('linepose')}", f"linepose {head['version']} as on {head['host']}"
        raise InputError(here, found, expected, f"install that version for {sys.executable} there")
    token = root / _TOKEN
    if not token.is_file() or token.read_text() != head["token"]:
        found = f"another folder {root.resolve()} than {head['host']} has"
        raise InputError(here, found, "one folder that all nodes share", "put the project on a shared file system")
    behind_s = head["time_s"] - time.time()
    if behind_s > _MOST_CLOCK_ERROR_S:
        raise _clock_error(here, behind_s, f"the clock of {head['host']}")
    check_clock(root, here)
    check_room(root, here)


def check_room(root: Path, here: str, least_free_mb: int = _LEAST_FREE_MB) -> None:
    """Raises InputError where the project's folder, or that for temporary files, has no room for results."""
    temporary = os.environ.get("TMPDIR", "")  # which not all look at as Python does
    for folder in (root, Path(temporary if Path(temporary).is_dir() else tempfile.gettempdir())):
        free_mb = shutil.disk_usage(folder).free / 1e6
        if free_mb < least_free_mb:
            found, expected = f"{free_mb:.0f} MB free in {folder.resolve()}", f"at least {least_free_mb} MB"
            raise InputError(here, found, expected, "make room there, or set TMPDIR to another folder")


def check_clock(root: Path, here: str) -> None:
    """Raises InputError where the time of a file written now is not this machine's: results would look outdated."""
    (root / _TOKEN).parent.mkdir(exist_ok=True)
    with tempfile.NamedTemporaryFile(dir=(root / _TOKEN).parent) as file:
        file.write(b"now")
        file.flush()
        behind_s = Path(file.name).stat().st_mtime - time.time()
    if abs(behind_s) > _MOST_CLOCK_ERROR_S:
        raise _clock_error(here, behind_s, f"that of the file system of {root.resolve()}")


def _clock_error(here: str, behind_s: float, other: str) -> InputError:
    found = f"a clock {abs(behind_s):.0f} s {'behind' if behind_s > 0 else 'before'} {other}"
    return InputError(here, found, f"at most {_MOST_CLOCK_ERROR_S:.0f} s", "set the clocks by a time server (NTP)")
