"""Layout of a scan's data file, whichever kind of header describes it."""

from dataclasses import dataclass
from typing import Final, Literal

Interleave = Literal["bil", "bip", "bsq"]

LARGEST: Final = {"lines": 10_000_000, "samples": 100_000, "bands": 10_000}


@dataclass(frozen=True)
class EnviHeader:
    """Layout of an ENVI data file; `lines` is 0 where the recording was broken off and the data's size says it.

    `data_type` is ENVI's code, `byte_order` 0 (little-endian) or 1, `offset` in bytes; `data_file` is the name of the
    data file where the header says it.
    """

    lines: int
    samples: int
    bands: int
    data_type: int
    interleave: Interleave
    byte_order: int
    offset: int
    data_file: str | None = None
