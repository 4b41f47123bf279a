"""The paper's estimate from one survey more like a simulated platform's, without the observations of planted faults."""

from typing import NamedTuple

import numpy as np

from linepose.arrays import Floats
from linepose.config.platform import Platform
from linepose.estimation.optimise import laplace_covariance, minimise
from linepose.likelihood.published import PublishedLikelihood
from linepose.simulation.survey import faulty_observations, simulate_survey


class SimulatedEstimate(NamedTuple):
    """The likelihood of the survey, its optimum (6,) with the curvature's covariance (6, 6), and the true pose (6,)."""

    likelihood: PublishedLikelihood
    optimum: Floats
    covariance: Floats
    true_pose: Floats


def simulated_estimate(platform: Platform, random: np.random.Generator) -> SimulatedEstimate:
    """The estimate from a survey whose seed is the generator's next number; the platform has a simulation."""
    assert platform.simulation is not None
    survey, truth = simulate_survey(platform.intrinsics(), platform.simulation, int(random.integers(2**63)))
    faulty = set(faulty_observations(platform.simulation))
    accepted = survey.select([number for number in survey.number if number not in faulty])
    likelihood = PublishedLikelihood(accepted, platform.intrinsics())
    start = platform.start_pose()
    found = minimise(likelihood, likelihood.start(start), start)
    covariance = laplace_covariance(likelihood, found.parameters)
    return SimulatedEstimate(likelihood, found.parameters, covariance, truth.pose)
