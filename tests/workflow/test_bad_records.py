"""Faults planted in the field data: the workflow tells each in one line, and touches no result."""

import pytest
from tiny_project import ROOT, STUDY, Project, lines_with
from unit.planted_faults import planted, told_of

pytestmark = [pytest.mark.workflow, pytest.mark.field]
FIELD_DATA = ROOT.parent / "shared" / "ladybird"
ALONE = {"sensitivity": None, "adjustment_beside": None}  # no comparison with the field data's other platforms
EARLIER = b"made before the fault"
NAMES = ("pixel", "asymmetric", "few")  # of a view, of the covariances, of neither


@pytest.mark.skipif(not FIELD_DATA.is_dir(), reason="no Ladybird field data in ../shared")
def test_each_fault_is_one_line_and_spares_the_results(tmp_path):
    project = Project(tmp_path)
    platforms = {}
    for name in NAMES:
        source = {"dataset": name} | planted(name, FIELD_DATA, tmp_path / "data" / name)
        platforms[name] = {"like": "ladybird", "source": source, "experiments": ALONE}
        for result in ("points", "observations", "navigation_sigma", "outliers", "pose"):
            earlier = tmp_path / "results" / name / f"{result}.parquet"
            earlier.parent.mkdir(parents=True, exist_ok=True)
            earlier.write_bytes(EARLIER)
    project.configure(STUDY | {"platforms": list(platforms)}, platforms)
    run = project.run(
        "--keep-going", "--forcerun", "check_data", "--", *(f"results/{name}/observations.parquet" for name in NAMES)
    )
    assert run.returncode != 0
    assert "Traceback" not in run.stderr
    for name in NAMES:
        lines = lines_with(f"data/{name}/", "\n".join(lines_with("linepose.check_readable: ", run.stderr)))
        assert len(lines) == 1, (name, run.stderr)
        assert told_of(name) in lines[0], name
    assert set(project.results().values()) == {EARLIER}
    assert len(project.results()) == 5 * len(NAMES)
