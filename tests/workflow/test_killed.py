"""A run killed in the middle of a sweep goes on with the same command, to the same bytes; one run at a time."""

import os
import shutil
import signal
import time

import pytest
from tiny_project import STUDY, TINY, Project, lines_with

pytestmark = pytest.mark.workflow
BASIN = "results/tiny/basin.parquet"
SWEEP = {"n_distances": 4, "n_angles": 4, "optimisers": ["powell", "wide"]}


def with_batches_of(project, size):
    experiments = TINY["experiments"] | {"basin": SWEEP | {"batch_size": size}}
    project.configure(STUDY, {"tiny": TINY | {"experiments": experiments}})
    return project


def wait_for_batches(project, run):
    """The folder of finished batches, once there are some."""
    finished = project.folder / "results" / "tiny" / "work" / "basin"
    while len(list(finished.rglob("*.parquet"))) < 3 and run.poll() is None:
        time.sleep(0.01)
    return finished


@pytest.fixture(scope="module")
def whole(finished, tmp_path_factory):
    """The bytes of the sweep that ran through, in other batches and on one core."""
    folder = tmp_path_factory.mktemp("whole") / "project"
    shutil.copytree(finished.folder, folder)
    project = with_batches_of(Project(folder), 30)
    run = project.run(BASIN, cores=1)
    assert run.returncode == 0, run.stderr
    return (folder / BASIN).read_bytes()


@pytest.mark.parametrize("killed", ["all processes", "snakemake alone"])
def test_killed_sweep_goes_on_to_the_same_bytes(copied, whole, killed):
    """Orphans may still be at work when the next begins."""
    result = copied.folder / BASIN
    result.unlink()

    run = with_batches_of(copied, 1).start(BASIN)
    finished = wait_for_batches(copied, run)
    (os.killpg if killed == "all processes" else os.kill)(run.pid, signal.SIGKILL)
    run.wait()
    assert not result.exists()

    again = copied.run(BASIN)
    assert again.returncode == 0, again.stderr
    assert result.read_bytes() == whole
    assert not finished.exists()


def test_second_run_in_a_folder_says_so_and_spoils_nothing(copied):
    first = with_batches_of(copied, 1).start("--forcerun", "basin", "--", BASIN)
    finished = wait_for_batches(copied, first)
    os.killpg(first.pid, signal.SIGSTOP)
    made = {path: path.read_bytes() for path in finished.rglob("[0-9a-z]*.parquet")}
    for second in (copied.run("--", BASIN), copied.linepose("run", "tiny")):
        assert second.returncode == 1
        told = lines_with(f"found another run at work here (process {first.pid})", second.stderr)
        assert len(told) == 1, second.stderr
        assert "Traceback" not in second.stderr
    assert made.items() <= {path: path.read_bytes() for path in finished.rglob("[0-9a-z]*.parquet")}.items()
    os.killpg(first.pid, signal.SIGCONT)
    first.communicate(timeout=600)
    assert first.returncode == 0
    assert (copied.folder / BASIN).is_file()


@pytest.mark.parametrize("kind", [signal.SIGKILL, signal.SIGTERM])
def test_linepose_run_killed_alone_takes_its_processes_along_and_goes_on(copied, kind):
    run = with_batches_of(copied, 1).start_linepose("run", "tiny", "--cores", "2")
    wait_for_batches(copied, run)
    os.kill(run.pid, kind)
    run.wait()
    deadline = time.monotonic() + 30
    while group_is_alive(run.pid):
        assert time.monotonic() < deadline, "a process outlived the command that started it"
        time.sleep(0.1)
    assert not (copied.folder / BASIN).exists()
    if kind == signal.SIGKILL:
        again = copied.run(BASIN)
        assert again.returncode == 0, again.stderr
        assert (copied.folder / BASIN).is_file()


def group_is_alive(group):
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return False
    return True
