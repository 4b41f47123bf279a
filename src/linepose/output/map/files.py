"""Files of a map: written together or not at all, never over a link or a device; ENVI headers beside them."""

import errno
import glob
import os
import shutil
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.errors import InputError

_ENVI_TYPES: Final = {"int32": 3, "float32": 4, "float64": 5}


@contextmanager
def written_together(folder: Path, names: Sequence[str]) -> Iterator[dict[str, Path]]:
    """Temporary paths by name, which take their places in this order when the block ends well, and vanish otherwise.

    Raises InputError where a name is taken by a link, a folder or a device, and where the disk is full.
    """
    check_folder(folder)
    for name in names:
        check_target(folder / name)
    folder.mkdir(parents=True, exist_ok=True)
    temporary: dict[str, Path] = {}
    try:
        for name in names:
            handle, path = tempfile.mkstemp(dir=folder, prefix=".", suffix=f"-{name}")
            os.close(handle)
            temporary[name] = Path(path)
        yield temporary
        for name, made in temporary.items():
            made.chmod(0o644)
            check_target(folder / name)
            made.replace(folder / name)
    except OSError as error:
        if error.errno not in (errno.ENOSPC, errno.EDQUOT):
            raise
        found, expected = "a full disk", "room for the map"
        raise InputError(str(folder), found, expected, "free some, or name another folder by --output") from None
    finally:
        for made in temporary.values():
            made.unlink(missing_ok=True)


def check_target(path: Path) -> None:
    """Raise InputError where a path that is to be written is a link, or is there and no plain file."""
    if path.is_symlink() or (path.exists() and not path.is_file()):
        found = "a link" if path.is_symlink() else "a folder or a device"
        raise InputError(str(path), found, "a plain file, or none yet", "remove it, or name another folder by --output")


def check_folder(folder: Path) -> None:
    """Raise InputError where the folder that is to be written into is a link, or no folder."""
    if folder.is_symlink() or (folder.exists() and not folder.is_dir()):
        found = "a link" if folder.is_symlink() else "no folder"
        raise InputError(str(folder), found, "a folder, or none yet", "remove it, or name another folder by --output")


def remove_leftovers(folder: Path, names: Sequence[str]) -> None:
    """Remove what a killed run left of files of these names, and of folders beside them."""
    for name in names:
        for path in folder.glob(f".????????-{glob.escape(name)}*"):
            if path.is_dir() and not path.is_symlink():
                shutil.rmtree(path, ignore_errors=True)
            else:
                path.unlink(missing_ok=True)


def envi_header(shape: tuple[int, int], bands: Sequence[str], dtype: str, about: str) -> str:
    """Text of a header of lines and samples, interleaved by line, little-endian."""
    lines, samples = shape
    rows = [
        "ENVI",
        f"description = {{{about}}}",
        f"samples = {samples}",
        f"lines = {lines}",
        f"bands = {len(bands)}",
        "header offset = 0",
        "file type = ENVI Standard",
        f"data type = {_ENVI_TYPES[dtype]}",
        "interleave = bil",
        "byte order = 0",
        f"band names = {{{', '.join(bands)}}}",
    ]
    return "\n".join(rows) + "\n"


def write_at(handle: int, values: NDArray[np.generic], offset: int) -> None:
    """Write all bytes of an array into an open file from an offset on, whatever other threads write elsewhere."""
    data = np.ascontiguousarray(values).reshape(-1).view(np.uint8).data
    done = 0
    while done < len(data):
        done += os.pwrite(handle, data[done:], offset + done)
