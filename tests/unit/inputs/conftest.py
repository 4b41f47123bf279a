"""A drive of the simulator, and the real device files where they are found."""

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from linepose.config.platform import load_platform
from linepose.simulation import record
from unit.inputs.drive import drive_of
from unit.inputs.targets.conftest import draw

ROOT = Path(__file__).parents[3]
SAMPLES = ROOT.parent / "shared" / "samples"
SIGMA = np.array([0.021, 0.034, 0.052, 0.0031, 0.0042, 0.0093])


@pytest.fixture(scope="session")
def simulated_log():
    """The first twelve seconds of the simulated Ladybird's navigation log, every tenth row, with a tilted body."""
    settings = load_platform(ROOT / "config" / "platforms", "shrimp-sim").simulation
    table = record.navigation_log(settings).iloc[2000:3200:10].reset_index(drop=True)
    table["roll_rad"] += 0.2
    table["pitch_rad"] -= 0.15
    return table


@pytest.fixture(scope="session")
def drive(simulated_log):
    """The log as a drive near Sydney, its quantities independent."""
    return drive_of(simulated_log, np.diag(SIGMA**2))


@pytest.fixture(scope="session")
def correlated(simulated_log):
    """The same drive, all six quantities correlated."""
    factor = np.eye(6) + np.tril(np.random.default_rng(3).uniform(-0.5, 0.5, (6, 6)), -1)
    correlation = factor @ factor.T
    unit = np.sqrt(np.diag(correlation))
    return drive_of(simulated_log, correlation / np.outer(unit, unit) * np.outer(SIGMA, SIGMA))


@pytest.fixture
def samples():
    """Folder of real device files; the test is skipped where there is none."""
    if not (SAMPLES / "novatel").is_dir():
        pytest.skip("no device files in ../shared/samples")
    return SAMPLES


@pytest.fixture(scope="session")
def random_rotation():
    return Rotation.random(40, random_state=np.random.default_rng(4))


@pytest.fixture(scope="session")
def drawn():
    return draw
