"""Positions of one log and attitudes of another, as of RTKLIB and an AHRS; both are made up."""

import numpy as np
import pytest
import yaml

from linepose.config.new_platform import NewPlatform, platform_text
from linepose.errors import InputError
from linepose.inputs.navigation import read_navigation
from linepose.inputs.navigation.registry import recognised
from linepose.inputs.navigation.table import TableSection
from linepose.inputs.source import ScansSection
from linepose.settings import validated

FIRST_US = 1_700_000_000_000_000  # 2023-11-14 22:13:20 UTC, 22:13:38 GPS time
ORIGIN = (-33.8892, 151.1937, 42.5)
HEAD = "% program   : RTKPOST\n%  GPST  latitude(deg) longitude(deg)  height(m)   Q  ns   sdn(m)   sde(m)   sdu(m)\n"
AHRS = {
    "file": "ahrs.csv",
    "time_unit": "s",
    "angle_unit": "degrees",
    "columns": {"time": "t", "attitude": ["r", "p", "y"]},
}
SIGMAS = AHRS | {"columns": AHRS["columns"] | {"sigma_attitude": ["sr", "sp", "sy"]}}


def write(folder, attitudes=(0.0, 0.25, 0.5, 1.0, 2.0, 2.02), step_m=1.0):
    """Fixes at 0, 1 and 2 s, each a metre north of the last."""
    north_deg = step_m / 110_920.0
    rows = [
        f"2023/11/14 22:13:{38 + s:.3f} {ORIGIN[0] + s * north_deg:.12f} {ORIGIN[1]} {ORIGIN[2]} 1 9 0.01 0.02 0.03"
        for s in range(3)
    ]
    (folder / "run.pos").write_text(HEAD + "\n".join(rows) + "\n")
    lines = [f"{FIRST_US / 1e6 + at:.3f},5,-10,{30 + at},0.1,0.2,0.3\n" for at in attitudes]
    (folder / "ahrs.csv").write_text("t,r,p,y,sr,sp,sy\n" + "".join(lines))


def section(attitude_log=AHRS, **keys):
    values = {"format": "table", "file": "run.pos", "preset": "rtklib", "origin": ORIGIN, "attitude_log": attitude_log}
    return validated(TableSection, values | keys, "source.navigation")


def test_positions_are_linear_between_fixes(tmp_path, caplog):
    write(tmp_path)
    log = read_navigation(section(), tmp_path).log
    at = np.array([0.0, 0.25, 0.5, 1.0, 2.0, 2.02])
    np.testing.assert_array_equal(log.time_us, FIRST_US + np.rint(at * 1e6))
    np.testing.assert_allclose(log.position_m[:, 0], at, atol=1e-3)
    np.testing.assert_allclose(np.rad2deg(log.euler_rad), np.stack([0 * at + 5, 0 * at - 10, 30 + at], 1), atol=1e-4)
    assert not caplog.text
    assert section().files(tmp_path) == {tmp_path / "run.pos", tmp_path / "ahrs.csv"}


def test_sigmas_of_both_logs(tmp_path):
    write(tmp_path)
    keys = {"columns": {"sigma_position": ["8", "9", "10"]}}
    record = read_navigation(section(SIGMAS, **keys), tmp_path)
    sigma = np.sqrt(np.diagonal(record.covariances.covariance, axis1=1, axis2=2))
    np.testing.assert_allclose(sigma, [[0.01, 0.02, 0.03, *np.deg2rad([0.1, 0.2, 0.3])]] * 3, rtol=1e-5)
    assert read_navigation(section(), tmp_path).covariances is None
    with pytest.raises(InputError, match=r"columns.sigma_position without attitude_log.columns.sigma_attitude"):
        section(**keys)


def test_what_is_left_out_is_counted(tmp_path, caplog):
    write(tmp_path, (0.0, 0.5, 0.5, 0.2, 5.0))
    with (tmp_path / "ahrs.csv").open("a") as file:
        file.write(f"{FIRST_US / 1e6 + 1.5},,1,2,0.1,0.2,0.3\n")
    log = read_navigation(section(), tmp_path).log
    np.testing.assert_array_equal(log.time_us - FIRST_US, [0, 200_000, 500_000])
    assert "ahrs.csv: 1 of 6 rows have no time or attitude and are left out" in caplog.text
    assert "1 records that repeat the one before are passed over; 1 records behind later ones are sorted" in caplog.text


def test_week_of_the_scans_serves_a_log_that_has_none(tmp_path):
    write(tmp_path)
    text = (tmp_path / "ahrs.csv").read_text()
    for at in (0.0, 0.25, 0.5, 1.0, 2.0, 2.02):
        text = text.replace(f"{FIRST_US / 1e6 + at:.3f},", f"{252_818 + at:.3f},")
    (tmp_path / "ahrs.csv").write_text(text)
    (tmp_path / "a-times.csv").write_text(f"{FIRST_US}\n{FIRST_US + 5}\n")
    (tmp_path / "a.png").touch()
    navigation = section(AHRS | {"time_scale": "gps_week"})
    source = ScansSection(kind="scans", dataset="x", scans="*.png", navigation=navigation)
    assert read_navigation(source, tmp_path).log.time_us[0] == FIRST_US


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"file": "no.csv"}, r"no.csv: found no such file, .*; restore it, or correct source.navigation.attitude_log"),
        (
            {"columns": {"time": "x", "attitude": ["r", "p", "y"]}},
            r"among them x; correct source.navigation.attitude_l",
        ),
        ({"time_scale": "gps"}, r"ahrs.csv: found no message between two fixes at most 1.5 s apart"),
    ],
)
def test_second_log_that_does_not_fit_is_one_line(tmp_path, change, told):
    write(tmp_path)
    with pytest.raises(InputError, match=told) as error:
        read_navigation(section(AHRS | change), tmp_path)
    assert "\n" not in str(error.value)


def test_new_platform_names_the_second_log(tmp_path):
    write(tmp_path)
    name, keys = recognised(tmp_path / "run.pos")
    hand = (0.2, 0.0, -0.8), (0.0, 0.0, -90.0)
    new = NewPlatform(
        "mine",
        8e-3,
        8e-6,
        640,
        *hand,
        source="scans",
        navigation_format=name,
        navigation="run.pos",
        navigation_keys=keys,
    )
    written = yaml.safe_load(platform_text(new))["source"]["navigation"]
    assert written["preset"] == "rtklib"
    assert written["attitude_log"]["file"] == "attitude.csv"
