"""Text tables in every layout that people have: each of the same poses."""

import datetime

import numpy as np
import pytest

from linepose.errors import InputError
from linepose.inputs.navigation import read_navigation, text_file
from linepose.inputs.navigation.table import TableSection

FIRST_US = 1_700_000_000_250_000  # 2023-11-14 22:13:20.25 UTC
BARE = {
    "heading": False,
    "columns": {"time": "1", "position": ("2", "3", "4"), "attitude": ("5", "6", "7")},
    "time_unit": "s",
    "angle_unit": "degrees",
}
DAY_S = 22 * 3600 + 13 * 60 + 20.25


def read(tmp_path, text, **keys):
    (tmp_path / "log.txt").write_bytes(text if isinstance(text, bytes) else text.encode())
    return read_navigation(TableSection(format="table", file="log.txt", **{**BARE, **keys}), tmp_path).log


def rows(separator=" ", times=("1700000000.25", "1700000000.35"), values="10 20 -5 5 -10 30"):
    return "".join(f"{separator.join([time, *values.split()])}\n" for time in times)


def assert_poses(log):
    np.testing.assert_array_equal(log.time_us, [FIRST_US, FIRST_US + 100_000])
    np.testing.assert_allclose(log.position_m, [[10, 20, -5]] * 2)
    np.testing.assert_allclose(np.rad2deg(log.euler_rad), [[5, -10, 30]] * 2, atol=1e-12)


NAMES = {"heading": True, "columns": {"time": "t", "position": ("n", "e", "d"), "attitude": ("r", "p", "y")}}
HEADING = "t n e d r p y\n"


@pytest.mark.parametrize(
    ("text", "keys"),
    [
        (rows("   "), {"delimiter": " "}),
        (rows(" \t "), {"delimiter": " "}),
        ("  " + rows("  ").replace("\n", "  \r\n  ").rstrip(" "), {"delimiter": " "}),
        (rows("\t"), {"delimiter": "\t"}),
        (rows(";").replace(".", ","), {"delimiter": ";", "decimal": ","}),
        (rows("; "), {"delimiter": ";"}),
        ("a title\nof two lines\n" + rows(","), {"skipped_lines": 2}),
        ("# a title\n" + rows(",") + "# end\n", {"comment": "#"}),
        (rows(",").replace("\n", " # note\n"), {"comment": "#"}),
        ("\n\n" + rows(",") + "\n", {}),
        (HEADING + rows(), {"delimiter": " "} | NAMES),
        ("\ufeff" + HEADING + rows(), {"delimiter": " "} | NAMES),
        (
            "Project: t n\n\n" + HEADING + "(s) (m)\n\n" + rows(),
            {"delimiter": " ", "unit_rows": 1, "heading_words": ("t", "n", "r")} | NAMES,
        ),
        ("%  " + HEADING + rows(), {"delimiter": " ", "comment": "%", "heading_words": ("t", "n")} | NAMES),
        ("t, n, e, d, r, p, y\n" + rows("  "), {"delimiter": " "} | NAMES),
        ("t,n,e,d,r,p,y,\n" + rows(",").replace("\n", ",\n"), NAMES),
        (
            "".join(f"{time}10  20  -5   5-10 30\n" for time in ("1700000000.25", "1700000000.35")),
            {"widths": (13, 4, 4, 2, 4, 3, 3)},
        ),
        (
            "2023-11-14 22:13:20.25 10 20 -5 5 -10 30\n2023/11/14 22:13:20.350 10 20 -5 5 -10 30\n",
            {
                "delimiter": " ",
                "time_scale": "iso",
                "columns": {"time": ("1", "2"), "position": ("3", "4", "5"), "attitude": ("6", "7", "8")},
            },
        ),
        (rows(",", ("2023-11-14 22:13:38.25", "2023-11-14 22:13:38.35")), {"time_scale": "gps_iso"}),
        (rows(";", ("2023-11-14 22:13:20,25", "2023-11-14 22:13:20,35")), {"time_scale": "iso", "delimiter": ";"}),
        (
            rows(",", ("14.11.2023 22:13:20.25", "14.11.2023 22:13:20.35")),
            {"time_scale": "iso", "time_format": "%d.%m.%Y %H:%M:%S.%f"},
        ),
        (rows(",", (f"{DAY_S}", f"{DAY_S + 0.1:.2f}")), {"time_scale": "day", "date": datetime.date(2023, 11, 14)}),
        (
            rows(",", (f"{DAY_S + 18}", f"{DAY_S + 18.1:.2f}")),
            {"time_scale": "gps_day", "date": datetime.date(2023, 11, 14)},
        ),
    ],
)
def test_layout(tmp_path, text, keys):
    assert_poses(read(tmp_path, text, **keys))


def test_midnight_within_a_log(tmp_path):
    log = read(tmp_path, rows(",", ("86399.9", "0.1")), time_scale="day", date=datetime.date(2023, 11, 14))
    np.testing.assert_array_equal(log.time_us, [1_700_006_399_900_000, 1_700_006_400_100_000])


def test_text_of_another_encoding(tmp_path):
    text = "t,n,e,d,r,p,Höhe°\n" + rows(",")
    keys = {"heading": True, "columns": {"time": "t", "position": ("n", "e", "d"), "attitude": ("r", "p", "Höhe°")}}
    assert_poses(read(tmp_path, text.encode("latin-1"), encoding="latin-1", **keys))
    with pytest.raises(InputError, match=r"log.txt: found bytes of another encoding.*set source.navigation.encoding"):
        read(tmp_path, text.encode("latin-1"), **keys)


@pytest.mark.parametrize(
    ("latitude", "longitude"),
    [
        ("-33 53 21.12", "151 11 37.32"),
        ("-33:53:21.12", "151:11:37.32"),
        ("33°53'21.12\"S", "151°11'37.32\"E"),
        ("S33 53.352", "151.1937"),
        ("-33.8892", "-208 48 22.68"),
    ],
)
def test_degrees_minutes_and_seconds(tmp_path, latitude, longitude):
    text = "".join(f"{time};{latitude};{longitude};42.5;5;-10;30\n" for time in ("1700000000.25", "1700000000.35"))
    keys = {"coordinates": "geodetic", "latitude_unit": "dms", "delimiter": ";", "origin": (-33.8892, 151.1937, 42.5)}
    np.testing.assert_allclose(read(tmp_path, text, **keys).position_m, 0, atol=1e-3)


def test_minus_of_zero_degrees(tmp_path):
    text = "".join(f"{time};-0 30 00;-0 15 00;42.5;5;-10;30\n" for time in ("1700000000.25", "1700000000.35"))
    keys = {"coordinates": "geodetic", "latitude_unit": "dms", "delimiter": ";", "origin": (-0.5, -0.25, 42.5)}
    np.testing.assert_allclose(read(tmp_path, text, **keys).position_m, 0, atol=1e-6)


def test_quaternion(tmp_path):
    text = rows(values="10 20 -5 0 0 0.5 0.8660254037844386")
    columns = {"time": "1", "position": ("2", "3", "4"), "attitude": ("5", "6", "7", "8")}
    np.testing.assert_allclose(
        np.rad2deg(read(tmp_path, text, delimiter=" ", columns=columns).euler_rad[0]), [0, 0, 60]
    )
    with pytest.raises(InputError, match=r"row 1, 5 6 7 8: found quaternion 0, 0, 0.5, 2, expected one of length 1"):
        read(tmp_path, text.replace("0.8660254037844386", "2"), delimiter=" ", columns=columns)


@pytest.mark.parametrize(
    ("text", "keys", "told"),
    [
        (
            rows(",") + "1,2,3,4,5,6,7,8\n",
            {},
            r"log.txt, line 3: found 8 cells, expected 7, as in the lines before it; mend",
        ),
        (
            HEADING + rows(values="1 2 3 4 5 6 7"),
            {"delimiter": " "} | NAMES,
            r"line 2: found 8 cells, expected 7, as in the heading",
        ),
        (
            rows(","),
            {"heading_words": ("Latitude",)} | NAMES,
            r"found no heading, expected a line with Latitude; correct source.navigation.heading_words",
        ),
        ("", {}, r"log.txt: found no row of values"),
        (HEADING, NAMES, r"log.txt: found no row of values"),
        (rows(",", ("12 h", "13 h")), {}, r"log.txt, row 1, 1: found '12 h', expected a number"),
        (
            rows(",", ("30", "40")),
            {"time_scale": "day"},
            r"found seconds of the day without the day.*set source.navigation.date",
        ),
        (
            rows(",", ("30", "400000")),
            {"time_scale": "day", "date": "2023-11-14"},
            r"record 2: found 400000.000 s of the day",
        ),
        (
            rows(";", values="x y 42 5 -10 30"),
            {"delimiter": ";", "coordinates": "geodetic", "latitude_unit": "dms"},
            r"row 1, 2: found 'x', expected degrees, minutes, seconds",
        ),
    ],
)
def test_broken_text_is_one_line(tmp_path, text, keys, told):
    with pytest.raises(InputError, match=told) as error:
        read(tmp_path, text, **keys)
    assert "\n" not in str(error.value)


def test_encoding_that_is_none_is_told():
    with pytest.raises(InputError, match=r"encoding: found 'utf-9', expected an encoding that Python knows"):
        TableSection(format="table", file="log.txt", encoding="utf-9")


def test_only_named_columns_are_kept_and_rows_beyond_a_part_are_told(tmp_path, monkeypatch):
    """Files are read in parts: what a row holds beyond the poses never takes memory for the whole file."""
    monkeypatch.setattr(text_file, "_ROWS_AT_ONCE", 2)
    times = [f"{1_700_000_000 + number}.25" for number in range(5)]
    path = tmp_path / "log.txt"
    path.write_text(rows(",", times).replace("\n", ",7,x\n"))
    section = TableSection(format="table", file="log.txt", **BARE)
    table = text_file.read_text(path, section, list("1234567"), [])
    assert list(table.cells.columns) == list("1234567")
    assert list(table.names) == list("123456789")
    assert len(read_navigation(section, tmp_path).log.time_us) == 5
    path.write_text(path.read_text().replace("4.25,10", "4.25,ten"))
    with pytest.raises(InputError, match=r"log.txt, row 5, 2: found 'ten', expected a number"):
        read_navigation(section, tmp_path)
    path.write_text(rows(",", times) + "1,2\n1,2,3,4,5,6,7,8\n")
    with pytest.raises(InputError, match=r"log.txt, line 7: found 8 cells, expected 7"):
        read_navigation(section, tmp_path)
