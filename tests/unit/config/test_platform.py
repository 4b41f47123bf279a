import re
from copy import deepcopy
from pathlib import Path

import numpy as np
import pytest
import yaml
from scipy.spatial.transform import Rotation

from linepose.config.platform import Platform, load_platform
from linepose.config.yaml_file import read_yaml
from linepose.errors import InputError
from linepose.paper.hand_measured import hand_measured_sigma

PLATFORMS = Path(__file__).parents[3] / "config" / "platforms"
VALUES = {
    "camera": {"focal_length_m": 8e-3, "pixel_pitch_m": 8e-6, "n_pixels": 640, "principal_point_px": 320.0, "k1": 0.1},
    "hand_measured": {"position_m": [0.1, 0.2, -0.3], "euler_deg": [10.0, 20.0, -90.0]},
    "source": {"kind": "labelled_views", "dataset": "robot"},
}


@pytest.fixture
def folder(tmp_path):
    """A folder of platform files, and a function that writes one."""

    def write(name, values):
        (tmp_path / f"{name}.yaml").write_text(values if isinstance(values, str) else yaml.safe_dump(values))
        return tmp_path

    return write


def message_of(folder, name):
    with pytest.raises(InputError) as error:
        load_platform(folder, name)
    assert "\n" not in str(error.value)
    return str(error.value)


def changed(path, value):
    values = deepcopy(VALUES)
    *sections, key = path.split(".")
    node = values
    for section in sections:
        node = node.setdefault(section, {})
    node[key] = value
    return values


def test_camera_is_the_files_with_the_papers_sigmas(folder):
    camera = load_platform(folder("robot", VALUES), "robot").intrinsics()
    assert (camera.focal_length_m, camera.pixel_pitch_m, camera.n_pixels) == (8e-3, 8e-6, 640)
    assert (camera.principal_point_px, camera.k1, camera.k2) == (320.0, 0.1, 0.0)
    sigmas = camera.sigmas
    assert (sigmas.u_px, sigmas.v_px, sigmas.principal_point_px, sigmas.focal_length_m) == (0.5, 0.5, 2.0, 1e-4)


def test_sigmas_reach_the_camera(folder):
    sigmas = {"u_px": 1.0, "v_px": 2.0, "principal_point_px": 3.0, "focal_length_m": 4.0, "k1": 5.0, "k2": 6.0}
    sigmas |= {"k3": 7.0, "p2": 8.0, "tilt": 9.0, "smile": 10.0}
    camera = load_platform(folder("robot", changed("camera.sigmas", sigmas)), "robot").intrinsics()
    assert vars(camera.sigmas) == sigmas | {"field_of_view_deg": None}


def test_start_pose_is_the_tape_measures(folder):
    platform = load_platform(folder("robot", VALUES), "robot")
    turn = Rotation.from_euler("ZYX", [-90.0, 20.0, 10.0], degrees=True).as_rotvec()
    np.testing.assert_allclose(platform.start_pose(), [0.1, 0.2, -0.3, *turn], rtol=1e-14)


def test_start_covariance_is_0_1_m_and_2_deg_about_each_body_axis(folder):
    """Against the turn, in the body's axes, of rotation vectors a little apart."""
    platform = load_platform(folder("robot", VALUES), "robot")
    covariance, vector = platform.start_covariance(), platform.start_pose()[3:]
    np.testing.assert_allclose(covariance[:3, :3], 0.01 * np.eye(3), rtol=1e-14)
    np.testing.assert_array_equal(covariance[:3, 3:], 0.0)
    step = 1e-6
    turns = [
        (Rotation.from_rotvec(vector + step * unit) * Rotation.from_rotvec(vector - step * unit).inv()).as_rotvec()
        for unit in np.eye(3)
    ]
    jacobian = np.stack(turns, axis=-1) / (2 * step)
    # difference quotients are good to eps / step
    turned = jacobian @ covariance[3:, 3:] @ jacobian.T
    np.testing.assert_allclose(turned, np.deg2rad(2.0) ** 2 * np.eye(3), rtol=0, atol=1e-9)


def test_like_takes_what_the_file_does_not_say(folder):
    folder("robot", changed("description", "the first"))
    folder("second", {"like": "robot", "camera": {"k1": 0.3, "sigmas": {"u_px": 1.5}}})
    third = load_platform(folder("third", {"like": "second", "hand_measured": {"position_m": [1, 2, 3]}}), "third")
    assert third.description == "the first"
    assert (third.camera.k1, third.camera.focal_length_m, third.camera.sigmas.u_px) == (0.3, 8e-3, 1.5)
    assert third.hand_measured.position_m == (1.0, 2.0, 3.0)
    assert third.hand_measured.euler_deg == (10.0, 20.0, -90.0)


def test_circle_of_likes(folder):
    folder("a", {"like": "b"})
    folder("b", {"like": "c"})
    path = folder("c", {"like": "a"})
    assert message_of(path, "a") == (
        f"{path}/a.yaml: like: found a circle a -> b -> c -> a, expected an end; remove one `like`"
    )


def test_platform_like_itself(folder):
    path = folder("a", {"like": "a"})
    assert message_of(path, "a") == f"{path}/a.yaml: like: found a circle a -> a, expected an end; remove one `like`"


def test_missing_file_lists_the_names_there_are(folder):
    folder("robot", VALUES)
    path = folder("rover", VALUES)
    assert message_of(path, "robt") == (
        f"{path}/robt.yaml: found no such platform, expected one of robot, rover; did you mean robot? If not, write it "
        "with `linepose new robt`"
    )


def test_missing_file_among_none(tmp_path):
    assert message_of(tmp_path, "robot") == (
        f"{tmp_path}/robot.yaml: found no such platform, expected one of none; correct the name, or write it with "
        "`linepose new robot`"
    )


def test_missing_like_is_named(folder):
    path = folder("robot", {"like": "rover"})
    assert message_of(path, "robot") == (
        f"{path}/rover.yaml: found no such platform, expected one of robot; correct `like` in robot.yaml"
    )


@pytest.mark.parametrize(
    ("key", "value", "fault"),
    [
        (
            "camera.n_pixel",
            640,
            "found an unknown key, expected one of focal_length_m, field_of_view_deg, view_angles, pixel_pitch_m, "
            "n_pixels, principal_point_px, k1, k2, k3, p2, tilt, smile, sigmas; did you mean n_pixels?",
        ),
        ("camera.focal_length_m", -8e-3, "found -0.008, expected greater than 0; correct the value"),
        ("camera.k1", float("nan"), "found nan, expected a finite number; correct the value"),
        (
            "hand_measured.euler_deg",
            "straight down",
            "found 'straight down', expected a valid tuple; correct the value",
        ),
        ("navigation.maximum_gap_s", 0, "found 0, expected greater than 0; correct the value"),
        (
            "navigation.covariance_columns",
            [3, 4, 4],
            "found [3, 4, 4], expected three different columns; correct the value",
        ),
    ],
)
def test_wrong_value_is_named(folder, key, value, fault):
    path = folder("robot", changed(key, value))
    assert message_of(path, "robot") == f"{path}/robot.yaml: {key}: {fault}"


@pytest.mark.parametrize(
    ("columns", "place", "expected"),
    [
        ([2, 4, 5], 0, "found 2, expected greater than or equal to 3"),
        ([3, 4, 12], 2, "found 12, expected less than or equal to 11"),
        ([3, 4], 2, "found nothing, expected a value"),
    ],
)
def test_attitude_columns_are_three_behind_the_positions(folder, columns, place, expected):
    path = folder("robot", changed("navigation.covariance_columns", columns))
    assert f"navigation.covariance_columns.{place}: {expected}" in message_of(path, "robot")


@pytest.mark.parametrize(
    ("zero", "place", "words"),
    [
        (("focal_length_m",), "camera.sigmas.focal_length_m", ("it", "it is")),
        (
            ("principal_point_px", "focal_length_m"),
            "camera.sigmas.principal_point_px and camera.sigmas.focal_length_m",
            ("them", "they are"),
        ),
    ],
)
def test_sigmas_of_zero_of_what_the_adjustment_estimates_are_told_together(folder, zero, place, words):
    path = folder("robot", changed("camera.sigmas", dict.fromkeys(zero, 0)) | {"noise_model": "adjustment"})
    expected = f"found 0, expected above 0, since the adjustment estimates {words[0]}; give how well {words[1]} known"
    assert message_of(path, "robot") == f"{path}/robot.yaml: {place}: {expected}"
    folder("robot", changed("camera.sigmas", dict.fromkeys(zero, 0)) | {"noise_model": "published"})
    assert load_platform(path, "robot").camera.sigmas.focal_length_m == 0


def test_nan_in_the_hand_measured_pose(folder):
    path = folder("robot", changed("hand_measured.position_m", [0.1, float("nan"), 0.0]))
    assert message_of(path, "robot") == (
        f"{path}/robot.yaml: hand_measured.position_m.1: found nan, expected a finite number; correct the value"
    )


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("", "NoneType, expected keys and values; write `key: value` lines"),
        ("- a\n- b\n", "list, expected keys and values; write `key: value` lines"),
    ],
)
def test_file_without_keys(folder, text, found):
    path = folder("robot", text)
    assert message_of(path, "robot") == f"{path}/robot.yaml: found {found}"


@pytest.mark.parametrize("text", ["camera: [1, 2\n", "a: b: c\n", "\ta: 1\n"])
def test_broken_yaml_is_told_in_one_line(folder, text):
    message = message_of(folder("robot", text), "robot")
    assert "line 1" in message or "line 2" in message
    assert "expected YAML; " in message
    assert "while parsing" not in message


def test_file_in_another_encoding(tmp_path):
    (tmp_path / "robot.yaml").write_bytes("description: Kärcher\n".encode("latin-1"))
    message = message_of(tmp_path, "robot")
    assert message.startswith(f"{tmp_path}/robot.yaml: found ")
    assert message.endswith("expected YAML; correct the file")


def test_units_survive_yaml(tmp_path):
    (tmp_path / "a.yaml").write_text("x: 8.2e-3\nname: Kärcher\n", encoding="utf-8")
    assert read_yaml(tmp_path / "a.yaml") == {"x": 0.0082, "name": "Kärcher"}


def test_ladybird_is_the_papers(ladybird, published):
    table1 = published["table1"]["ladybird"]
    assert list(ladybird.hand_measured.position_m) == table1["position_m"]
    assert list(ladybird.hand_measured.euler_deg) == table1["euler_deg"]
    assert ladybird.camera.focal_length_m == pytest.approx(table1["focal_length_mm"] / 1e3, rel=1e-15)
    assert ladybird.camera.pixel_pitch_m == pytest.approx(4.8e-3 / 648, rel=1e-15)
    assert ladybird.navigation.covariance_columns == (3, 4, 5)
    hand = published["table3"]["ladybird"]["hand_measured"]
    np.testing.assert_allclose(ladybird.start_pose(), hand["pose"], rtol=0, atol=0.0005)
    np.testing.assert_allclose(hand_measured_sigma(ladybird.start_pose()), hand["sigma"], rtol=0, atol=0.0005)


def test_ladybird_attitude_measures_the_same_under_other_columns(ladybird, platforms_folder):
    attitude = load_platform(platforms_folder, "ladybird-attitude")
    assert attitude.navigation.covariance_columns == (6, 7, 8)
    told = {"description", "navigation", "experiments"}
    assert attitude.model_dump(exclude=told) == ladybird.model_dump(exclude=told)
    assert attitude.navigation.maximum_gap_s == ladybird.navigation.maximum_gap_s


def test_platform_survives_the_way_through_a_rules_parameters(ladybird):
    assert Platform.model_validate(ladybird.model_dump(mode="json")) == ladybird


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"seeds": 1}, "simulation.seeds: found an unknown key, .* did you mean seed"),
        ({"image": {"n_bandss": 4}}, "simulation.image.n_bandss: found an unknown key, .* did you mean n_bands"),
        ({"seed": "many"}, "simulation.seed: found 'many'"),
    ],
)
def test_simulation_is_closed_and_told_with_its_file(tmp_path, change, told):
    for name in ("ladybird-sim", "ladybird"):
        (tmp_path / f"{name}.yaml").write_text((PLATFORMS / f"{name}.yaml").read_text())
    (tmp_path / "robot.yaml").write_text(yaml.safe_dump({"like": "ladybird-sim", "simulation": change}))
    with pytest.raises(InputError, match=f"robot.yaml: {told}"):
        load_platform(tmp_path, "robot")


@pytest.mark.parametrize(
    ("like", "source", "told"),
    [
        ("ladybird-sim", {"navigation": "navigation.csv"}, "source.navigation: found 'navigation.csv', expected navig"),
        ("ladybird-sim", {"navigation": {"format": "sbet", "file": "a.out"}}, "source.navigation: found 'a.out'"),
        (
            "ladybird-sim",
            {"scans": "scans/*.png"},
            "source.scans: .*, expected scans/observation-01.hdr, which the sim",
        ),
        ("ladybird-sim", {"labels": "labels.json"}, "source.labels: found 'labels.json', expected labels.csv"),
        ("ladybird-sim", {"covariances": "nav_covs.csv"}, "source.covariances: .*, expected covariances.csv"),
        ("ladybird-sim", {"time_stamps": "hyspex"}, "source.time_stamps: found hyspex, expected csv"),
        ("drone-sim", {"scans": "scans/observation-*.hdr"}, "source.scans: .*, expected scans/strip-01.hdr"),
        ("drone-sim", {"scans": "*-01.hdr"}, "source.scans: .*, expected scans/strip-01.hdr"),
        ("drone-sim", {"points": "labels"}, "source.points: found labels, .*; set source.points: matching"),
    ],
)
def test_a_simulated_platform_reads_what_its_simulation_writes(tmp_path, like, source, told):
    for name in ("ladybird-sim", "drone-sim"):
        (tmp_path / f"{name}.yaml").write_bytes((PLATFORMS / f"{name}.yaml").read_bytes())
    (tmp_path / "robot.yaml").write_text(yaml.safe_dump({"like": like, "source": source}))
    assert re.search(told, message_of(tmp_path, "robot"))
    for pattern in ("scans/**/*.hdr", "./scans/*.hdr"):
        (tmp_path / "robot.yaml").write_text(yaml.safe_dump({"like": like, "source": {"scans": pattern}}))
        assert load_platform(tmp_path, "robot").source.scans == pattern
    unused = {"labels": "mine.csv", "points": "detection"} if like == "ladybird-sim" else {"labels": "mine.csv"}
    (tmp_path / "robot.yaml").write_text(yaml.safe_dump({"like": like, "source": unused}))
    assert load_platform(tmp_path, "robot").source.labels == "mine.csv"


CHARUCO = {"kind": "charuco", "rows": 5, "columns": 7}


@pytest.mark.parametrize(
    ("target", "stands", "told"),
    [
        (CHARUCO, None, "found target.kind charuco with simulation.board.target.kind rings, .*; give both the same"),
        (None, CHARUCO, "found target.kind rings with simulation.board.target.kind charuco"),
        (CHARUCO | {"columns": 8}, CHARUCO, "found target.columns 8 with simulation.board.target.columns 7"),
        (CHARUCO, CHARUCO, None),
        (CHARUCO | {"known": True, "sigma_m": 1e-3}, CHARUCO, None),
        ({"kind": "points"}, CHARUCO, None),
    ],
)
def test_the_target_is_the_board_that_is_simulated(tmp_path, target, stands, told):
    for name in ("ladybird-sim", "ladybird"):
        (tmp_path / f"{name}.yaml").write_bytes((PLATFORMS / f"{name}.yaml").read_bytes())
    given = {"like": "ladybird-sim", "simulation": {"board": {"target": stands}}, "source": {"points": "labels"}}
    given |= {"noise_model": "adjustment"} | ({} if target is None else {"target": target})
    (tmp_path / "robot.yaml").write_text(yaml.safe_dump(given))
    if told is None:
        assert load_platform(tmp_path, "robot").target.kind == target["kind"]
    else:
        assert re.search(told, message_of(tmp_path, "robot"))


def test_the_docs_example_of_a_simulated_board_is_a_platform(tmp_path):
    for name in ("ladybird-sim", "ladybird"):
        (tmp_path / f"{name}.yaml").write_bytes((PLATFORMS / f"{name}.yaml").read_bytes())
    text = (PLATFORMS.parents[1] / "docs" / "scans.md").read_text()
    (tmp_path / "robot.yaml").write_text(re.search(r"```yaml\n(like: ladybird-sim\n.*?)```", text, re.S)[1])
    platform = load_platform(tmp_path, "robot")
    assert (platform.target.kind, platform.simulation.seed, platform.simulation.faults) == ("charuco", 7, ())
