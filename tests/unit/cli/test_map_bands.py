"""`linepose map --bands` that name no band: told with the bands that the scans have."""

from types import SimpleNamespace

import numpy as np
import pytest
from spectral.io import envi

from linepose.cli.map import _with_bands
from linepose.config.map import MapSection
from linepose.errors import InputError
from linepose.inputs.source import ScansSection


def test_bands_that_are_none_are_told_with_those_of_the_scans(tmp_path):
    envi.save_image(
        str(tmp_path / "observation-01.hdr"), np.ones((3, 4, 7), np.uint16), interleave="bil", ext="bil", force=True
    )
    source = ScansSection(kind="scans", scans="*.hdr", navigation="navigation.csv")
    with pytest.raises(InputError, match=r"--bands: found '0', expected numbers from 1 to 7, .* write --bands 1,4,7"):
        _with_bands(MapSection(), "0", SimpleNamespace(source=source), tmp_path)
