import datetime
import re
from functools import reduce

import numpy as np
import pytest

from linepose.errors import InputError
from linepose.inputs.navigation import read_navigation
from linepose.inputs.navigation.nmea import NmeaSection
from linepose.inputs.source import ScansSection
from unit.inputs.drive import ORIGIN

DAY = datetime.date(2024, 5, 1)
MIDNIGHT_US = 1_714_521_600_000_000


def sentence(text):
    return f"${text}*{reduce(lambda total, one: total ^ ord(one), text, 0):02X}\r\n"


def clock(of_day_s):
    of_day_s = round(of_day_s, 2) % 86_400
    return f"{int(of_day_s // 3600):02d}{int(of_day_s // 60 % 60):02d}{of_day_s % 60:05.2f}"


def gga(of_day_s, north=0.0, quality=4):
    """South and east; the ellipsoid is 22.5 m above the geoid here."""
    latitude, longitude = -ORIGIN[0] - north, ORIGIN[1]
    place = f"{int(latitude):02d}{latitude % 1 * 60:09.6f},S,{int(longitude):03d}{longitude % 1 * 60:09.6f},E"
    return sentence(f"GNGGA,{clock(of_day_s)},{place},{quality},12,0.8,20.000,M,22.500,M,01,0000")


def pashr(of_day_s, heading="30.00", accuracies="0.100,0.200,0.300"):
    return sentence(f"PASHR,{clock(of_day_s)},{heading},T,+5.00,-10.00,+0.00,{accuracies},2,1")


def rmc(of_day_s, date="010524"):
    return sentence(f"GNRMC,{clock(of_day_s)},A,3353.352,S,15111.622,E,0.1,40.0,{date},,,A")


def drive(start_s=36_000, n_seconds=3):
    return [
        gga(start_s + second) + "".join(pashr(start_s + second + tenth / 10) for tenth in range(10))
        for second in range(n_seconds)
    ]


def read(tmp_path, text, **keys):
    (tmp_path / "log.nmea").write_bytes(text.encode("latin-1"))
    return read_navigation(NmeaSection(format="nmea", file="log.nmea", **keys), tmp_path)


def test_drive(tmp_path, caplog):
    record = read(tmp_path, "".join(drive()), date=DAY, origin=ORIGIN)
    np.testing.assert_array_equal(record.log.time_us, MIDNIGHT_US + 36_000_000_000 + 100_000 * np.arange(21))
    np.testing.assert_allclose(record.log.position_m, 0, atol=2e-3)  # a millionth of a minute is 1.9 mm
    np.testing.assert_allclose(np.rad2deg(record.log.euler_rad), [[5, -10, 30]] * 21)
    assert record.covariances is None
    assert not caplog.text


def test_covariances_of_gst_and_pashr(tmp_path):
    gst = sentence("GNGST,100000.00,0.1,0.02,0.01,30,0.010,0.020,0.030")
    record = read(tmp_path, gst + "".join(drive()), date=DAY, origin=ORIGIN)
    sigma = np.sqrt(np.diag(record.covariances.covariance[0]))
    np.testing.assert_allclose(sigma, [0.01, 0.02, 0.03, *np.deg2rad([0.1, 0.2, 0.3])], rtol=1e-6)
    assert len(record.covariances.time_us) == 21


def test_position_is_linear_between_fixes(tmp_path):
    text = gga(100) + pashr(100.25) + gga(101, north=1e-4)
    text += pashr(101)
    record = read(tmp_path, text, date=DAY, origin=ORIGIN)
    np.testing.assert_allclose(record.log.position_m[:, 0], np.array([0.25, 1.0]) * 11.09, atol=0.01)


@pytest.mark.parametrize("place", [0, 2])
def test_day_of_rmc_counts_before_the_key(tmp_path, caplog, place):
    """Also where midnight lies between the first sentence and the one that says the day."""
    parts = drive(86_399)
    parts.insert(place, rmc(86_399 if place == 0 else 86_401, "010524" if place == 0 else "020524"))
    record = read(tmp_path, "".join(parts), date=datetime.date(2020, 1, 1))
    np.testing.assert_array_equal(record.log.time_us, MIDNIGHT_US + 86_399_000_000 + 100_000 * np.arange(21))
    assert "begins on 2024-05-01, as RMC or ZDA say, not on 2020-01-01 (source.navigation.date)" in caplog.text


def zda(of_day_s, date="01,05,2024"):
    return sentence(f"GNZDA,{clock(of_day_s)},{date},00,00")


def test_sentences_without_a_day_say_none(tmp_path):
    """As receivers write them before their first fix."""
    before = sentence("GNZDA,,,,,,") + sentence("GNRMC,,V,,,,,,,,,N") + sentence("GNRMC,095900.00,V,,,,,,,060180,,,N")
    record = read(tmp_path, before + rmc(36_000) + "".join(drive()))
    assert record.log.time_us[0] == MIDNIGHT_US + 36_000_000_000


def test_logs_of_two_days_one_behind_the_other(tmp_path):
    """The second begins later in its day than the first, with a GGA before the sentence that says the day."""
    second = drive(40_000)
    second.insert(1, zda(40_000, "02,05,2024"))
    record = read(tmp_path, rmc(36_000) + "".join(drive() + second))
    first_us = MIDNIGHT_US + 36_000_000_000 + 100_000 * np.arange(21)
    np.testing.assert_array_equal(record.log.time_us, [*first_us, *(first_us + 86_400_000_000 + 4_000_000_000)])


def test_a_sentence_that_is_late_at_midnight_is_of_the_day_before(tmp_path):
    parts = drive(86_398)
    parts.insert(2, rmc(86_400, "020524"))
    late = "".join(parts).replace(pashr(86_399.9), "") + pashr(86_399.9)
    record = read(tmp_path, late)
    np.testing.assert_array_equal(record.log.time_us, MIDNIGHT_US + 86_398_000_000 + 100_000 * np.arange(21))


LOST = "150904"  # 1024 weeks before


@pytest.mark.parametrize(
    ("wrong", "count"),
    [({0: rmc}, 1), ({1: rmc}, 1), ({3: rmc}, 1), ({1: lambda s, date: rmc(s, date) + zda(s, "15,09,2004")}, 2)],
)
def test_dates_that_do_not_follow_from_the_others_are_passed_over(tmp_path, caplog, wrong, count):
    """At the begin, in the midst and at the end, of one sentence and of two."""
    parts = [rmc(36_000 + second) + one for second, one in enumerate(drive())]
    for place, sentences in wrong.items():
        parts.insert(place, sentences(36_000 + place, LOST))
    record = read(tmp_path, "".join(parts))
    np.testing.assert_array_equal(record.log.time_us, MIDNIGHT_US + 36_000_000_000 + 100_000 * np.arange(21))
    assert f"log.nmea: the dates of {count} sentences (RMC, ZDA) do not follow from those of the others" in caplog.text
    assert "(2004-09-15); where they are right, set source.navigation.date to their day" in caplog.text


@pytest.mark.parametrize("first", [True, False])
def test_a_second_talker_that_has_lost_its_weeks_does_not_count(tmp_path, caplog, first):
    """Of as many sentences the later day; the key says which where it is one of both."""
    parts = []
    for second, one in enumerate(drive()):
        both = [rmc(36_000 + second), rmc(36_000 + second, LOST)]
        parts += [*both[:: 1 if first else -1], one]
    record = read(tmp_path, "".join(parts))
    np.testing.assert_array_equal(record.log.time_us, MIDNIGHT_US + 36_000_000_000 + 100_000 * np.arange(21))
    assert "the dates of 3 sentences (RMC, ZDA) do not follow" in caplog.text
    assert read(tmp_path, "".join(parts), date=datetime.date(2004, 9, 15)).log.time_us[0] == (
        MIDNIGHT_US + 36_000_000_000 - 1024 * 7 * 86_400_000_000
    )


@pytest.mark.parametrize("later_s", [0, 12])
def test_a_log_of_days_and_talkers_that_agree_says_nothing(tmp_path, caplog, later_s):
    """Over midnight, with a sentence that comes late, and a second log of a week later at nearly the same time."""
    parts = [
        rmc(86_398 + n, "010524" if n < 2 else "020524") + zda(86_398 + n, f"{1 + n // 2:02d},05,2024") + one
        for n, one in enumerate(drive(86_398))
    ]
    parts[2] = parts[2].replace(gga(86_400), rmc(86_399, "010524") + gga(86_400))
    second_s = 86_398 + later_s
    later = "".join([rmc(second_s, "090524" if later_s else "080524"), *drive(second_s)])
    record = read(tmp_path, "".join(parts) + later)
    first_us = MIDNIGHT_US + 86_398_000_000 + 100_000 * np.arange(21)
    np.testing.assert_array_equal(
        record.log.time_us, [*first_us, *(first_us + 7 * 86_400_000_000 + later_s * 1_000_000)]
    )
    assert "follow from" not in caplog.text


def test_dates_without_a_fix_count_after_the_key(tmp_path, caplog):
    """As of a receiver's clock that begins in 1980; told where the key says another day, and alone they count."""
    text = sentence("GNRMC,100000.00,V,,,,,,,060180,,,N") + "".join(drive())
    assert read(tmp_path, text, date=DAY).log.time_us[0] == MIDNIGHT_US + 36_000_000_000
    told = "log.nmea: RMC sentences of a receiver without a fix say 1980-01-06; what counts is 2024-05-01"
    assert told in caplog.text
    text = sentence("GNRMC,100000.00,V,,,,,,,020524,,,N") + "".join(drive())
    assert read(tmp_path, text).log.time_us[0] == MIDNIGHT_US + 86_400_000_000 + 36_000_000_000


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (rmc(36_000), True),
        (zda(36_000), True),
        (sentence("GNRMC,100000.00,V,,,,,,,060180,,,N"), False),
        (sentence("GNRMC,,A,3353.352,S,15111.622,E,0.1,40.0,010524,,,A"), False),
        (rmc(36_000).replace("*", "0*"), False),
    ],
)
def test_what_says_the_day(tmp_path, text, says):
    (tmp_path / "log.nmea").write_text(text)
    section = NmeaSection(format="nmea", file="log.nmea")
    assert section.lacking(tmp_path) == (None if says else "date")


def test_day_of_the_scans_where_nothing_says_it(tmp_path):
    (tmp_path / "a-times.csv").write_text(f"{MIDNIGHT_US + 5}\n{MIDNIGHT_US + 6}\n")
    (tmp_path / "a.png").touch()
    (tmp_path / "log.nmea").write_text("".join(drive()))
    navigation = {"format": "nmea", "file": "log.nmea"}
    source = ScansSection(kind="scans", dataset="x", scans="*.png", navigation=navigation)
    assert read_navigation(source, tmp_path).log.time_us[0] == MIDNIGHT_US + 36_000_000_000


def test_scans_of_no_time_are_told_where_they_say_the_day(tmp_path):
    (tmp_path / "a-times.csv").write_text("999999999999999999\n")
    (tmp_path / "a.png").touch()
    (tmp_path / "log.nmea").write_text("".join(drive()))
    source = ScansSection(kind="scans", dataset="x", scans="*.png", navigation={"format": "nmea", "file": "log.nmea"})
    with pytest.raises(InputError, match=r"a-times.csv, row 1, column 1: found time 999999999999999999"):
        read_navigation(source, tmp_path)


def test_heading_of_hdt_where_pashr_has_none(tmp_path):
    text = "".join(drive()).replace("$PASHR", sentence("GNHDT,77.0,T") + "$PASHR")
    assert np.rad2deg(read(tmp_path, text, date=DAY).log.euler_rad[0, 2]) == pytest.approx(30)
    parts = [gga(100), sentence("GNHDT,77.0,T"), pashr(100, heading=""), gga(101), pashr(101, heading="")]
    assert np.rad2deg(read(tmp_path, "".join(parts), date=DAY).log.euler_rad[0, 2]) == pytest.approx(77)


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        (",S,", ",,"),
        (",E,", ",N,"),
        (
            "33",
            "33.5",
        ),
        ("15111", "1511X"),
        ("3353", "3373"),
    ],
)
def test_gga_of_no_place_are_left_out(tmp_path, caplog, right, wrong):
    """A latitude without its direction is none, not 0."""
    broken = gga(36_001.5).split("*")[0].replace(right, wrong, 1) + "\n"
    assert len(read(tmp_path, "".join([*drive(), broken]), date=DAY).log.time_us) == 21
    assert "log.nmea: 1 GGA whose latitude or longitude is none are left out" in caplog.text


def test_fixes_at_0_0_are_none(tmp_path, caplog):
    """As of receivers that say a fix too early: the frame's origin would lie in the Gulf of Guinea."""
    early = re.sub(r",[\d.]+,S,[\d.]+,E", ",0000.00,N,00000.00,E", gga(35_999).split("*")[0]) + "\n"
    record = read(tmp_path, early + pashr(35_999) + "".join(drive()), date=DAY)
    assert record.origin[0] == pytest.approx(ORIGIN[0])
    assert len(record.log.time_us) == 21
    assert "log.nmea, GGA: 1 of 4 records at latitude 0, longitude 0, as without a fix, are left out" in caplog.text


def test_what_is_left_out_is_counted(tmp_path, caplog):
    parts = [gga(99, quality=0), *drive(), drive()[2]]
    parts.insert(2, "noise\xff\n" + pashr(36_001).replace("30.00", "31.00") + "$GNXYZ,1,2\n$PASHR,,\n")
    record = read(tmp_path, "".join(parts), date=DAY)
    assert len(record.log.time_us) == 21
    assert "log.nmea: 1 GGA without a fix are left out" in caplog.text
    assert "log.nmea, GGA: 1 records that repeat the one before are passed over" in caplog.text
    assert "log.nmea, PASHR: 10 records that repeat" in caplog.text
    assert "log.nmea: 2 lines are no whole NMEA sentence and are passed over" in caplog.text


@pytest.mark.parametrize(
    ("text", "keys", "told"),
    [
        ("a,b\n1,2\n", {"date": DAY}, r"log.nmea: found no NMEA sentence, expected lines that begin with \$"),
        ("".join(drive()), {}, r"found no sentence with a date \(RMC, ZDA\).*; set source.navigation.date"),
        (gga(1) + gga(2), {"date": DAY}, r"log.nmea: found no PASHR with roll, pitch and heading"),
        (
            gga(1) + sentence("PTNL,AVR,100001.00,+149.4688,Yaw,+0.0134,Tilt,,,60.191,3,2.5,6") + gga(2),
            {"date": DAY},
            r"but 1 PTNL,AVR: yaw and one tilt of the line .*; log PASHR too, or read the log of an IMU",
        ),
        (gga(1) + pashr(1), {"date": DAY}, r"log.nmea: found 1 GGA with a fix, expected two or more"),
        (
            gga(1).split("*")[0].replace("22.500", ""),
            {"date": DAY},
            r"0 GGA with a fix and a height above the ellipsoid, expected two or more; let the receiver.*the geoid's",
        ),
        (
            gga(1) + gga(2) + sentence("PASHR,ATT,432000.0,40.0,5.0,2.0,0.0,0.0,0"),
            {"date": DAY},
            r"log.nmea: found no PASHR with roll, pitch and heading",
        ),
        (
            "\0" * 1_000_001,
            {},
            r"log.nmea, line 1: found no line end within 1000000 bytes, expected lines of NMEA sent",
        ),
        (
            "".join(drive()) + "$" * 1_000_001,
            {"date": DAY},
            r"log.nmea, line \d+: found no line end .*; give the log itself, or cut it there",
        ),
        (gga(1) + pashr(2) + gga(3), {"date": DAY}, r"PASHR: found no message between two fixes at most 1.5 s apart"),
    ],
)
def test_broken_log_is_one_line(tmp_path, text, keys, told):
    with pytest.raises(InputError, match=told) as error:
        read(tmp_path, text, **keys)
    assert "\n" not in str(error.value)
