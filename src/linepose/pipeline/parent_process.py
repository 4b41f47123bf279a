"""No work without someone to take it: a process ends with the one that it works for."""

import os
import threading
import time
from typing import Final

SNAKEMAKE: Final = "LINEPOSE_SNAKEMAKE_PROCESS"
"""Environment variable: the process that starts the scripts."""

COMMAND: Final = "LINEPOSE_RUN_PROCESS"
"""Environment variable: the `linepose run` that starts Snakemake."""

_LOOK_S: Final = 0.2


def exit_with_parent(parent: int) -> None:
    """From now on, end this process when its parent, a process id, is gone: killed, it cannot tell its children."""
    threading.Thread(target=_watch, args=(parent, None), daemon=True).start()


def exit_with_process(variable: str) -> None:
    """From now on, end this process with its parent, and with the process that an environment variable names.

    The latter may be several generations away, and may be gone before this process begins to look.
    """
    named = os.environ.get(variable, "")
    threading.Thread(target=_watch, args=(os.getppid(), int(named) if named else None), daemon=True).start()


def _watch(parent: int, further: int | None) -> None:
    while os.getppid() == parent and (further is None or _is_alive(further)):
        time.sleep(_LOOK_S)
    os._exit(1)


def _is_alive(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except PermissionError:
        return True
    return True
