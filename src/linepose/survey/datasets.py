"""Public data sets: found in a folder or downloaded, and checked file by file against their sums."""

import hashlib
from collections.abc import Mapping, Sequence
from pathlib import Path

from linepose.errors import InputError


def find_dataset(name: str, files: Sequence[str], folders: Sequence[Path]) -> Path | None:
    """The first folder that has this data set, or None; raises InputError where one has only a part of it.

    A folder without any of the files, which a failed download leaves, is passed over; with no files known, any will do.
    """
    for folder in folders:
        candidate = folder / name
        missing = [file for file in files if not (candidate / file).is_file()]
        if candidate.is_dir() and (not files or len(missing) < len(files)):
            if missing:
                raise InputError(
                    str(candidate / missing[0]),
                    "no such file",
                    f"all {len(files)} files of the data set {name}",
                    f"complete the folder, or remove {candidate} to have it downloaded",
                )
            return candidate
    return None


def check_dataset(folder: Path, sha256: Mapping[str, str | None]) -> dict[str, str]:
    """The sum of each file, by its path in the folder; a sum that is given must be met, None accepts any.

    Raises InputError naming the first file that is missing or differs.
    """
    found = {}
    for file, expected in sha256.items():
        path = folder / file
        if not path.is_file():
            raise InputError(str(path), "no such file", "a file of the data set", "restore it")
        with path.open("rb") as data:
            found[file] = hashlib.file_digest(data, "sha256").hexdigest()
        if expected is not None and found[file] != expected:
            raise InputError(
                str(path),
                f"sha256 {found[file][:12]}... ({path.stat().st_size} bytes)",
                f"sha256 {expected[:12]}...",
                "the file is altered or truncated: restore it from the source",
            )
    return found


def download_dataset(
    name: str, base_url: str, sha256: Mapping[str, str], urls: Mapping[str, str], folder: Path, searched: Sequence[Path]
) -> None:
    """Download a data set into a folder, every file checked; raises InputError where it cannot be had."""
    import pooch
    import requests

    fetcher = pooch.create(path=folder, base_url=base_url, registry=dict(sha256), urls=dict(urls), retry_if_failed=1)
    for file in sha256:
        try:
            fetcher.fetch(file)
        except (requests.RequestException, OSError) as error:
            places = ", ".join(str(place / name) for place in searched)
            raise InputError(
                f"data set {name}",
                f"no copy in {places}, and {fetcher.get_url(file)} cannot be reached ({type(error).__name__})",
                "a copy or a network",
                f"put its files in {searched[0] / name}, or leave its platforms out: snakemake --config offline=true",
            ) from None
        except ValueError as error:
            raise InputError(
                fetcher.get_url(file), " ".join(str(error).split()), "the file with the known sha256", "report this"
            ) from None
