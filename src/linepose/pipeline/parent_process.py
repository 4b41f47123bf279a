"""No work without someone to take it: a process ends with the one that started it."""

import os
import threading
import time
from typing import Final

_LOOK_AFTER_PARENT_S: Final = 0.2


def exit_with_parent(parent: int) -> None:
    """From now on, end this process when its parent, a process id, is gone: killed, it cannot tell its children."""
    threading.Thread(target=_watch, args=(parent,), daemon=True).start()


def _watch(parent: int) -> None:
    while os.getppid() == parent:
        time.sleep(_LOOK_AFTER_PARENT_S)
    os._exit(1)
