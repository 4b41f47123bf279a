"""Elevation models of the map: what is read of them, and what is told of one that is not the survey's."""

from types import SimpleNamespace

import numpy as np
import pytest
import rasterio
from affine import Affine

from linepose.config.map import MapSection
from linepose.errors import InputError
from linepose.output.exports.map_frame import MapFrame
from linepose.output.map.elevation import read_elevation
from linepose.output.map.frame import SurveyMap
from linepose.output.map.ground import ground_of

MAP = SurveyMap(MapFrame("EPSG:32756"))
NORTH_UP = Affine(2.0, 0.0, 100.0, 0.0, -1.0, 200.0)


def written(folder, crs="EPSG:32756", transform=NORTH_UP):
    heights = np.arange(12, dtype=np.float32).reshape(1, 3, 4)
    profile = {"driver": "GTiff", "count": 1, "height": 3, "width": 4, "dtype": "float32"}
    with rasterio.open(folder / "dem.tif", "w", crs=crs, transform=transform, **profile) as file:
        file.write(heights)
    return folder / "dem.tif"


def test_heights_are_raised_by_what_the_platform_says(tmp_path):
    ground = read_elevation(written(tmp_path), MAP, 0.1, 42.5)
    np.testing.assert_array_equal(ground.grid, np.arange(12).reshape(3, 4) + 42.5)
    assert (ground.corner_m, ground.cell_m) == ((199.5, 101.0), (1.0, 2.0))
    section = MapSection(ground="dem", dem="dem.tif", height_offset_m=-3.0)
    assert ground_of(SimpleNamespace(), section, MAP, tmp_path).extremes_m.tolist() == [-3.0, 8.0]
    flat = ground_of(SimpleNamespace(), MapSection(ground="height", height_m=5.0, height_offset_m=30.0), MAP, tmp_path)
    assert flat.offset == 35.0
    with pytest.raises(InputError, match="height_offset_m: found 1, expected none with `ground: points`"):
        MapSection(height_offset_m=1.0)


@pytest.mark.parametrize(
    ("frame", "crs", "transform", "told"),
    [
        (MAP, "EPSG:32633", NORTH_UP, r"found EPSG:32633, expected EPSG:32756.*: gdalwarp -t_srs"),
        (MAP, None, NORTH_UP, "no reference system"),
        (SurveyMap(None), "EPSG:32756", NORTH_UP, "of a survey in local coordinates.*map_frame"),
        (MAP, "EPSG:32756", Affine(2.0, 0.5, 100.0, 0.5, -1.0, 200.0), "rows that do not run from north to south"),
        (SurveyMap(MapFrame("EPSG:32756", (-33.9, 151.2, 20.0))), "EPSG:32756", NORTH_UP, "north, east, down from an"),
    ],
)
def test_a_model_that_is_not_the_surveys_is_told_in_one_line(tmp_path, frame, crs, transform, told):
    with pytest.raises(InputError, match=told):
        read_elevation(written(tmp_path, crs, transform), frame, 0.1)
