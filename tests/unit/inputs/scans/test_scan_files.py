import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from linepose.errors import InputError
from linepose.inputs.scans import envi_data
from linepose.inputs.scans.envi_data import spectral_mean
from linepose.inputs.scans.files_beside import first_file
from linepose.inputs.scans.scan_files import Scan, read_scan

START_US = 1_466_000_000_000_000
AXES = {"bil": (0, 2, 1), "bip": (0, 1, 2), "bsq": (2, 0, 1)}
CODES = {"u1": 1, "i2": 2, "i4": 3, "f4": 4, "f8": 5, "u2": 12, "u4": 13}


def write_envi(folder, cube, interleave="bil", dtype="u2", byte_order=0, **changes):
    """An ENVI file by hand: cube (L, P, B), header keys replaced or, when None, left out."""
    order = "<" if byte_order == 0 else ">"
    cube.transpose(AXES.get(interleave, (0, 1, 2))).astype(order + dtype).tofile(folder / "scan.img")
    keys = {
        "samples": cube.shape[1],
        "lines": cube.shape[0],
        "bands": cube.shape[2],
        "header offset": 0,
        "file type": "ENVI Standard",
        "data type": CODES.get(dtype, 6),
        "interleave": interleave,
        "byte order": byte_order,
    } | {key.replace("_", " "): value for key, value in changes.items()}
    header = folder / "scan.hdr"
    header.write_text("ENVI\n" + "".join(f"{k} = {v}\n" for k, v in keys.items() if v is not None))
    write_times(folder, START_US + 7519 * np.arange(cube.shape[0]))
    return header


def write_times(folder, times):
    (folder / "scan-times.csv").write_text("time_us\n" + "".join(f"{t}\n" for t in times))


@pytest.fixture
def cube():
    return np.random.default_rng(3).integers(0, 120, (23, 11, 5))


@pytest.mark.parametrize("interleave", AXES)
@pytest.mark.parametrize("dtype", CODES)
@pytest.mark.parametrize("byte_order", [0, 1])
def test_mean_over_bands_of_every_layout(tmp_path, cube, interleave, dtype, byte_order):
    path = write_envi(tmp_path, cube, interleave, dtype, byte_order)
    np.testing.assert_allclose(spectral_mean(path), cube.mean(axis=2), rtol=1e-6)


@pytest.mark.parametrize("interleave", AXES)
def test_many_chunks_give_the_same_mean(tmp_path, cube, interleave, monkeypatch):
    path = write_envi(tmp_path, cube, interleave)
    monkeypatch.setattr(envi_data, "_CHUNK_BYTES", 3 * cube[0].size * 2)
    np.testing.assert_allclose(spectral_mean(path), cube.mean(axis=2), rtol=1e-6)


_GROWTH = """
import sys
from pathlib import Path
from linepose.inputs.scans.envi_data import spectral_mean
def peak_mb():
    return int(Path("/proc/self/status").read_text().split("VmHWM:")[1].split()[0]) / 1024
before = peak_mb()
spectral_mean(Path(sys.argv[1]))
print(peak_mb() - before)
"""


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="peak memory as Linux tells it")
def test_memory_holds_a_chunk_and_never_the_file(tmp_path):
    n_lines, n_pixels, n_bands = 650, 648, 244
    path = write_envi(tmp_path, np.zeros((1, n_pixels, n_bands)), lines=n_lines)
    with (tmp_path / "scan.img").open("wb") as data:
        data.truncate(2 * n_lines * n_pixels * n_bands)  # 206 MB that take no place on the disk
    command = [sys.executable, "-c", _GROWTH, str(path)]
    grown_mb = float(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    # a chunk of 64 MB, its sums of four bytes a pixel, and what reading the header takes
    assert grown_mb < 100


def test_sum_of_the_brightest_bands_does_not_overflow(tmp_path):
    path = write_envi(tmp_path, np.full((2, 3, 300), 65535))
    np.testing.assert_array_equal(spectral_mean(path), 65535.0)


def test_scan_has_times_and_name(tmp_path, cube):
    scan = read_scan(write_envi(tmp_path, cube))
    assert (scan.name, scan.intensity.shape, scan.intensity.dtype) == ("scan", (23, 11), np.float32)
    np.testing.assert_array_equal(np.diff(scan.time_us), 7519)


def test_time_between_and_beyond_lines():
    scan = Scan(np.zeros((3, 2), dtype=np.float32), np.array([1000, 1010, 1030]), "s")
    np.testing.assert_array_equal(
        scan.time_at(np.array([-0.5, 0.0, 0.5, 1.25, 2.0, 2.5])), [995, 1000, 1005, 1015, 1030, 1040]
    )


@pytest.mark.parametrize("suffix", [".png", ".tif"])
def test_grey_image_of_16_bit(tmp_path, suffix):
    values = np.arange(12, dtype=np.uint16).reshape(4, 3) * 5000
    Image.fromarray(values).save(tmp_path / f"scan{suffix}")
    write_times(tmp_path, START_US + np.arange(4))
    np.testing.assert_array_equal(read_scan(tmp_path / f"scan{suffix}").intensity, values)


def test_channels_of_a_coloured_image_are_averaged(tmp_path):
    values = np.random.default_rng(1).integers(0, 255, (4, 3, 3), dtype=np.uint8)
    Image.fromarray(values).save(tmp_path / "scan.png")
    write_times(tmp_path, START_US + np.arange(4))
    np.testing.assert_allclose(read_scan(tmp_path / "scan.png").intensity, values.mean(axis=2), rtol=1e-6)


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"lines": 24}, r"2530 bytes, truncated, expected 2640 bytes \(24 lines x 11 samples x 5 bands\)"),
        ({"lines": 22}, "2530 bytes, longer than its header says, expected 2420"),
        ({"header_offset": 8}, "2530 bytes, truncated, expected 2538"),
        ({"lines": 10**15}, "lines: found 1000000000000000, expected 0 to 10000000"),
        ({"lines": 9_000_000, "samples": 90_000}, "9000000 lines of 90000 samples, expected at most"),
        ({"samples": -11}, "line 2, samples: found -11, expected 1 to"),
        ({"bands": 0}, "bands: found 0"),
        ({"bands": "many"}, "bands: found 'many', expected a whole number"),
        ({"samples": None}, "samples: found no such key"),
        ({"data_type": 6}, "data type: found 6, expected one of ENVI's types"),
        ({"data_type": "x"}, "data type: found 'x'"),
        ({"interleave": "bix"}, "interleave: found 'bix'"),
        ({"byte_order": 2}, "byte order: found 2"),
        ({"file_type": "ENVI Spectral Library"}, "file type: found 'ENVI Spectral Library'"),
    ],
)
def test_header_that_cannot_be_right(tmp_path, cube, changes, told):
    path = write_envi(tmp_path, cube, **changes)
    with pytest.raises(InputError, match=told):
        read_scan(path)


def test_absurd_size_is_refused_before_memory_is_taken(tmp_path, cube, monkeypatch):
    path = write_envi(tmp_path, cube, lines=9_999_999, samples=50)
    monkeypatch.setattr(envi_data.np, "empty", lambda *_, **__: pytest.fail("memory taken"))
    with pytest.raises(InputError, match="truncated"):
        spectral_mean(path)


def test_missing_data_file(tmp_path, cube):
    path = write_envi(tmp_path, cube)
    (tmp_path / "scan.img").unlink()
    with pytest.raises(InputError, match=r"scan\.hdr: found no data file, expected scan\.img, \.dat, .* beside it"):
        read_scan(path)


def test_header_of_another_kind(tmp_path):
    (tmp_path / "scan.hdr").write_bytes(bytes(range(256)))
    with pytest.raises(InputError, match="no ENVI header"):
        read_scan(tmp_path / "scan.hdr")


def test_intensity_that_is_no_number(tmp_path, cube):
    values = cube.astype(float)
    values[3, 2, 1] = np.nan
    with pytest.raises(InputError, match="no numbers"):
        read_scan(write_envi(tmp_path, values, dtype="f4"))


@pytest.mark.parametrize(
    ("times", "told"),
    [
        (START_US + np.arange(22), "22 time stamps, expected 23, one for each line"),
        (START_US + np.arange(24), "24 time stamps, expected 23"),
        (START_US + np.r_[0:10, 9:22], r"row 12: found time .*, expected a time after the line before it"),
        (START_US + np.r_[0:10, 5:18], "row 12: found time"),
        (np.arange(23) + 1_466_000_000, "they look like seconds"),
        (np.arange(23) + 1_466_000_000, "row 2, column 1: found time 1466000000,"),
        (["soon"] * 23, "row 2: found 'soon', expected one time alone: a whole number"),
    ],
)
def test_times_that_cannot_be_right(tmp_path, cube, times, told):
    path = write_envi(tmp_path, cube)
    write_times(tmp_path, times)
    with pytest.raises(InputError, match=told):
        read_scan(path)


def test_times_that_are_no_text(tmp_path, cube):
    path = write_envi(tmp_path, cube)
    (tmp_path / "scan-times.csv").write_bytes(bytes(range(256)))
    with pytest.raises(InputError, match=r"scan-times\.csv: found bytes that are not text"):
        read_scan(path)


def test_missing_times(tmp_path, cube):
    path = write_envi(tmp_path, cube)
    (tmp_path / "scan-times.csv").unlink()
    with pytest.raises(InputError, match=r"scan-times\.csv: found no such file"):
        read_scan(path)


def test_truncated_png(tmp_path):
    path = tmp_path / "scan.png"
    Image.fromarray(np.random.default_rng(0).integers(0, 255, (90, 80), dtype=np.uint8)).save(path)
    path.write_bytes(path.read_bytes()[:3000])
    with pytest.raises(InputError, match=r"scan\.png"):
        read_scan(path)


def test_image_with_a_palette(tmp_path):
    path = tmp_path / "scan.png"
    Image.fromarray(np.zeros((4, 3), dtype=np.uint8)).convert("P").save(path)
    with pytest.raises(InputError, match="pixel format P, expected grey or RGB"):
        read_scan(path)


@pytest.mark.parametrize("name", ["scan.gif", "scan"])
def test_unknown_kind_of_file(tmp_path, name):
    (tmp_path / name).write_text("x")
    with pytest.raises(InputError, match="file type"):
        read_scan(tmp_path / name)


def test_missing_scan(tmp_path):
    with pytest.raises(InputError, match="no such file"):
        read_scan(tmp_path / "scan.hdr")


def test_data_that_may_not_be_read_are_told(tmp_path, cube, monkeypatch):
    path = write_envi(tmp_path, cube)
    monkeypatch.setattr("os.access", lambda path, mode: False)
    with pytest.raises(InputError, match=r"scan.img: found a file that may not be read, .*; get the right to read it"):
        spectral_mean(path)


def test_a_file_beside_a_scan_that_may_not_be_read_is_told(tmp_path, monkeypatch):
    (tmp_path / "scan.lcf").touch()
    assert first_file(["scan.lcf"], tmp_path / "scan.hdr") == tmp_path / "scan.lcf"
    monkeypatch.setattr("os.access", lambda path, mode: False)
    with pytest.raises(InputError, match=r"scan.lcf: found a file that may not be read"):
        first_file(["scan.lcf"], tmp_path / "scan.hdr")
