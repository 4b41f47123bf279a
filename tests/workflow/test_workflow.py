import re
import shutil

import numpy as np
import pandas as pd
import pytest
from tiny_project import QUICK, STUDY, TINY, Project, lines_with

from linepose.geometry.pose import POSE_COLUMNS

pytestmark = pytest.mark.workflow


def test_every_result_is_made(finished):
    made = set(finished.results())
    stages = ["points", "observations", "outliers", "optima", "pose", "diagnostics", "truth", "truth_error"]
    stages += ["extraction_accuracy", "detection", "detected_points"]
    assert {f"tiny/{stage}.parquet" for stage in stages} <= made
    assert {"tiny/mcmc/all.parquet", "tiny/mcmc/inliers.parquet"} <= made


def test_a_project_without_the_paper_has_none_of_it(finished):
    assert "regression.parquet" not in finished.results()
    assert not (finished.folder / "results" / "paper.html").exists()
    report = (finished.folder / "results" / "report.html").read_text()
    assert "shrimp" not in report.lower()
    assert "paper.html" not in report


def test_pose_is_that_of_the_simulation(finished):
    results = finished.folder / "results" / "tiny"
    pose = pd.read_parquet(results / "optima.parquet").set_index("stage").loc["all", list(POSE_COLUMNS)]
    truth = pd.read_parquet(results / "truth.parquet")[list(POSE_COLUMNS)].iloc[0]
    # four views leave the pose open by decimetres along the line of sight, and tight enough in the rotation
    assert np.linalg.norm((pose - truth)[:3].astype(float)) < 0.4
    assert np.linalg.norm((pose - truth)[3:].astype(float)) < 0.1


def test_points_are_those_of_the_simulation(finished):
    results = finished.folder / "results" / "tiny"
    points = pd.read_parquet(results / "points.parquet")
    truth = pd.read_parquet(results / "truth.parquet").query("visible")
    both = points.merge(truth, on=["observation", "point"], suffixes=("", "_true"))
    assert len(both) == len(points) == 60
    np.testing.assert_allclose(both["u_px"], both["u_px_true"], atol=0.2)
    np.testing.assert_allclose(both["line"], both["line_true"], atol=0.3)


def test_all_points_are_detected_without_labels(finished):
    detection = pd.read_parquet(finished.folder / "results" / "tiny" / "detection.parquet")
    assert detection["n_visible"].tolist() == detection["n_found"].tolist() == [15] * 4
    assert detection["n_wrong"].sum() == 0


def test_nothing_is_left_to_do_after_a_run(finished):
    run = finished.run("--dry-run")
    assert run.returncode == 0
    assert "Nothing to be done" in run.stdout + run.stderr


@pytest.mark.parametrize(
    ("study", "platform", "told"),
    [
        (STUDY | {"sampling": {"n_walker": 14}}, TINY, "sampling.n_walker: found an unknown key"),
        (STUDY | {"platforms": ["tiny", "tinny"]}, TINY, "tinny.yaml: found no such platform"),
    ],
)
def test_wrong_configuration_is_one_line_and_spares_the_results(copied, study, platform, told):
    before = copied.results()
    copied.configure(study, {"tiny": platform})
    run = copied.run()
    assert run.returncode != 0
    assert len(lines_with(told, run.stderr)) == 1, run.stderr
    assert "Traceback" not in run.stderr
    assert copied.results() == before


def recorded(project, name, **source):
    """The simulated survey as a platform of the user's own, with its files in a data folder."""
    shutil.copytree(project.folder / "results" / "tiny" / "simulated", project.folder / "data" / name)
    return QUICK | {"simulation": None, "source": {"kind": "scans", "dataset": name, **source}}


def truncate_scan(folder):
    scan = folder / "scans" / "observation-02.bil"
    scan.write_bytes(scan.read_bytes()[:-1000])


def claim_absurd_size(folder):
    header = folder / "scans" / "observation-03.hdr"
    header.write_text(re.sub("lines = .*", "lines = 900000000000", header.read_text()))


def turn_time_back(folder):
    times = folder / "scans" / "observation-01-times.csv"
    rows = times.read_text().splitlines()
    times.write_text("\n".join([*rows[:9], rows[7], *rows[10:]]) + "\n")


def scatter_pixels(folder):
    scan = folder / "scans" / "observation-04.bil"
    np.random.default_rng(0).permutation(np.fromfile(scan, "<u2")).tofile(scan)


def put_label_outside(folder):
    labels = pd.read_csv(folder / "labels.csv")
    labels.loc[20, "u_px"] = 700.0
    labels.to_csv(folder / "labels.csv", index=False)


def end_log_early(folder):
    log = pd.read_parquet(folder / "navigation.parquet")
    log.iloc[: len(log) // 2].to_parquet(folder / "navigation.parquet", index=False)


BAD = {
    "truncated": (truncate_scan, "labels", "data/truncated/scans/observation-02.bil: found "),
    "absurd": (claim_absurd_size, "labels", ", lines: found 900000000000,"),
    "clock": (turn_time_back, "labels", "data/clock/scans/observation-01-times.csv, row 10: found time "),
    "boardless": (scatter_pixels, "detection", "data/boardless/scans/observation-04.hdr: found no board"),
    "label": (put_label_outside, "labels", "data/label/scans/observation-02.hdr: label of observation 2, point 5: "),
    "log": (end_log_early, "labels", "data/log/navigation.parquet: observation 3, point 0: found time "),
}


def test_own_scans_without_labels_while_other_platforms_fail(copied):
    platforms = {"tiny": TINY, "own": recorded(copied, "own", points="detection")}
    platforms |= {name: recorded(copied, name, points=points) for name, (_, points, _) in BAD.items()}
    data = copied.folder / "data"
    (data / "own" / "labels.csv").unlink()
    for name, (spoil, _, _) in BAD.items():
        spoil(data / name)
    before = copied.results()
    copied.configure(STUDY | {"platforms": list(platforms)}, platforms)
    run = copied.run("results/own/optima.parquet", *(f"results/{name}/observations.parquet" for name in BAD))
    assert run.returncode != 0
    for _, _, told in BAD.values():
        assert len(lines_with(told, run.stderr)) == 1, run.stderr
    assert "Traceback" not in run.stderr
    after = copied.results()
    assert {path: after[path] for path in before if path.startswith("tiny/")} == {
        path: content for path, content in before.items() if path.startswith("tiny/")
    }
    # found without labels: the same points in the same places, so the same pose to the last bit or nearly so
    poses = [
        pd.read_parquet(copied.folder / "results" / name / "optima.parquet")[list(POSE_COLUMNS)].to_numpy()[0]
        for name in ("tiny", "own")
    ]
    np.testing.assert_allclose(poses[0], poses[1], atol=0.05)
    assert not any((copied.folder / "results" / name / "observations.parquet").exists() for name in BAD)


def test_file_that_is_missing_from_own_data_is_one_line(copied):
    own = recorded(copied, "own", points="detection")
    (copied.folder / "data" / "own" / "navigation.parquet").unlink()
    before = copied.results()
    copied.configure(STUDY | {"platforms": ["own"]}, {"own": own})
    run = copied.run()
    assert run.returncode != 0
    assert "navigation.parquet" in run.stderr
    assert "Traceback" not in run.stderr
    assert {path: content for path, content in copied.results().items() if path in before} == before


@pytest.fixture
def without_field_data(tmp_path):
    """A project with a platform whose data set is in no data folder, at a server that does not answer."""
    project = Project(tmp_path)
    project.configure(
        STUDY | {"platforms": ["ladybird", "tiny"], "datasets": {"ladybird": "config/datasets/nowhere.yaml"}},
        {"tiny": TINY},
    )
    (tmp_path / "config" / "datasets" / "nowhere.yaml").write_text(
        "base_url: http://127.0.0.1:9/\nsha256: {nav_covs.csv: " + "a" * 64 + "}\n"
    )
    return project


def test_offline_leaves_out_platforms_whose_data_set_is_not_here(without_field_data):
    run = without_field_data.run("--dry-run", "--config", "offline=true")
    assert run.returncode == 0, run.stderr
    told = "data set ladybird: not in data, and `offline` forbids to download it; only the other platforms run: tiny"
    assert len(lines_with(told, run.stderr + run.stdout)) == 1, run.stderr
    assert "results/ladybird/" not in run.stdout + run.stderr


def test_data_set_that_cannot_be_had_is_one_line_that_says_what_to_do(without_field_data):
    run = without_field_data.run("results/datasets/ladybird.csv")
    assert run.returncode != 0
    told = lines_with("linepose.fetch_ladybird: data set ladybird: found no copy in data/ladybird", run.stderr)
    assert len(told) == 1, run.stderr
    assert told[0].endswith("or leave its platforms out: snakemake --config offline=true")
    assert "Traceback" not in run.stderr


def test_folder_from_which_a_file_was_lost_is_made_again(copied):
    before = copied.results()
    lost, made = copied.folder / "results" / "tiny" / "mcmc" / "all.parquet", "results/tiny/mcmc_files.txt"
    lost.unlink()
    run = copied.run(made)
    assert run.returncode == 0, run.stderr
    told = "results/tiny/mcmc: all.parquet lost; the folder is made again"
    assert len(lines_with(told, run.stderr)) == 1, run.stderr
    assert lost.is_file()
    again = copied.run("--dry-run", made)
    assert "Nothing to be done" in again.stdout + again.stderr
    assert copied.results() == before


def test_snakemakes_own_report_has_every_figure_with_title_and_caption(finished, tmp_path):
    run = finished.run("--report", str(tmp_path / "report.html"))
    assert run.returncode == 0, run.stderr
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    index = pd.read_parquet(finished.folder / "results" / "tiny" / "figures" / "index.parquet")
    assert not [text for text in index["left_out"] if "could not be drawn" in text]
    drawn = index.query("left_out == ''")
    assert len(drawn) > 10
    for title in drawn["title"]:
        assert f'"labels": {{"figure": "{title}"' in page
    assert page.count("Platform <tt") == len(drawn)  # the end of each figure's caption
    assert '{"result": "summary of all platforms"}' in page
