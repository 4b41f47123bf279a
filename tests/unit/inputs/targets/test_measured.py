import numpy as np
import pandas as pd
import pytest
from PIL import Image

from linepose.inputs.observed_points import SCAN_POINTS
from linepose.inputs.targets.measured import DETECTION, EXTRACTION_ACCURACY, measure_extraction, nearest
from linepose.tables import write_table

SHAPE = (200, 150)


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
    measured = measure_extraction(scans, labels_of(truth, 0.8), truth, "centroid", SHAPE[1])
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
    accuracy = measure_extraction(scans, labels, truth, "centroid", SHAPE[1]).accuracy.set_index(
        ["observation", "method"]
    )
    assert accuracy["chosen"].to_dict() == {(n, m): m == "centroid" for n in (1, 2, 3) for m in ("peak", "centroid")}
    assert accuracy["n_points"].tolist() == [15, 15, 13, 13, 15, 15]
    assert np.all(accuracy["n_missing"] == 0)
    assert accuracy.loc[accuracy["chosen"], ["sigma_u_px", "sigma_v_px"]].to_numpy().max() < 0.1
    assert np.all(accuracy.xs("peak", level=1)["sigma_u_px"] > accuracy.xs("centroid", level=1)["sigma_u_px"])


def test_doubtful_scan_finds_nothing_and_says_why(survey, drawn):
    scans, truth = survey
    unmarked = drawn([[0, 125], [210, 0]], [75, 100], SHAPE, with_mark=False)
    Image.fromarray(unmarked.intensity.clip(0).astype(np.uint16)).save(scans[1])
    detection = measure_extraction(scans, labels_of(truth, 0.5), truth, "centroid", SHAPE[1]).detection
    assert detection["n_found"].tolist() == [0, 13, 15]
    assert "corner mark is not seen" in detection["doubt"][0]


def test_nearest_counts_stretched_lines_no_more_than_pixels():
    grid = np.array([[0.0, 0.0], [10.0, 0.0], [0.0, 1000.0], [10.0, 1000.0]])
    near = grid[[3, 0, 1]] + [[-3.0, -200.0], [2.0, 300.0], [-4.0, 100.0]]
    assert nearest(near, grid).tolist() == [3, 0, 1]
    assert nearest(np.zeros((0, 2)), grid).tolist() == []
