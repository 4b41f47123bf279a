"""A list of the files in a folder of results, so that a folder from which one was lost is made again.

Snakemake sees that a folder is there, not what is in it. The list stands beside the folder and is an output of the
rule that makes both.
"""

from collections.abc import Iterable
from pathlib import Path

from linepose.tables import atomic_write


def write_file_list(folder: Path, path: Path) -> None:
    """Write the paths of all files below a folder, one a line, sorted."""
    write_list([file.relative_to(folder).as_posix() for file in folder.rglob("*") if file.is_file()], path)


def write_list(files: Iterable[str], path: Path) -> None:
    """Write paths, below the folder that they are in, one a line, sorted."""
    with atomic_write(path) as temporary:
        temporary.write_text("".join(f"{file}\n" for file in sorted(files)), encoding="utf-8")


def lost_files(folder: Path, path: Path) -> list[str]:
    """The files that a list names and that its folder lacks; none where there is no list."""
    if not path.is_file():
        return []
    return [file for file in path.read_text(encoding="utf-8").splitlines() if not (folder / file).is_file()]
