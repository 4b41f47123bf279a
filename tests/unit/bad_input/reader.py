"""A reader of the set: a folder of whole files, the one that is spoilt, and what must hold of whatever is read."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cache, cached_property
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pandas as pd

from unit.inputs.drive import drive_of

TIME_US = 1_440_000_000_000_000 + 100_000 * np.arange(12)
CASES = Path(__file__).parents[1] / "inputs" / "cases"


@dataclass(frozen=True)
class Reader:
    """A reader: what makes its files by name, which of them is spoilt, what reads the folder, and what holds.

    `of` are the registered readers that it stands for, `package` what it needs beside the usual environment.
    """

    name: str
    make: Callable[[], dict[str, bytes]]
    spoilt: str
    read: Callable[[Path], Any]
    holds: Callable[[Any], bool] = field(default=lambda _: True)
    is_text: bool = True
    of: tuple[str, ...] = ()
    package: str | None = None

    @cached_property
    def files(self) -> dict[str, bytes]:
        """The whole files by name."""
        return self.make()

    def whole(self) -> bytes:
        """The file before it is spoilt."""
        return self.files[self.spoilt]


def written(write: Callable[[Path], Any], name: str) -> bytes:
    """The bytes of a file that a writer makes under this name."""
    with TemporaryDirectory() as folder:
        write(Path(folder) / name)
        return (Path(folder) / name).read_bytes()


@cache
def own_table() -> pd.DataFrame:
    """A short drive in our own table."""
    names = ["north_m", "east_m", "down_m", "roll_rad", "pitch_rad", "yaw_rad"]
    values = np.outer(np.arange(len(TIME_US)), [0.5, 0.2, 0.01, 0.002, 0.001, 0.01])
    return pd.DataFrame(values, columns=names).assign(time_us=TIME_US)


@cache
def drive() -> Any:
    """The same drive near Sydney."""
    return drive_of(own_table(), np.diag([1e-4] * 3 + [1e-6] * 3))
