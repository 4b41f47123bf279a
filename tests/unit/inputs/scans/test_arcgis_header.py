"""Images with ArcGIS's headers, and data files that a key of the header names; all are made up."""

import numpy as np
import pytest

from linepose.errors import InputError
from linepose.inputs.scans.scan_files import read_intensity, scan_size
from linepose.inputs.source import ScansSection

LINES, PIXELS, BANDS = 6, 8, 3
AXES = {"bil": (0, 2, 1), "bip": (0, 1, 2), "bsq": (2, 0, 1)}  # of lines, pixels, bands


@pytest.fixture
def cube():
    return np.random.default_rng(1).integers(0, 200, (LINES, PIXELS, BANDS))


def write(folder, cube, layout="BIL", dtype="<u2", more="NBITS 16\nBYTEORDER I\n", ending="bil"):
    path = folder / "scan.hdr"
    path.write_text(f"nrows {LINES}\nNCOLS         {PIXELS}\nNBANDS {BANDS}\nLAYOUT {layout}\n{more}")
    np.transpose(cube, AXES[layout.lower()]).astype(dtype).tofile(folder / f"scan.{ending}")
    return path


@pytest.mark.parametrize("layout", ["BIL", "BIP", "BSQ", "bil"])
@pytest.mark.parametrize(
    ("dtype", "more"),
    [
        ("<u2", "NBITS 16\nBYTEORDER I\nBANDROWBYTES 16\nTOTALROWBYTES 48\nBANDGAPBYTES 0\n"),
        (">u2", "nbits 16\nbyteorder M\n"),
        ("<f4", "NBITS 32\nPIXELTYPE FLOAT\nBYTEORDER LSBFIRST\nULXMAP 1.5\nNODATA -9999\n"),
        ("<i2", "NBITS 16\nPIXELTYPE SIGNEDINT\n"),
        ("u1", ""),
    ],
)
def test_arcgis_header(tmp_path, cube, layout, dtype, more):
    path = write(tmp_path, cube, layout, dtype, more)
    assert scan_size(path) == (LINES, PIXELS)
    np.testing.assert_allclose(read_intensity(path), cube.mean(axis=2), rtol=1e-6)


def test_byte_order_that_is_not_said_is_told(tmp_path, cube, caplog):
    scan_size(write(tmp_path, cube, more="NBITS 16\n"))
    assert "scan.hdr: no BYTEORDER: read as I, little-endian" in caplog.text


@pytest.mark.parametrize(
    ("more", "told"),
    [
        ("NBITS 1\n", r"scan.hdr, line 5, NBITS: found UNSIGNEDINT of 1 bits, expected 8, 16 or 32 bits"),
        (
            "NBITS 16\nBYTEORDER X\n",
            r"scan.hdr, line 6, BYTEORDER: found 'X', expected one of I, LSBFIRST, M",
        ),
        ("NBITS 16\nBANDROWBYTES 20\n", r"line 6, BANDROWBYTES: found 20, expected 16, as of lines without gaps"),
        ("NBITS 16\nSKIPBYTES x\n", r"line 6, SKIPBYTES: found 'X', expected a whole number from 0"),
    ],
)
def test_what_is_not_read_is_one_line(tmp_path, cube, more, told):
    with pytest.raises(InputError, match=told) as error:
        scan_size(write(tmp_path, cube, more=more))
    assert "\n" not in str(error.value)


def test_data_file_that_a_key_of_the_header_names(tmp_path, cube):
    sizes = f"samples = {PIXELS}\nlines = {LINES}\nbands = {BANDS}\ndata type = 12\ninterleave = bil\n"
    header = f"ENVI\n{sizes}byte order = 0\nheader offset = 0\ndata file = C:\\captures\\cube_7.xyz\n"
    write(tmp_path, cube, ending="raw")
    (tmp_path / "scan.raw").rename(tmp_path / "cube_7.xyz")
    (tmp_path / "scan.hdr").write_text(header)
    np.testing.assert_allclose(read_intensity(tmp_path / "scan.hdr"), cube.mean(axis=2), rtol=1e-6)
    source = ScansSection(kind="scans", dataset="x", scans="*.hdr", navigation="n.csv")
    assert tmp_path / "cube_7.xyz" in source.files(tmp_path)
    (tmp_path / "cube_7.xyz").unlink()
    with pytest.raises(InputError, match=r"scan.hdr: found no file cube_7.xyz, which its key `data file` names"):
        scan_size(tmp_path / "scan.hdr")


def test_a_number_on_the_next_row_is_not_the_key_s(tmp_path, cube):
    path = write(tmp_path, cube)
    path.write_text(path.read_text().replace(f"NCOLS         {PIXELS}", f"NCOLS\n        {PIXELS}"))
    with pytest.raises(InputError, match=r"scan\.hdr"):
        scan_size(path)
