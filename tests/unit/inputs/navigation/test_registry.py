"""A format that another package brings: the page's own example, installed as a package would be."""

import importlib
import re
import sys
from pathlib import Path

import numpy as np
import pytest
import yaml

from linepose.config.platform import Platform, load_platform
from linepose.errors import InputError
from linepose.inputs.navigation import read_navigation
from linepose.inputs.navigation.registry import FORMATS
from linepose.settings import Settings, validated

PAGE = (Path(__file__).parents[4] / "docs" / "formats.md").read_text()
VALUES = {
    "camera": {"focal_length_m": 8e-3, "pixel_pitch_m": 8e-6, "n_pixels": 640, "principal_point_px": 320.0},
    "hand_measured": {"position_m": [0.1, 0.2, -0.3], "euler_deg": [10.0, 20.0, -90.0]},
}


def blocks(language):
    return re.findall(rf"```{language}\n(.*?)```", PAGE, flags=re.DOTALL)


@pytest.fixture
def installed(tmp_path, monkeypatch):
    """The page's example as an installed package."""
    (code,) = blocks("python")
    (point,) = re.findall(r"^tum = \"(.*)\"$", "".join(blocks("toml")), flags=re.MULTILINE)
    site = tmp_path / "site"
    (site / "my_package-1.dist-info").mkdir(parents=True)
    (site / "my_package.py").write_text(code)
    (site / "my_package-1.dist-info" / "METADATA").write_text("Metadata-Version: 2.1\nName: my-package\nVersion: 1\n")
    (site / "my_package-1.dist-info" / "entry_points.txt").write_text(
        f"[linepose.navigation_formats]\ntum = {point}\nbad = os:sep\n"
    )
    monkeypatch.syspath_prepend(str(site))
    importlib.invalidate_caches()
    yield code
    sys.modules.pop("my_package", None)


def platform(tmp_path, navigation):
    source = {"kind": "scans", "dataset": "x", "navigation": navigation}
    (tmp_path / "mine.yaml").write_text(yaml.safe_dump(VALUES | {"source": source}))
    return load_platform(tmp_path, "mine")


def test_example_of_the_page_reads_its_format(tmp_path, installed):
    code = [line for line in installed.splitlines() if line and not line.startswith(("import", "from"))]
    assert len(code) <= 15
    (tmp_path / "trajectory.txt").write_text("1700000000.25 1 2 3 0 0 0 1\n1700000000.50 2 2 3 0 0 0 1\n")
    mine = platform(tmp_path, {"format": "tum", "file": "trajectory.txt"})
    again = Platform.model_validate(mine.model_dump(mode="json"))  # as the workflow hands it to a job
    assert again == mine
    record = read_navigation(again.source, tmp_path)
    np.testing.assert_array_equal(record.log.time_us, [1_700_000_000_250_000, 1_700_000_000_500_000])
    np.testing.assert_allclose(record.log.position_m[0], [2.0, 1.0, -3.0])
    np.testing.assert_allclose(record.log.euler_rad[0], [0, 0, np.pi / 2], atol=1e-15)


def test_format_that_is_brought_is_closed_too(tmp_path, installed):
    with pytest.raises(InputError, match=r"source.navigation.fil: found an unknown key.*did you mean file"):
        platform(tmp_path, {"format": "tum", "file": "a.txt", "fil": "b.txt"})


@pytest.mark.parametrize(
    ("navigation", "told"),
    [
        (
            {"format": "novatell", "file": "a"},
            r"source.navigation.format: found 'novatell', expected one of .*did you mean novatel\?",
        ),
        ({"format": "tun", "file": "a"}, r"did you mean tum\?"),
        (
            {"format": "bad", "file": "a"},
            r"entry point bad of linepose.navigation_formats: found '/', expected a Navigation",
        ),
        (
            {"file": "a"},
            r"source.navigation.format: found None, expected one of ardupilot, bad, nmea, novatel, px4, resonon, ",
        ),
        ({"format": "sbet", "file": "a", "weak": 3}, r"mine.yaml: source.navigation.weak: found an unknown key"),
        (
            {"format": "table", "file": "a", "columns": {"tim": "t"}},
            r"source.navigation.columns.tim:.*did you mean time\?",
        ),
        (
            {"format": "table", "file": "a", "angle_unit": "grad"},
            r"source.navigation.angle_unit: found 'grad', expected 'deg",
        ),
        (
            {"format": "table", "file": "a", "columns": {"sigma_position": ["a", "b", "c"]}},
            r"source.navigation: found columns.sigma_position without columns.sigma_attitude, expected both",
        ),
    ],
)
def test_wrong_keys_are_one_line(tmp_path, installed, navigation, told):
    with pytest.raises(InputError, match=told) as error:
        platform(tmp_path, navigation)
    assert "\n" not in str(error.value)


def test_our_own_formats_are_entry_points_as_any_other():
    assert FORMATS.names() == [own.name for own in FORMATS.own()]
    for own in FORMATS.own():
        assert FORMATS.member(own.name) is own
        assert own.section.__module__ == own.read.__module__ == f"linepose.inputs.navigation.{own.name}"
        assert f"### {own.name}:" in PAGE


def test_examples_of_the_page_are_configurations():
    examples = [yaml.safe_load(block)["navigation"] for block in blocks("yaml")]
    assert [one["format"] for one in examples] == [
        "table",
        "novatel",
        "sbet",
        "nmea",
        "rosbag",
        "px4",
        "ardupilot",
        "resonon",
    ]
    for one in examples:
        validated(FORMATS.member(one["format"]).section, one, "docs/formats.md")


def test_path_takes_covariances_from_a_file_and_a_format_from_the_log(tmp_path):
    assert platform(tmp_path, "log.csv").source.covariances == "covariances.csv"
    assert platform(tmp_path, {"format": "novatel", "file": "a"}).source.covariances is None


def test_section_is_frozen():
    assert all(
        issubclass(section, Settings) and section.model_config["frozen"]
        for section in [one.section for one in FORMATS.own()]
    )
