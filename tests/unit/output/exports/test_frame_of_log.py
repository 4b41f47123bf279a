"""Where the survey lies, as its navigation log says."""

import numpy as np
import pandas as pd
import pytest

from linepose.config.platform import Platform
from linepose.errors import InputError
from linepose.inputs.local_frame import MAP_FRAME
from linepose.output.exports.points import frame_of
from linepose.pipeline.calibration import Calibration
from linepose.pipeline.survey_frame import map_frame_table
from linepose.tables import read_table, write_table
from unit import made_up

SYDNEY = (-33.8902, 151.1937, 40.0)
SCANS = {"kind": "scans", "dataset": "own"}


def own(**keys):
    """A platform with a table in latitude, longitude, height (deg, m)."""
    columns = {"position": ["lat", "lon", "h"], "attitude": ["roll", "pitch", "yaw"]}
    log = {"format": "table", "file": "log.csv", "columns": columns, "coordinates": "geodetic", "angle_unit": "degrees"}
    return Platform.model_validate(made_up.PLATFORM | {"source": SCANS | {"navigation": log | keys}})


@pytest.fixture
def geodetic_log(tmp_path):
    """The folder of a log of eleven seconds, driving east."""
    count = np.arange(11)
    table = pd.DataFrame({"time_us": 1_466_000_000_000_000 + 1_000_000 * count})
    table = table.assign(lat=SYDNEY[0], lon=SYDNEY[1] + 1e-6 * count, h=SYDNEY[2], roll=0.0, pitch=0.0, yaw=90.0)
    table.to_csv(tmp_path / "log.csv", index=False)
    return tmp_path


@pytest.mark.parametrize(
    ("keys", "expected"),
    [
        ({}, ["EPSG:4979", *SYDNEY]),
        ({"origin": [-33.9, 151.2, 0.0]}, ["EPSG:4979", -33.9, 151.2, 0.0]),
        ({"frame": "projected"}, ["EPSG:32756", np.nan, np.nan, np.nan]),
        ({"frame": "projected", "crs": "EPSG:7856"}, ["EPSG:7856", np.nan, np.nan, np.nan]),
    ],
)
def test_frame_is_the_one_that_the_log_was_read_in(geodetic_log, keys, expected):
    write_table(map_frame_table(own(**keys), geodetic_log), geodetic_log / "x.parquet", MAP_FRAME)
    (row,) = read_table(geodetic_log / "x.parquet", MAP_FRAME).to_numpy().tolist()
    assert row[0] == expected[0]
    np.testing.assert_allclose(np.array(row[1:], dtype=float), expected[1:])


def test_results_keep_what_the_log_said_and_the_platform_s_file_comes_first(tmp_path):
    for values, expected in (
        (["EPSG:32633", None, None, None], ("EPSG:32633", None)),
        (["EPSG:4979", *SYDNEY], ("EPSG:32756", SYDNEY)),
    ):
        table = pd.DataFrame([values], columns=MAP_FRAME.names)
        write_table(table, tmp_path / "robot" / "map_frame.parquet", MAP_FRAME)
        frame = frame_of(Calibration.from_results(tmp_path / "robot", made_up.platform()))
        assert (frame.name, frame.origin) == expected
        named = frame_of(
            Calibration.from_results(tmp_path / "robot", made_up.platform(map_frame={"crs": "EPSG:32601"}))
        )
        assert (named.name, named.origin) == ("EPSG:32601", None)


def test_a_log_in_metres_says_nothing(tmp_path):
    write_table(map_frame_table(made_up.platform(), tmp_path), tmp_path / "x.parquet", MAP_FRAME)
    assert len(read_table(tmp_path / "x.parquet", MAP_FRAME)) == 0
    (tmp_path / "robot").mkdir()
    (tmp_path / "x.parquet").rename(tmp_path / "robot" / "map_frame.parquet")
    with pytest.raises(InputError, match="map_frame: found nothing"):
        frame_of(Calibration.from_results(tmp_path / "robot", made_up.platform()))
