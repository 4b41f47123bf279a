"""Pictures keep the bits that they have; the values are made up."""

import struct
import zlib

import numpy as np
import pytest
import tifffile
from PIL import Image

from linepose.errors import InputError
from linepose.inputs.scans import pictures
from linepose.inputs.scans.pictures import picture_size, read_picture


@pytest.fixture
def cube():
    return np.random.default_rng(4).integers(0, 4096, (40, 30, 3)).astype(np.uint16)  # 12 of 16 bits


def write_png(path, cube):
    """A 16-bit RGB picture, which Pillow does not write; rows are unfiltered."""

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    lines, pixels, _ = cube.shape
    rows = b"".join(b"\0" + row.astype(">u2").tobytes() for row in cube)
    header = struct.pack(">IIBBBBB", pixels, lines, 16, 2, 0, 0, 0)
    chunks = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunks)


def assert_mean(path, cube):
    np.testing.assert_allclose(read_picture(path), cube.mean(axis=2), rtol=1e-6)
    assert picture_size(path) == cube.shape[:2]


def test_png_of_16_bit_colour_keeps_16_bits(tmp_path, cube):
    write_png(tmp_path / "scan.png", cube * np.uint16(16) + np.uint16(5))
    assert_mean(tmp_path / "scan.png", cube * 16.0 + 5)


@pytest.mark.parametrize(
    "how",
    [
        {},
        {"compression": "zlib"},
        {"compression": "zlib", "predictor": 2},
        {"bigtiff": True},
        {"byteorder": ">"},
        {"rowsperstrip": 7},
        {"tile": (16, 16)},
    ],
)
def test_tiff_of_16_bit_colour_keeps_16_bits(tmp_path, cube, how):
    tifffile.imwrite(tmp_path / "scan.tif", cube, photometric="rgb", **how)
    assert_mean(tmp_path / "scan.tif", cube)


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16, np.int16, np.uint32, np.float32, np.float64])
@pytest.mark.parametrize("n_bands", [2, 7])
@pytest.mark.parametrize("planar", ["contig", "separate"])
def test_tiff_of_any_number_of_bands(tmp_path, dtype, n_bands, planar):
    cube = np.random.default_rng(2).integers(0, 120, (40, 30, n_bands)).astype(dtype)
    stored = cube if planar == "contig" else np.moveaxis(cube, 2, 0)
    extra = ["unspecified"] * (n_bands - 1)
    tifffile.imwrite(
        tmp_path / "scan.tiff", stored, photometric="minisblack", planarconfig=planar, extrasamples=extra, metadata=None
    )
    assert_mean(tmp_path / "scan.tiff", cube)


def test_compression_that_pillow_alone_has(tmp_path, cube):
    grey = cube[:, :, :1]
    Image.fromarray(grey[:, :, 0]).save(tmp_path / "scan.tif", compression="tiff_lzw")
    assert_mean(tmp_path / "scan.tif", grey)


def test_width_is_told_before_pixels_are_decoded(tmp_path, cube, monkeypatch):
    write_png(tmp_path / "scan.png", cube)
    tifffile.imwrite(tmp_path / "scan.tif", cube, photometric="rgb")
    for name in ("_pillow_mean", "_tiff_mean"):
        monkeypatch.setattr(pictures, name, lambda path: pytest.fail("pixels decoded"))
    for name in ("scan.png", "scan.tif"):
        with pytest.raises(InputError, match=r"found 30 pixels a line, expected 640, as camera.n_pixels says"):
            read_picture(tmp_path / name, 640)


def _truncated(path, cube):
    tifffile.imwrite(path, cube, photometric="rgb")
    path.write_bytes(path.read_bytes()[:-100])


def _of_nothing(path, _):
    """A picture that is said to have 0.8 GB of values, and has 16 bytes: tifffile fills them with 0."""
    tifffile.imwrite(path, np.zeros((2, 4), np.uint16), rowsperstrip=2)
    with tifffile.TiffFile(path, mode="r+b") as file:
        tags = file.pages[0].tags
        for name, value in (("ImageWidth", 20_000), ("ImageLength", 20_000), ("RowsPerStrip", 20_000)):
            tags[name].overwrite(value)


@pytest.mark.parametrize(
    ("write", "told"),
    [
        (_truncated, "truncated"),
        (_of_nothing, "truncated"),
        (lambda path, cube: tifffile.imwrite(path, cube[None].repeat(4, 0), photometric="rgb"), "found 4 pictures"),
        (
            lambda path, cube: tifffile.imwrite(
                path, cube.repeat(2, 2)[:, :, :4], photometric="rgb", extrasamples=["unassalpha"]
            ),
            "an alpha channel, expected grey, RGB",
        ),
        (lambda path, cube: path.write_bytes(b"II*\0" + bytes(range(200))), "expected a whole PNG, TIFF or JPEG file"),
        (lambda path, cube: path.touch(), "expected a whole PNG, TIFF or JPEG file"),
        (
            lambda path, cube: tifffile.imwrite(path, np.full((4, 3), np.nan, np.float32)),
            "intensities that are no numbers",
        ),
    ],
)
def test_tiff_that_cannot_be_used_is_one_line(tmp_path, cube, write, told):
    write(tmp_path / "scan.tif", cube)
    with pytest.raises(InputError, match=told) as error:
        read_picture(tmp_path / "scan.tif")
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("name", ["scan.jpg", "scan.JPEG"])
@pytest.mark.parametrize("colour", [False, True])
def test_jpeg_is_read_and_what_it_costs_is_told(tmp_path, caplog, name, colour):
    ramp = np.broadcast_to(np.linspace(0, 255, 64).astype(np.uint8)[:, None], (64, 48))
    picture = np.stack([ramp] * 3, axis=-1) if colour else ramp
    Image.fromarray(picture).save(tmp_path / name, "JPEG", quality=95)
    np.testing.assert_allclose(read_picture(tmp_path / name), ramp, atol=3)
    assert picture_size(tmp_path / name) == (64, 48)
    assert f"{name}: JPEG: quality 95 costs nothing, quality 50 makes dots half as exact" in caplog.text
    with pytest.raises(InputError, match=r"found 48 pixels a line, expected 640"):
        read_picture(tmp_path / name, 640)


def test_8_bits_are_told_and_16_are_not(tmp_path, cube, caplog):
    write_png(tmp_path / "deep.png", cube)
    tifffile.imwrite(tmp_path / "deep.tif", cube, photometric="rgb")
    for name in ("deep.png", "deep.tif"):
        picture_size(tmp_path / name)
    assert not caplog.text
    Image.fromarray(cube.astype(np.uint8)).save(tmp_path / "flat.png")
    tifffile.imwrite(tmp_path / "flat.tif", cube.astype(np.uint8), photometric="rgb")
    for name in ("flat.png", "flat.tif"):
        picture_size(tmp_path / name)
        assert f"{name}: 8 bits a value: dots are as exact where the scene fills the range" in caplog.text


def test_a_tiff_whose_pages_lead_back_to_each_other_ends(tmp_path):
    path = tmp_path / "scan.tif"
    tifffile.imwrite(path, np.zeros((4, 8), dtype=np.uint16))
    content = bytearray(path.read_bytes())
    content += b"\0" * (len(content) % 2)
    (first,) = struct.unpack_from("<I", content, 4)
    (n_tags,) = struct.unpack_from("<H", content, first)
    struct.pack_into("<I", content, first + 2 + 12 * n_tags, len(content))
    content += struct.pack("<HI", 0, len(content))  # a page without tags, which comes next to itself
    path.write_bytes(content)
    for read in (picture_size, read_picture):
        with pytest.raises(InputError, match=r"scan\.tif: found pages that lead back to each other"):
            read(path)
