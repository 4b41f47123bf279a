"""The interval of the basin's share: of which surveys, and how wide it is."""

import numpy as np
import pytest

from linepose.config.platform import load_platform
from linepose.experiments.basin import SECTION
from linepose.paper.expected_basin import interval, shares_outside
from unit.paper.reproduced import PAPER


@pytest.mark.parametrize("between", [0.0, 0.04, 0.08])
def test_interval_holds_nearly_all_further_surveys(between):
    random = np.random.default_rng(3)
    held = []
    for _ in range(1000):  # shares that differ from survey to survey, each found with 40 or 788 starts
        rates = random.normal(0.8, between, 13).clip(0.0, 1.0)
        shares = random.binomial(40, rates[:-1]) / 40
        further = random.binomial(788, rates[-1]) / 788
        expected, tolerance = interval(shares, 40, 788)
        held.append(abs(further - expected) <= tolerance)
    assert 0.92 < np.mean(held) < 0.999


def test_surveys_that_are_alike_leave_the_spread_of_the_starts():
    expected, tolerance = interval([0.9] * 12, 40, 900)
    assert expected == pytest.approx(0.9)
    assert tolerance == pytest.approx(3.106 * 0.01, rel=1e-3)  # Student's t of 11 degrees of freedom


def test_a_survey_depends_on_its_number_alone():
    platform = load_platform(PAPER.parent / "platforms", "shrimp-sim")
    grid = SECTION.of(platform)
    assert grid is not None
    shares = shares_outside(platform, grid, 2, 3, seed=5)
    assert shares[0] == shares_outside(platform, grid, 1, 3, seed=5)[0]
    assert shares.between(0.0, 1.0).all()
