"""From light to digital numbers: spectral response, shot and read noise, saturation and quantisation."""

import numpy as np
from numpy.typing import NDArray

from linepose.arrays import Floats
from linepose.simulation.settings import ImageSettings

FIRST_WAVELENGTH_NM, LAST_WAVELENGTH_NM = 400.0, 1000.0
_PEAK_NM, _WIDTH_NM = 700.0, 250.0


def wavelengths_nm(n_bands: int) -> Floats:
    """Centres of equal bands over the camera's range; (B,)."""
    edges = np.linspace(FIRST_WAVELENGTH_NM, LAST_WAVELENGTH_NM, n_bands + 1)
    return (edges[1:] + edges[:-1]) / 2


def band_responses(n_bands: int) -> Floats:
    """Share of the full scale that each band receives, 1 at the peak; (B,)."""
    return np.exp(-(((wavelengths_nm(n_bands) - _PEAK_NM) / _WIDTH_NM) ** 2))


def expose(rng: np.random.Generator, image: ImageSettings, light: NDArray[np.float32]) -> NDArray[np.uint16]:
    """Digital numbers of light (L, S); (L, B, S). Light 1 in the best band is the full scale.

    Shot noise is the normal approximation of Poisson's, exact to a few per cent above ten electrons.
    """
    electrons = light[:, None, :] * (image.full_scale_electrons * band_responses(image.n_bands))[:, None]
    noise = rng.standard_normal(electrons.shape, dtype=np.float32)
    electrons = electrons + noise * np.sqrt(electrons + image.read_noise_electrons**2)
    full_scale = 2**image.n_bits - 1
    return np.clip(np.rint(electrons * (full_scale / image.full_scale_electrons)), 0, full_scale).astype(np.uint16)
