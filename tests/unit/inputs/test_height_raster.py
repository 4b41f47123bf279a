"""Heights of a raster: what is read, and what is told of a file that is none."""

import numpy as np
import pytest
import rasterio
from rasterio.transform import from_origin

from linepose.errors import InputError
from linepose.inputs.height_raster import read_heights


def write(path, bands, nodata=None, size=(2.0, 1.0), crs="EPSG:32756"):
    profile = {"driver": "GTiff", "count": len(bands), "height": bands[0].shape[0], "width": bands[0].shape[1]}
    transform = from_origin(100.0, 200.0, *size)
    with rasterio.open(path, "w", dtype="float32", crs=crs, transform=transform, nodata=nodata, **profile) as to:
        to.write(np.array(bands, dtype=np.float32))
    return path


def test_cells_without_a_height_are_no_numbers(tmp_path):
    heights = np.arange(12.0).reshape(3, 4)
    heights[0, 1], heights[2, 3] = -9999.0, np.inf
    read = read_heights(write(tmp_path / "dem.tif", [heights], nodata=-9999.0), "map.dem")
    expected = np.where(np.isin(heights, [-9999.0, np.inf]), np.nan, heights)
    np.testing.assert_array_equal(read.height_m, expected)
    assert read.transform * (0, 0) == (100.0, 200.0)
    assert read.crs.to_epsg() == 32756


def two_bands(path):
    write(path, [np.ones((3, 3)), np.ones((3, 3))])


def nothing(path):
    write(path, [np.full((3, 3), np.nan)])


def one_row(path):
    write(path, [np.ones((1, 3))])


def dust(path):
    write(path, [np.ones((3, 3))], size=(8e-317, 1.0))


def no_text(path):
    """The name of its system in bytes that are none."""
    write(path, [np.ones((3, 3))], crs="+proj=tmerc +lat_0=1 +lon_0=151 +datum=WGS84 +units=m")
    path.write_bytes(path.read_bytes().replace(b"unknown", b"unkn\xffwn"))


@pytest.mark.parametrize(
    ("make", "told"),
    [
        (lambda path: None, "no such file, .* put it there, or correct map.dem"),
        (lambda path: path.write_text("heights"), "a raster of heights"),
        (two_bands, "found 2 bands of 3 x 3 cells"),
        (one_row, "found 1 bands of 3 x 1 cells"),
        (nothing, "no height in any cell"),
        (dust, "cells without a size"),
        (no_text, "expected a raster of heights, as a GeoTIFF"),
    ],
)
@pytest.mark.filterwarnings("ignore")
def test_what_is_no_height_model_is_told_in_one_line(tmp_path, make, told):
    make(tmp_path / "dem.tif")
    with pytest.raises(InputError, match=rf"dem\.tif: .*{told}"):
        read_heights(tmp_path / "dem.tif", "map.dem")


def test_cells_without_a_size_are_told_in_one_line(tmp_path):
    path = tmp_path / "dem.asc"
    path.write_text("ncols 3\nnrows 3\nxllcorner 151\nyllcorner -33\ncellsize 0\n1 2 3\n4 5 6\n7 8 9\n")
    with pytest.raises(InputError, match=r"dem\.asc: found cells without a size"):
        read_heights(path, "points.ground.dem")
