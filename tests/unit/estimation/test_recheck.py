"""New views against a calibration: what both rest on counts once, and a planted move is found."""

from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.stats import chi2

from linepose.adjustment.settings import AdjustmentSection
from linepose.config.platform import load_platform
from linepose.estimation.pose_change import SCALE, WHOLE
from linepose.estimation.recheck import _change
from unit.conftest import ROOT

QUICK = AdjustmentSection(n_draws=10, n_samples=10, tails=False)
N_RECHECKS = 3


@pytest.fixture(scope="module")
def bench():
    """The benchmark, of which these tests are a small part."""
    import runpy

    return runpy.run_path(str(ROOT / "benchmarks" / "recheck.py"))


@pytest.fixture(scope="module")
def platform():
    return load_platform(ROOT / "config" / "platforms", "ladybird-sim")


@pytest.fixture(scope="module")
def still(bench, platform):
    """Rechecks of a camera that has not moved."""
    return [bench["simulated"](platform, np.zeros(6), seed, QUICK) for seed in range(N_RECHECKS)]


@pytest.mark.statistical
def test_a_camera_that_stayed_is_told_to_have_stayed(still):
    """The sum of squared distances is chi squared: within what all but one in a thousand such sums are."""
    tests = [one.test(WHOLE) for one in still]
    freedom = sum(one.degrees_of_freedom for one in tests)
    assert freedom == 6 * N_RECHECKS
    total = sum(one.distance**2 for one in tests)
    assert chi2.ppf(0.0005, freedom) < total < chi2.ppf(0.9995, freedom)


@pytest.mark.statistical
def test_a_move_of_twice_the_least_is_found(bench, platform, still):
    """With a chance above 99.9 %."""
    least = np.median([one.least_seen() for one in still], axis=0)
    axis = 1
    change = bench["simulated"](platform, 2 * least[axis] * np.eye(6)[axis], 101, QUICK)
    assert change.test(WHOLE).p_value < 0.05
    assert abs(change.move[axis] - 2 * least[axis]) < 4 * change.sigma[axis]


def test_what_both_estimates_rest_on_counts_once():
    """Errors of the intrinsics that move both alike cancel; the wide prior of the views takes nothing away."""
    random = np.random.default_rng(7)
    root = random.standard_normal((6, 6))
    alone = 0.01 * (root @ root.T + np.eye(6)) * np.outer(SCALE, SCALE)  # of the views, without the wide prior
    intrinsics = np.diag([2.0, 1e-4]) ** 2
    follows = random.standard_normal((6, 2)) * SCALE[:, None] / [20.0, 1e-3]
    own = 0.3 * alone
    calibrated = SimpleNamespace(
        pose=np.zeros(6),
        covariance=own + follows @ intrinsics @ follows.T,
        pose_by_intrinsics=follows,
        intrinsics_covariance=intrinsics,
    )
    shrunk = np.linalg.inv(np.linalg.inv(alone) + np.diag(SCALE**-2))
    seen = shrunk @ np.linalg.inv(alone)
    views = SimpleNamespace(pose=np.zeros(6), covariance=shrunk, pose_by_intrinsics=seen @ follows)
    assert_allclose(_change(calibrated, views).covariance, alone + own, rtol=1e-6, atol=1e-12)
    views.pose_by_intrinsics = np.zeros((6, 2))
    assert_allclose(_change(calibrated, views).covariance, alone + calibrated.covariance, rtol=1e-6, atol=1e-12)
