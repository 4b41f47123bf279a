"""Headers as instruments and programs write them; the numbers are made up."""

import logging

import numpy as np
import pytest

from linepose.errors import InputError
from linepose.inputs.scans.envi_data import spectral_mean
from linepose.inputs.scans.scan_files import scan_size

KEYS = "samples = 11\nlines = 7\nbands = 5\ndata type = 12\ninterleave = bil\nbyte order = 0\nheader offset = 0\n"

SPECIM = """ENVI
description = {
File Imported into ENVI}
file type = ENVI

sensor type = FX10 , Recorder
acquisition date = DATE(yyyy-mm-dd): 2024-05-01

samples = 11
bands = 5
lines = 7

errors = {none}

interleave = bil
data type = 12
header offset = 0
byte order = 0
default bands = {4, 3, 2}

himg = {1, 11}
fps = 100.00
"""


@pytest.fixture
def cube():
    return np.random.default_rng(14).integers(0, 4000, (7, 11, 5)).astype("<u2")


@pytest.fixture
def write(tmp_path, cube):
    def write(header, values=None, name="scan.raw", after=b""):
        values = cube.transpose(0, 2, 1) if values is None else values
        (tmp_path / name).write_bytes(values.tobytes() + after)
        (tmp_path / "scan.hdr").write_bytes(header if isinstance(header, bytes) else header.encode())
        return tmp_path / "scan.hdr"

    return write


def assert_mean(path, cube):
    np.testing.assert_allclose(spectral_mean(path), cube.mean(axis=2), rtol=1e-6)
    assert scan_size(path) == cube.shape[:2]


@pytest.mark.parametrize(
    "header",
    [
        SPECIM,
        SPECIM.replace("file type = ENVI", "file type = PCI"),
        SPECIM.replace("file type = ENVI\n", ""),
        "ENVI\n" + KEYS.replace("= bil", "= Bil"),
        "ENVI\n" + KEYS.replace("= bil", "= BIL ; by line"),
        "ENVI\n"
        + KEYS.replace("samples =", "Samples=").replace("data type", "  DATA   Type ").replace("lines", "LINES"),
        "envi\r\n" + KEYS.replace("\n", "\r\n"),
        "ENVI\n" + "".join(reversed(KEYS.splitlines(keepends=True))),
        "\n\nENVI\n\n" + KEYS,
        "\ufeffENVI\n" + KEYS,
        ("ENVI\n" + KEYS).encode("utf-16"),
        b"ENVI\nwavelength units = \xb5m\n" + KEYS.encode(),
        "ENVI\n; lines = 9\n" + KEYS,
        "ENVI\nwavelength = {\n 400.0,\n; lines = 9\n lines = 8,\n 500.0\n}\n" + KEYS,
        "ENVI\nwavelength = {400.0, 500.0} ; nm\n" + KEYS,
        "ENVI\n" + KEYS + "lines = 7\n",
        "ENVI\nmajor frame offsets = {0, 0}\n" + KEYS,
        "ENVI\n" + KEYS.replace("= bil", "= Band Interleaved by Line"),
        "ENVI\n" + KEYS.replace("= bil", "= BIL (band interleaved by line)"),
        "ENVI\n" + KEYS.replace("byte order = 0", "byte order = Host (Intel)"),
        "ENVI\n" + KEYS.replace("byte order = 0", "byte order = "),
        "ENVI\n" + KEYS.replace("= 12", "= 12 - unsigned integer"),
        "ENVI\n" + KEYS.replace("= 12", "= uint16"),
        'ENVI\ndata file = "D:\\rec 1\\scan.raw"\n' + KEYS,
    ],
)
def test_headers_of_one_cube_give_its_mean(write, cube, header):
    assert_mean(write(header), cube)


@pytest.mark.parametrize("words", ["1", "Network (IEEE)", "big endian", "Motorola"])
def test_big_endian_in_words(write, cube, words):
    values = cube.transpose(0, 2, 1).astype(">u2")
    assert_mean(write("ENVI\n" + KEYS.replace("byte order = 0", f"byte order = {words}"), values), cube)


@pytest.mark.parametrize(
    ("words", "axes"), [("Band Sequential", (2, 0, 1)), ("bsq ", (2, 0, 1)), ("Band interleaved by pixel", (0, 1, 2))]
)
def test_order_in_words(write, cube, words, axes):
    assert_mean(write("ENVI\n" + KEYS.replace("= bil", f"= {words}"), cube.transpose(axes)), cube)


def test_keys_that_envi_does_without_are_taken_as_it_takes_them(write, cube, caplog):
    header = "ENVI\n; made by a tool\ninterleave = bil\nsamples = 11\nbands = 5\nlines = 7\ndata type = 12\n"
    assert_mean(write(header), cube)
    assert "scan.hdr: no byte order and no header offset: read as 0, as ENVI does" in caplog.text


@pytest.mark.parametrize("interleave", ["interleave = Bil\n", "interleave = BSQ\n", ""])
def test_one_band_is_itself_in_every_order(write, cube, interleave):
    header = "ENVI\nsamples = 11\nlines = 7\nbands = 1\ndata type = 12\nbyte order = 0\n" + interleave
    band = cube[:, :, 2].copy()
    np.testing.assert_array_equal(spectral_mean(write(header, band)), band)


@pytest.mark.parametrize("rest", [b"", b"\1" * 7])
def test_lines_of_a_broken_off_recording_follow_from_the_size(write, cube, caplog, rest):
    assert_mean(write("ENVI\n" + KEYS.replace("lines = 7", "lines = 0"), after=rest), cube)
    assert "7 lines by the size of the data" in caplog.text


def test_part_of_a_line_at_the_end_is_passed_over(write, cube, caplog):
    with caplog.at_level(logging.WARNING):
        assert_mean(write("ENVI\n" + KEYS, after=b"\1" * 109), cube)
    assert "scan.raw: 109 bytes after the last whole line are passed over" in caplog.text


@pytest.mark.parametrize("name", ["scan", "scan.BIL", "scan.Raw", "scan.cube"])
def test_data_files_of_any_ending(write, cube, name):
    assert_mean(write("ENVI\n" + KEYS, name=name), cube)


def test_two_files_that_may_be_the_data_are_told(write, tmp_path):
    path = write("ENVI\n" + KEYS, name="scan.cube")
    (tmp_path / "scan.dark").touch()
    with pytest.raises(InputError, match=r"scan.hdr: found 2 files that may be its data: scan.cube, scan.dark"):
        spectral_mean(path)


def test_which_of_two_data_files_is_read_is_told(write, cube, tmp_path, caplog):
    path = write("ENVI\n" + KEYS)
    (tmp_path / "scan.bil").write_bytes(bytes(cube.nbytes))
    assert_mean(path, cube)
    assert "scan.raw is read, not scan.bil" in caplog.text


@pytest.mark.parametrize(
    ("header", "told"),
    [
        (
            "ENVI\n" + KEYS.replace("= bil", "= five"),
            r"scan.hdr, line 6, interleave: found 'five', expected one of bil",
        ),
        ("ENVI\n" + KEYS.replace("interleave = bil\n", ""), r"scan.hdr: interleave: found no such key"),
        ("ENVI\n" + KEYS.replace("= bil", "= bil or bip"), r"line 6, interleave: found 'bil or bip', expected one"),
        ("ENVI\n" + KEYS.replace("order = 0", "order = native"), r"line 7, byte order: found 'native', expected 0 \("),
        ("ENVI\nfile compression = 1\n" + KEYS, r"line 2, file compression: found 1, expected 0"),
        ("ENVI\nfile type = TIFF\n" + KEYS, r"line 2, file type: found 'TIFF', expected ENVI Standard"),
        ("ENVI\n" + KEYS.replace("11", "eleven"), r"line 2, samples: found 'eleven', expected a whole number"),
        ("ENVI\n" + KEYS.replace("11", "1" * 40), r"line 2, samples: found 1111"),
        ("ENVI\n" + KEYS + "lines = 8\n", r"line 9, lines: found '8', expected one value; line 3 says '7'"),
        ("ENVI\nwavelength = {400,\n" + KEYS, r"line 2, wavelength: found a list without an end, expected }"),
        ("ENVI\nmajor frame offsets = {0, 4}\n" + KEYS, r"line 2, major frame offsets: found '{0, 4}', expected 0, 0"),
        ("NCOLS 11\n" + KEYS, r"scan.hdr, line 1: found no ENVI header, expected the word ENVI"),
        ("", r"scan.hdr, line 1: found no ENVI header"),
        ("ENVI\n" + KEYS.replace("lines = 7", "lines = 8"), r"scan.raw: found 770 bytes, truncated, expected 880"),
        ("ENVI\n" + KEYS.replace("offset = 0", "offset = -1"), r"line 8, header offset: found -1, expected 0 to"),
    ],
)
def test_what_is_refused_says_the_line_and_why(write, header, told):
    with pytest.raises(InputError, match=told) as error:
        spectral_mean(write(header))
    assert "\n" not in str(error.value)


def test_recording_without_a_whole_line_is_told(write):
    header = "ENVI\n" + KEYS.replace("lines = 7", "lines = 0")
    with pytest.raises(InputError, match=r"found 20 bytes, truncated, expected 110 bytes"):
        spectral_mean(write(header, np.zeros(10, "<u2")))
