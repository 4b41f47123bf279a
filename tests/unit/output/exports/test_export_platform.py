import pytest

from linepose.errors import InputError
from linepose.pipeline.calibration import Calibration
from linepose.pipeline.exports.options import ExportOptions
from linepose.pipeline.exports.registry import EXPORTS
from unit import made_up


@pytest.mark.parametrize("format", sorted({*EXPORTS.names()} - {"apl", "csm"}))  # which need scans
def test_a_folder_gets_a_file_of_the_format_s_name(made, tmp_path, format):
    path = made.export(format, tmp_path)
    assert path == tmp_path / f"made-up{EXPORTS.member(format).suffix}"
    assert path.stat().st_size > 0
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("format", EXPORTS.names())
def test_before_a_run_the_message_says_what_to_run(tmp_path, format):
    platform = made_up.platform(map_frame={"crs": "EPSG:32756"})
    with pytest.raises(InputError, match=r"run `linepose run robot` first"):
        Calibration.from_results(tmp_path / "results" / "robot", platform).export(format, tmp_path / "out")
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("format", EXPORTS.names())
def test_a_file_that_is_there_stays_when_the_export_fails(made, tmp_path, format):
    target = tmp_path / "out"
    target.write_text("earlier")
    with pytest.raises(InputError, match="stage of made-up: found 'none'"):
        made.export(format, target, stage="none")
    assert target.read_text() == "earlier"
    assert list(tmp_path.iterdir()) == [target]


def test_unknown_format_names_the_nearest(made, tmp_path):
    with pytest.raises(
        InputError, match=r"format: found 'urfd', expected one of apl, camera_info, csm, .*; did you mean urdf\?"
    ):
        made.export("urfd", tmp_path)


def test_points_need_to_know_where_the_survey_lies(made, tmp_path):
    made.platform = made_up.platform()
    with pytest.raises(InputError, match=r"made-up.yaml: map_frame: found nothing.*add `map_frame: \{crs: EPSG"):
        made.export("geojson", tmp_path)


@pytest.mark.parametrize(
    ("crs", "told"),
    [("EPSG:1", "EPSG:1"), ("nonsense", "nonsense"), ("EPSG:4326", "WGS 84"), ("EPSG:2225", "ftUS")],
)
def test_a_system_that_north_and_east_cannot_be_in_is_told(made, tmp_path, crs, told):
    made.platform = made_up.platform(map_frame={"crs": crs})
    with pytest.raises(InputError, match=rf"made-up.yaml: map_frame.crs: found .*{told}.*; (correct it|give the one)"):
        made.export("geopackage", tmp_path)


def test_an_origin_off_the_earth_is_told(made, tmp_path):
    made.platform = made_up.platform(map_frame={"origin": (151.2, -33.9, 40.0)})
    with pytest.raises(InputError, match=r"map_frame.origin: found latitude 151.2.*check the order"):
        made.export("geopackage", tmp_path)


def test_points_need_the_mapping(made, tmp_path):
    made_up.write_results(tmp_path / "results" / "made-up")
    (tmp_path / "results" / "made-up" / "mapping.parquet").unlink()
    made.results = tmp_path / "results"
    with pytest.raises(InputError, match=r"mapping.parquet: found no such result.*run `linepose run made-up`"):
        made.export("geojson", tmp_path)


@pytest.mark.parametrize(
    ("names", "told"),
    [
        (("a b", "c"), "parent frame: found 'a b'"),
        (("base", "/camera"), "child frame"),
        (("base", ""), "child frame"),
        (("x--y", "camera"), "parent frame"),
        (("same", "same"), "not the parent's name"),
    ],
)
def test_frame_names_are_checked(names, told):
    with pytest.raises(InputError, match=told):
        ExportOptions(*names)


def test_axes_are_checked():
    with pytest.raises(InputError, match="found 'enu', expected frd or flu"):
        ExportOptions(body_axes="enu")
