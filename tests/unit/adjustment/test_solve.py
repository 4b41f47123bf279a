"""Gauss-Newton where full steps rise."""

import numpy as np
import pytest

from linepose.adjustment.estimate import unit_weights
from linepose.adjustment.hand_measured import hand_measured
from linepose.adjustment.levels import Levels
from linepose.adjustment.measurements import measurements_from_survey
from linepose.adjustment.settings import default_hand_covariance
from linepose.adjustment.solve import solve
from linepose.adjustment.start import start_points
from linepose.adjustment.state import Knowledge, state_at
from linepose.config.platform import load_platform
from linepose.experiments.coverage import drawn_hand_measurement
from linepose.simulation.noise_levels import NoiseLevels
from linepose.simulation.noisy_survey import draw_survey

LEAST = Levels(0.1, 0.1, 0.1, 0.2, 0.2, 1.0, 0.3)
MOST = Levels(2.0, 2.0, 2.0, 1.5, 1.5, 100.0, 1.5)


@pytest.mark.statistical
@pytest.mark.parametrize("seed", [2, 8, 12, 13, 14])
def test_it_converges_where_full_steps_rise(platforms_folder, seed):
    """Attitude errs by a degree at every measurement, which levels as they may be at the start do not expect."""
    shrimp = load_platform(platforms_folder, "shrimp-sim")
    assert shrimp.simulation is not None
    camera, random = shrimp.intrinsics(), np.random.default_rng(seed)
    survey, truth = draw_survey(camera, shrimp.simulation, NoiseLevels(white_level=1.0), random)
    hand = drawn_hand_measurement(truth, random)
    measurements = measurements_from_survey(survey, camera, None, 1 / shrimp.simulation.image.line_rate_hz)
    knowledge = Knowledge(camera, hand_measured(hand, default_hand_covariance()), None)
    levels = Levels(*np.exp(random.uniform(np.log(LEAST), np.log(MOST))))
    lowest = []
    for start in (hand, truth):
        state = state_at(start, camera, start_points(measurements, camera, start), measurements)
        found = solve(measurements, knowledge, state, levels, unit_weights(measurements), tolerance=1e-4, max_steps=150)
        assert found.converged
        lowest.append(found.done.chi_squared)
    assert lowest[0] == pytest.approx(lowest[1], abs=1e-3)
