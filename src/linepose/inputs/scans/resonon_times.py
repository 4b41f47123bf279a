"""Times of the lines of Resonon's airborne systems: NAME.times, and NAME.lcf, which begins with the first line."""

from pathlib import Path
from typing import Final

import numpy as np
from numpy.typing import NDArray

from linepose.errors import InputError
from linepose.inputs import gps_time
from linepose.inputs.location_files import location_rows, location_unix_us
from linepose.inputs.number_files import plain_float
from linepose.inputs.scans.files_beside import first_file, rows_of

_INTERLEAVES: Final = {".bil", ".bip", ".bsq"}
_ENDINGS: Final = (".times", *(f"{ending}.times" for ending in sorted(_INTERLEAVES)))


def resonon_times(scan: Path, scale: gps_time.TimeScale) -> tuple[NDArray[np.int64], Path]:
    """Unix times (us) of a scan's lines, and their file; `scale` is the clock of the location file.

    The first line was taken when the location file begins, whatever the clock of the .times file counts from.
    """
    names = _names(scan)
    path = first_file([f"{name}{ending}" for name in names for ending in _ENDINGS], scan)
    location = first_file([f"{name}.lcf" for name in names], scan)
    seconds = np.array([_number(word, path, row) for row, word in enumerate(rows_of(path), start=1)])
    start_us = int(location_unix_us(location_rows(location)[:1, 0], scale, location)[0])
    gps_time.tell_lost_weeks(start_us, str(location))
    return start_us + gps_time.microseconds(seconds - seconds[:1], "s", str(path)), path


def _names(scan: Path) -> list[str]:
    """What the recorder may have called this scan's cube: `run` of run.hdr, run.bil.hdr and run-radiance.bil.hdr."""
    name = Path(scan.stem).stem if Path(scan.stem).suffix.lower() in _INTERLEAVES else scan.stem
    return [name, name.rsplit("-", 1)[0]] if "-" in name else [name]


def _number(word: str, path: Path, row: int) -> float:
    try:
        return plain_float(word)
    except ValueError:
        raise InputError(f"{path}, row {row}", repr(word[:60]), "a time in seconds", "mend the row") from None
