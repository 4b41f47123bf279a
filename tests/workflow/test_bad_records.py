"""Each fault that a record may have, planted in the field data: one line each, and no result touched."""

import shutil
from pathlib import Path

import pytest
from tiny_project import ROOT, STUDY, Project, lines_with

pytestmark = [pytest.mark.workflow, pytest.mark.field]
FIELD_DATA = ROOT.parent / "shared" / "ladybird"
ALONE = {"sensitivity": None, "adjustment_beside": None}  # no comparison with the field data's other platforms
EARLIER = b"made before the fault"


def with_rows(change):
    """A fault that turns a file's rows, each a list of cells, into others."""

    def plant(path: Path) -> None:
        rows = [row.split(",") for row in path.read_text().splitlines()]
        path.write_text("".join(",".join(row) + "\n" for row in change(rows)))

    return plant


def with_cell(row, column, text):
    """A fault in one cell, counted from 1."""

    def change(rows):
        rows[row - 1][column - 1] = text
        return rows

    return with_rows(change)


def in_seconds(rows):
    return [[row[0][:-6], *row[1:]] for row in rows]


VIEW, COVARIANCES = "view", "covariances"  # the second view file, which is the first that is used
FAULTS = {  # name: file, fault, what is told behind the file's name
    "short": (VIEW, with_rows(lambda rows: [row[:-1] for row in rows]), ", row 1: found 8 columns, expected 9"),
    "text": (VIEW, with_cell(3, 6, "abc"), ", row 3, column 6: found 'abc', expected a number"),
    "seconds": (VIEW, with_rows(in_seconds), ", row 1, column 1: found time 1466040457, expected microseconds"),
    "twice": (VIEW, with_cell(3, 2, "1"), ", row 3, column 2: found point 1 again"),
    "pixel": (VIEW, with_cell(3, 3, "648"), ", row 3, column 3: found pixel 648, expected a pixel of the sensor"),
    "nan": (VIEW, with_cell(3, 8, "nan"), ", row 3, pitch_rad: found no number"),
    "empty": (VIEW, lambda path: path.write_text(""), ": found an empty file"),
    "two": (
        COVARIANCES,
        with_rows(lambda rows: [rows[0], [rows[0][0], *rows[1][1:]], *rows[2:]]),
        ", row 2, column 1: found time",
    ),
    "asymmetric": (COVARIANCES, with_cell(9, 14, "0.01"), ", row 9: found covariance"),
    "negative": (COVARIANCES, with_cell(9, 2, "-1e-4"), ", row 9: found a covariance whose correlations have"),
    "gap": (COVARIANCES, with_rows(lambda rows: rows[:10]), ": observation 25, point"),
    "few": (VIEW, None, "labelled_points/*.csv: found 0 spare equations (1 observations"),
}


@pytest.mark.skipif(not FIELD_DATA.is_dir(), reason="no Ladybird field data in ../shared")
def test_each_fault_is_one_line_and_spares_the_results(tmp_path):
    project = Project(tmp_path)
    platforms = {}
    for name, (kind, plant, _) in FAULTS.items():
        data = tmp_path / "data" / name
        shutil.copytree(FIELD_DATA, data)
        if plant:
            plant(sorted(data.glob("labelled_points/*.csv"))[1] if kind == VIEW else data / "nav_covs.csv")
        source = {"dataset": name} | ({} if plant else {"first": 50})
        platforms[name] = {"like": "ladybird", "source": source, "experiments": ALONE}
        for result in ("points", "observations", "navigation_sigma", "outliers", "pose"):
            earlier = tmp_path / "results" / name / f"{result}.parquet"
            earlier.parent.mkdir(parents=True, exist_ok=True)
            earlier.write_bytes(EARLIER)
    project.configure(STUDY | {"platforms": list(platforms)}, platforms)
    run = project.run(
        "--keep-going", "--forcerun", "check_data", "--", *(f"results/{name}/observations.parquet" for name in FAULTS)
    )
    assert run.returncode != 0
    assert "Traceback" not in run.stderr
    for name, (kind, plant, told) in FAULTS.items():
        lines = lines_with(f"data/{name}/", "\n".join(lines_with("linepose.check_readable: ", run.stderr)))
        assert len(lines) == 1, (name, run.stderr)
        file = "-split_target_points.csv" if kind == VIEW else "nav_covs.csv"
        assert (file if plant else "") + told in lines[0], name
    assert set(project.results().values()) == {EARLIER}
    assert len(project.results()) == 5 * len(FAULTS)
