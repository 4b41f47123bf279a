"""A run killed in the middle of a sweep goes on with the same command, to the same bytes."""

import os
import signal
import time

import pytest
from tiny_project import STUDY, TINY

pytestmark = pytest.mark.workflow
BASIN = "results/tiny/basin.parquet"
SWEEP = {"n_distances": 9, "n_angles": 8, "optimisers": ["powell", "wide"]}


def with_batches_of(project, size):
    experiments = TINY["experiments"] | {"basin": SWEEP | {"batch_size": size}}
    project.configure(STUDY, {"tiny": TINY | {"experiments": experiments}})
    return project


@pytest.mark.parametrize("killed", ["all processes", "snakemake alone"])
def test_killed_sweep_goes_on_to_the_same_bytes(copied, killed):
    """Against one that ran through in other batches on one core; orphans may still be at work when the next begins."""
    whole = with_batches_of(copied, 30).run(BASIN, cores=1)
    assert whole.returncode == 0, whole.stderr
    result = copied.folder / BASIN
    expected = result.read_bytes()
    result.unlink()

    run = with_batches_of(copied, 1).start(BASIN)
    finished = copied.folder / "results" / "tiny" / "work" / "basin"
    while len(list(finished.rglob("*.parquet"))) < 3 and run.poll() is None:
        time.sleep(0.01)
    (os.killpg if killed == "all processes" else os.kill)(run.pid, signal.SIGKILL)
    run.wait()
    assert not result.exists()

    again = copied.run(BASIN)
    assert again.returncode == 0, again.stderr
    assert result.read_bytes() == expected
    assert not finished.exists()
