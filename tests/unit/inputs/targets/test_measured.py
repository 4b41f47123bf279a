import numpy as np
import pandas as pd
import pytest
from PIL import Image

from linepose.inputs.observed_points import SCAN_POINTS
from linepose.inputs.targets.detect import Detection, ring_detector
from linepose.inputs.targets.measured import (
    DETECTED,
    DETECTION,
    EXTRACTION_ACCURACY,
    DetectedBoard,
    measure_extraction,
    nearest,
)
from linepose.inputs.targets.refine import METHODS
from linepose.survey.targets.apriltags import ApriltagsSection
from linepose.survey.targets.rings import RingsSection
from linepose.tables import write_table

SHAPE = (200, 150)
RINGS = DetectedBoard(RingsSection(), ring_detector(RingsSection(), METHODS["centroid"]), "centroid")


@pytest.fixture
def survey(tmp_path, drawn):
    """Three scans: whole, with points 3 and 9 covered, and one whose truth has 0 and 1 the other way round."""
    covered = [(), (3, 9), ()]
    scans, truths = {}, []
    for number, points in enumerate(covered, start=1):
        picture = drawn([[0, 125], [210, 0]], [75, 100], SHAPE, covered=points, seed=number)
        scans[number] = tmp_path / f"{number}.png"
        Image.fromarray(picture.intensity.clip(0).astype(np.uint16)).save(scans[number])
        times = 1_466_000_000_000_000 + 7519 * np.arange(SHAPE[0])
        (tmp_path / f"{number}-times.csv").write_text("".join(f"{time}\n" for time in times))
        truths.append(
            pd.DataFrame(
                {
                    "observation": number,
                    "point": np.arange(15),
                    "visible": ~np.isin(np.arange(15), points),
                    "u_px": picture.truth[:, 0],
                    "line": picture.truth[:, 1],
                    "v_px_per_line": 0.5,
                    "range_m": 3.0 + number,
                }
            )
        )
    truths[2]["point"] = [1, 0, *range(2, 15)]
    return scans, pd.concat(truths, ignore_index=True)


def labels_of(truth, off):
    visible = truth[truth["visible"]]
    return visible[["observation", "point"]].assign(u_px=visible["u_px"] + off, line=visible["line"] - off)


def test_detection_is_counted_against_what_is_visible(survey, tmp_path):
    scans, truth = survey
    measured = measure_extraction(scans, labels_of(truth, 0.8), truth, RINGS, SHAPE[1])
    counts = measured.detection[["observation", "n_visible", "n_found", "n_wrong"]].to_numpy().tolist()
    assert counts == [[1, 15, 15, 0], [2, 13, 13, 0], [3, 15, 15, 2]]
    assert measured.detection["range_m"].tolist() == [4.0, 5.0, 6.0]
    assert len(measured.points) == 43
    for table, schema in (
        (measured.accuracy, EXTRACTION_ACCURACY),
        (measured.detection, DETECTION),
        (measured.points, SCAN_POINTS),
    ):
        write_table(table, tmp_path / "table.parquet", schema)


def test_each_method_is_measured_whatever_ids_the_labels_carry(survey):
    scans, truth = survey
    labels = labels_of(truth, 0.8)
    labels["point"] = labels["point"].to_numpy()[::-1]
    accuracy = measure_extraction(scans, labels, truth, RINGS, SHAPE[1]).accuracy.set_index(["observation", "method"])
    assert accuracy["chosen"].to_dict() == {(n, m): m == "centroid" for n in (1, 2, 3) for m in ("peak", "centroid")}
    assert accuracy["n_points"].tolist() == [15, 15, 13, 13, 15, 15]
    assert np.all(accuracy["n_missing"] == 0)
    assert accuracy.loc[accuracy["chosen"], ["sigma_u_px", "sigma_v_px"]].to_numpy().max() < 0.1
    assert np.all(accuracy.xs("peak", level=1)["sigma_u_px"] > accuracy.xs("centroid", level=1)["sigma_u_px"])


def test_doubtful_scan_finds_nothing_and_says_why(survey, drawn):
    scans, truth = survey
    unmarked = drawn([[0, 125], [210, 0]], [75, 100], SHAPE, with_mark=False)
    Image.fromarray(unmarked.intensity.clip(0).astype(np.uint16)).save(scans[1])
    detection = measure_extraction(scans, labels_of(truth, 0.5), truth, RINGS, SHAPE[1]).detection
    assert detection["n_found"].tolist() == [0, 13, 15]
    assert "corner mark is not seen" in detection["doubt"][0]


def test_corners_are_measured_as_they_are_found(survey, tmp_path):
    """No method of dots is tried on them; a scan with fewer than two points has no bias."""
    scans, truth = survey
    tags = ApriltagsSection(rows=2, columns=2, first_tag=5)
    truth = truth.query("point < 15").sort_values(["observation", "point"], ignore_index=True)

    def detector(scan):
        mine = truth[truth["observation"] == int(scan.name.split(".")[0])]
        seen = mine[mine["visible"]][: 1 if mine["observation"].iloc[0] == 3 else 10]
        ids = np.array(tags.ids())[seen["point"]]
        return Detection(ids, seen["u_px"].to_numpy() + 0.25, seen["line"].to_numpy() - 0.5)

    board = DetectedBoard(tags, detector, "centroid")
    measured = measure_extraction(scans, labels_of(truth, 0.8), truth, board, SHAPE[1])
    assert measured.accuracy["method"].unique().tolist() == [DETECTED]
    assert measured.accuracy["chosen"].all()
    assert list(DetectedBoard(RingsSection(), detector, "none").methods()) == [*METHODS, "none"]
    np.testing.assert_allclose(measured.accuracy["bias_u_px"], [0.25, 0.25, np.nan], rtol=1e-9)
    np.testing.assert_allclose(measured.accuracy["bias_v_px"], [-0.25, -0.25, np.nan], rtol=1e-9)
    assert measured.accuracy["n_points"].tolist() == measured.detection["n_found"].tolist() == [10, 10, 1]
    assert measured.detection["n_wrong"].tolist() == [0, 0, 0]
    write_table(measured.accuracy, tmp_path / "table.parquet", EXTRACTION_ACCURACY)


def test_nearest_counts_stretched_lines_no_more_than_pixels():
    grid = np.array([[0.0, 0.0], [10.0, 0.0], [0.0, 1000.0], [10.0, 1000.0]])
    near = grid[[3, 0, 1]] + [[-3.0, -200.0], [2.0, 300.0], [-4.0, 100.0]]
    assert nearest(near, grid).tolist() == [3, 0, 1]
    assert nearest(np.zeros((0, 2)), grid).tolist() == []
