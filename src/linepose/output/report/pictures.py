"""Pictures inside a page: PNG files as data addresses, their colours reduced so that many fit into one file."""

import base64
import io
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from PIL import Image, UnidentifiedImageError

from linepose.errors import InputError

_COLOURS: Final = 128
_COMPRESSION: Final = 6  # zlib level: 9 takes six times as long for a tenth less
_README_PICTURES: Final = {
    "ladybird": ("outliers", "corner", "mapping"),
    "ladybird-sim": ("stacked_scan", "detected_points"),
}


@dataclass(frozen=True)
class Picture:
    """A picture's address (data URI) and its size in pixels."""

    address: str
    width: int
    height: int


def embedded(path: Path) -> Picture:
    """A PNG file as a picture that needs no file; raises InputError where it cannot be read."""
    image = reduced(path)
    stream = io.BytesIO()
    image.save(stream, format="PNG", compress_level=_COMPRESSION)
    encoded = base64.b64encode(stream.getvalue()).decode("ascii")
    return Picture(f"data:image/png;base64,{encoded}", image.width, image.height)


def reduced(path: Path) -> Image.Image:
    """A PNG file's image with a palette of its own."""
    try:
        with Image.open(path) as image:
            return image.convert("RGB").quantize(_COLOURS, method=Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE)
    except (OSError, UnidentifiedImageError) as error:
        found = " ".join(str(error).split())
        raise InputError(str(path), found, "a PNG file", "delete the figures' folder and run again") from None


def write_readme_pictures(results: Path, folder: Path) -> None:
    """Write the README's pictures, small, from the figures of several platforms."""
    folder.mkdir(parents=True, exist_ok=True)
    for platform, names in _README_PICTURES.items():
        for name in names:
            reduced(results / platform / "figures" / f"{name}.png").save(folder / f"{name}.png", optimize=True)


if __name__ == "__main__":
    write_readme_pictures(Path("results"), Path("docs/images"))
