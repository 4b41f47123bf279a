"""Compiled code on disk that is older than its sources: numba looks at a function's own file, not at what it calls."""

import hashlib
from collections.abc import Iterable
from pathlib import Path
from typing import Final

_STAMP: Final = "compiled_from.txt"


def forget_outdated(folder: Path, others: Iterable[Path] = ()) -> None:
    """Remove what numba has cached of the modules in a folder, unless all of them are as they were then.

    `others` are sources elsewhere whose constants are compiled in; how kernels are compiled counts too. A folder that
    cannot be written has no cache.
    """
    sources = sorted([*folder.glob("*.py"), *Path(__file__).parent.glob("*.py"), *others])
    digest = hashlib.sha256(b"".join(path.read_bytes() for path in sources)).hexdigest()
    cache = folder / "__pycache__"
    stamp = cache / _STAMP
    try:
        if stamp.is_file() and stamp.read_text() == digest:
            return
        cache.mkdir(exist_ok=True)
        for path in cache.glob("*.nb[ic]"):
            path.unlink(missing_ok=True)
        stamp.write_text(digest)
    except OSError:
        return
