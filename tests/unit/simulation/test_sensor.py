import numpy as np
import pytest

from linepose.simulation import sensor
from linepose.simulation.settings import ImageSettings


@pytest.mark.statistical
def test_noise_is_shot_and_read_noise():
    image = ImageSettings(ifov_rad=1e-3, full_scale_electrons=10_000.0, read_noise_electrons=50.0, n_bands=1)
    light = np.full((400, 500), 0.4, dtype=np.float32)
    counts = sensor.expose(np.random.default_rng(1), image, light).astype(float) / 4095 * 10_000
    electrons = 0.4 * 10_000 * sensor.band_responses(1)[0]
    variance = electrons + 50.0**2 + (10_000 / 4095) ** 2 / 12  # quantisation
    n = light.size
    assert counts.mean() == pytest.approx(electrons, abs=4 * np.sqrt(variance / n))
    assert counts.var() == pytest.approx(variance, rel=4 * np.sqrt(2 / n))


def test_numbers_stay_within_the_bits_and_bands_differ():
    image = ImageSettings(ifov_rad=1e-3, n_bands=5)
    light = np.linspace(0, 3, 300, dtype=np.float32)[None, :]
    counts = sensor.expose(np.random.default_rng(1), image, light)
    assert counts.dtype == np.uint16
    assert counts.shape == (1, 5, 300)
    assert counts.max() == 4095
    assert np.argmax(counts[0, :, 100]) == 2


def test_wavelengths_are_the_middles_of_equal_bands():
    np.testing.assert_allclose(sensor.wavelengths_nm(4), [475, 625, 775, 925])
    assert len(sensor.band_responses(244)) == 244
