import logging

import numpy as np
import pandas as pd
import pytest
from PIL import Image

from linepose.errors import InputError
from linepose.inputs.labels.labels import read_labels
from linepose.inputs.observed_points import SCAN_POINTS, detected_points, refined_points, select_scans
from linepose.inputs.targets.detect import Detection, ring_detector
from linepose.inputs.targets.refine import METHODS
from linepose.survey.targets.rings import RingsSection

START_US = 1_466_000_000_000_000
STEP_US = 7519
SHAPE = (200, 150)
CENTROID = METHODS["centroid"]
RINGS = ring_detector(RingsSection(), CENTROID)


@pytest.fixture(scope="module")
def pictures(drawn):
    """Two views of the board, one mirrored, and one without its mark."""
    return {
        "a": drawn([[0, 125], [210, 0]], [75, 100], SHAPE),
        "b": drawn([[0, -125], [210, 0]], [75, 100], SHAPE, seed=1),
        "c": drawn([[0, 125], [210, 0]], [75, 100], SHAPE, with_mark=False, seed=2),
    }


@pytest.fixture
def folder(tmp_path, pictures):
    for name, picture in pictures.items():
        save(tmp_path, name, picture.intensity)
    return tmp_path


def save(folder, name, intensity):
    Image.fromarray(intensity.clip(0).astype(np.uint16)).save(folder / f"{name}.png")
    times = START_US + STEP_US * np.arange(len(intensity))
    (folder / f"{name}-times.csv").write_text("time_us\n" + "".join(f"{t}\n" for t in times))


def labels_of(pictures, off=0.7):
    tables = [
        pd.DataFrame(
            {"observation": n, "point": np.arange(15), "u_px": p.truth[:, 0] + off, "line": p.truth[:, 1] - off}
        )
        for n, p in enumerate(pictures.values(), start=1)
    ]
    return pd.concat(tables, ignore_index=True)


def test_scans_are_numbered_by_name_and_keep_their_numbers(folder):
    scans = select_scans(folder, "*.png", [2])
    assert {number: path.name for number, path in scans.items()} == {1: "a.png", 3: "c.png"}


@pytest.mark.parametrize(
    ("pattern", "left_out", "told"), [("*.tif", [], "found no file"), ("*.png", [4], "observation 4")]
)
def test_scans_that_are_not_there(folder, pattern, left_out, told):
    with pytest.raises(InputError, match=told):
        select_scans(folder, pattern, left_out)


def test_labels_are_refined_and_get_the_time_of_their_line(folder, pictures):
    points = refined_points(select_scans(folder, "*.png", []), labels_of(pictures), CENTROID, SHAPE[1])
    assert list(points.columns) == SCAN_POINTS.names
    truth = np.concatenate([p.truth for p in pictures.values()])
    np.testing.assert_allclose(points[["u_px", "line"]], truth, atol=0.15)
    # a time stamp is rounded to whole microseconds
    np.testing.assert_allclose(points["time_us"] - START_US, points["line"] * STEP_US, atol=0.51)


def test_scan_without_a_label_is_left_out(folder, pictures, caplog):
    labels = labels_of(pictures).query("observation != 2")
    with caplog.at_level(logging.WARNING):
        points = refined_points(select_scans(folder, "*.png", []), labels, CENTROID, SHAPE[1])
    assert points["observation"].unique().tolist() == [1, 3]
    assert "b.png: no label: left out" in caplog.text


@pytest.mark.parametrize(
    ("row", "change", "told"),
    [
        (3, {"u_px": 150.0}, r"a\.png: label of observation 1, point 3: found pixel 150, line .* within the scan"),
        (17, {"line": -2.0}, r"b\.png: label of observation 2, point 2: found pixel .*, line -2"),
        (4, {"u_px": 10.0, "line": 100.0}, r"a\.png: label of observation 1, point 4: found no dot near pixel 10"),
    ],
)
def test_label_that_cannot_be_right(folder, pictures, row, change, told):
    labels = labels_of(pictures)
    labels.loc[row, list(change)] = list(change.values())
    for name in "ab":  # even ground, without any spot
        picture = pictures[name].intensity.copy()
        picture[:, :20] = 900
        save(folder, name, picture)
    with pytest.raises(InputError, match=told):
        refined_points(select_scans(folder, "*.png", []), labels, CENTROID, SHAPE[1])


def test_fewer_than_two_labelled_observations(folder, pictures):
    labels = labels_of(pictures).query("observation == 1")
    with pytest.raises(InputError, match=f"{folder}: found 1 of 3 scans with known points, expected at least 2"):
        refined_points(select_scans(folder, "*.png", []), labels, CENTROID, SHAPE[1])


def test_detection_names_the_scan_it_is_unsure_of(folder, pictures, caplog):
    with caplog.at_level(logging.WARNING):
        points = detected_points(select_scans(folder, "*.png", []), RINGS, SHAPE[1])
    truth = np.concatenate([pictures[name].truth for name in "ab"])
    np.testing.assert_array_equal(points["observation"], np.repeat([1, 2], 15))
    np.testing.assert_array_equal(points["point"], np.tile(np.arange(15), 2))
    np.testing.assert_allclose(points[["u_px", "line"]], truth, atol=0.15)
    assert "observation 3 (c.png) is left out: 15 rings, but the corner mark is not seen" in caplog.text


def test_scan_without_a_board_is_named(folder):
    save(folder, "b", np.random.default_rng(0).uniform(400, 900, SHAPE))
    with pytest.raises(InputError, match=r"b\.png: found no board: .*; add 2 to source\.left_out"):
        detected_points(select_scans(folder, "*.png", []), RINGS, SHAPE[1])


def test_all_scans_without_a_board_are_named_in_one_line(folder):
    for name in "ab":
        save(folder, name, np.random.default_rng(0).uniform(400, 900, SHAPE))
    told = rf"{folder}: found 2 of 3 scans without the board: observation 1, 2; .* check target, or add 1, 2 to source"
    with pytest.raises(InputError, match=told):
        detected_points(select_scans(folder, "*.png", []), RINGS, SHAPE[1])


@pytest.mark.parametrize(("n_without", "told"), [(1, "add 1 to source.left_out"), (2, "turn the axes")])
def test_what_most_scans_share_is_told_before_leaving_them_out(folder, n_without, told):
    nothing = Detection(np.zeros(0, dtype=np.int64), np.zeros(0), np.zeros(0), "no print", False, "turn the axes")
    bare = set("abc"[:n_without])
    with pytest.raises(InputError, match=told):
        detected_points(
            select_scans(folder, "*.png", []), lambda scan: nothing if scan.name in bare else RINGS(scan), SHAPE[1]
        )


def test_fewer_than_two_detected_observations(folder):
    with pytest.raises(InputError, match="1 of 2 scans with known points"):
        detected_points(select_scans(folder, "*.png", [2]), RINGS, SHAPE[1])


def test_scan_of_another_camera(folder):
    with pytest.raises(InputError, match="found 150 pixels a line, expected 648"):
        detected_points(select_scans(folder, "*.png", []), RINGS, 648)


GOOD = "observation,point,u_px,line\n1,0,10,20\n2,14,11.5,21\n"


def test_labels_are_read_in_order(tmp_path):
    (tmp_path / "labels.csv").write_text("line,point,observation,u_px\n21,14,2,11.5\n20,0,1,10\n")
    labels = read_labels(tmp_path / "labels.csv", [1, 2])
    assert labels.to_numpy().tolist() == [[1, 0, 10, 20], [2, 14, 11.5, 21]]


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (GOOD + "3,1,5,5\n", "row 4, observation: found 3, expected the observations with a scan"),
        (GOOD + "2,,5,5\n", "row 4, point: found nan, expected a whole number from 0, or a name"),
        (GOOD + "2,-1,5,5\n", "row 4, point: found '-1'"),
        (GOOD + "2,1.5,5,5\n", "row 4, point: found '1.5'"),
        (GOOD + "2,14,5,5\n", "row 4: found point 14 of observation 2 again"),
        (GOOD + "2,1,left,5\n", "row 4, u_px: found 'left', expected a number"),
        (GOOD + "2,1,,5\n", "row 4, u_px: found .*, expected a number"),
        ("observation,point,u_px\n1,0,10\n", "no column line"),
        ("", "labels.csv: found No columns"),
    ],
)
def test_labels_that_cannot_be_used(tmp_path, text, told):
    (tmp_path / "labels.csv").write_text(text)
    with pytest.raises(InputError, match=told):
        read_labels(tmp_path / "labels.csv", [1, 2])


def test_missing_labels(tmp_path):
    with pytest.raises(InputError, match=r"or set source\.points: detection"):
        read_labels(tmp_path / "labels.csv", [1])
