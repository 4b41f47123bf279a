"""The largest image that is read: what a file claims about its size is checked before memory is taken for it."""

from pathlib import Path
from typing import Final

from linepose.errors import InputError

_LARGEST_IMAGE: Final = 500_000_000  # pixels of a scan: 2 GB as float32


def check_image_size(n_lines: int, n_samples: int, path: Path) -> None:
    """Raise InputError where a scan of so many lines and samples is too large to be read."""
    if n_lines * n_samples > _LARGEST_IMAGE:
        found = f"{n_lines} lines of {n_samples} samples"
        remedy = "cut the scan into views of the board, or restore the header"
        raise InputError(str(path), found, f"at most {_LARGEST_IMAGE} pixels", remedy)


def check_width(n_samples: int, n_pixels: int | None, path: Path) -> None:
    """Raise InputError where a scan's width is not the camera's number of pixels; None is any."""
    if n_pixels not in (None, n_samples):
        found, expected = f"{n_samples} pixels a line", f"{n_pixels}, as camera.n_pixels says"
        raise InputError(str(path), found, expected, "correct camera.n_pixels, or restore the scan")
