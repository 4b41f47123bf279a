import numpy as np
import pandas as pd
import pytest
import spectral

from linepose.simulation import envi


@pytest.mark.parametrize("n_bands", [1, 4, 244])
def test_scan_reads_back_through_spectral(tmp_path, n_bands):
    cube = np.random.default_rng(2).integers(0, 4096, size=(11, n_bands, 9), dtype=np.uint16)
    lines = envi.write_scan(tmp_path / "scan", iter([cube[:4], cube[4:]]), np.linspace(400, 1000, n_bands))
    image = spectral.open_image(str(tmp_path / "scan.hdr"))
    assert lines == 11
    assert image.shape == (11, 9, n_bands)
    assert image.metadata["interleave"] == "bil"
    assert image.metadata["data type"] == "12"
    assert len(image.metadata["wavelength"]) == n_bands
    np.testing.assert_array_equal(image.open_memmap(interleave="source"), cube)
    assert (tmp_path / "scan.bil").stat().st_size == cube.nbytes


def test_line_times_are_whole_microseconds(tmp_path):
    times = np.array([1466000000000000, 1466000000007519])
    envi.write_line_times(tmp_path / "scan", times)
    np.testing.assert_array_equal(pd.read_csv(tmp_path / "scan-times.csv")["time_us"], times)
