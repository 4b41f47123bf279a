"""What comes of reading a spoilt file: refused in one line, read with a result that holds, or a fault of ours."""

import contextlib
import time
import traceback
import warnings
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from linepose.errors import one_line
from unit.bad_input.reader import Reader

LONGEST_S = 10.0
MOST_BYTES = 1_000_000_000
LONGEST_LINE = 2_500
REFUSED, READ, TRACEBACK, HANG, MEMORY, WRONG, UNCLEAR = OUTCOMES = (
    "refused clearly",
    "read",
    "traceback",
    "hang over 10 s",
    "above 1 GB",
    "silently wrong",
    "unclear line",
)
FAULTS = OUTCOMES[2:]


@dataclass(frozen=True)
class Outcome:
    """One of OUTCOMES, what was told or raised, and how long it took."""

    kind: str
    told: str
    seconds: float
    peak_bytes: int


def outcome(reader: Reader, data: bytes) -> Outcome:
    """What comes of it when the reader's spoilt file holds these bytes."""
    with TemporaryDirectory() as folder:
        at = Path(folder)
        for name, whole in reader.files.items():
            (at / name).parent.mkdir(parents=True, exist_ok=True)
            (at / name).write_bytes(data if name == reader.spoilt else whole)
        before = reset_peak()
        begun = time.process_time()
        kind, told = _read(reader, at)
        seconds, peak = time.process_time() - begun, peak_bytes() - before
    if kind in {REFUSED, READ}:
        kind = HANG if seconds > LONGEST_S else MEMORY if peak > MOST_BYTES else kind
    return Outcome(kind, told, seconds, peak)


def _read(reader: Reader, folder: Path) -> tuple[str, str]:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        try:
            value = reader.read(folder)
        except Exception as error:
            told = one_line(error)
            if told is None:
                return TRACEBACK, "".join(traceback.format_exception(error))
            return (REFUSED if _is_clear(told, folder) else UNCLEAR), told
    return (READ if reader.holds(value) else WRONG), ""


def _is_clear(told: str, folder: Path) -> bool:
    """Whether a line can be shown, has an end, and names the file or the key."""
    return told.isprintable() and len(told) < LONGEST_LINE and (str(folder) in told or "config" in told)


def reset_peak() -> int:
    """Resident bytes now, from which the peak counts on, where the system has such a count; else 0."""
    with contextlib.suppress(OSError):
        Path("/proc/self/clear_refs").write_text("5")
    return peak_bytes()


def peak_bytes() -> int:
    """The most resident bytes since `reset_peak`; 0 where the system has no such count."""
    try:
        lines = Path("/proc/self/status").read_text().splitlines()
    except OSError:
        return 0
    return next((int(line.split()[1]) * 1024 for line in lines if line.startswith("VmHWM")), 0)
