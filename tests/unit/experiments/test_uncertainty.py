"""Sigmas of each stage where both are known: sigma / sqrt(n), from samples and from the curvature."""

import numpy as np
import pytest

from linepose.experiments.uncertainty import uncertainty_by_stage
from linepose.optimise import optimise
from linepose.outliers import RejectionStage
from linepose.pose import POSE_COLUMNS, SIGMA_COLUMNS
from linepose.sampling import Chain


@pytest.mark.statistical
@pytest.mark.parametrize("model", ["gaussian", "gaussian_11"])
def test_both_sigmas_of_each_stage(model, request):
    """Independent samples: 10,000 give a sigma to 1 / sqrt(2 * 10000) = 0.7 %; five of those."""
    likelihood, random = request.getfixturevalue(model), np.random.default_rng(1)
    covariance = np.linalg.inv(likelihood.information)
    stages, chains = [], []
    for n in (12, 7):
        numbers = np.arange(1, n + 1)
        optimum = optimise(likelihood.select(numbers.tolist()), likelihood.means[0, :6])
        stages.append(RejectionStage(numbers, np.zeros(n), optimum, 1))
        samples = random.multivariate_normal(optimum.parameters, covariance / n, (100, 100))
        chains.append(Chain(samples, np.zeros((100, 100)), np.zeros(100)))
    table = uncertainty_by_stage(likelihood, stages, chains)
    assert table[["n_observations", "method"]].to_numpy().tolist() == [
        [12, "mcmc"],
        [12, "laplace"],
        [7, "mcmc"],
        [7, "laplace"],
    ]
    for row, stage in zip(range(0, 4, 2), stages, strict=True):
        expected = np.sqrt(np.diag(covariance)[:6] / len(stage.number))
        sigmas = table[list(SIGMA_COLUMNS)].to_numpy()
        np.testing.assert_allclose(sigmas[row] / expected, 1, atol=0.035)
        np.testing.assert_allclose(sigmas[row + 1] / expected, 1, atol=1e-5)
        np.testing.assert_array_equal(table[list(POSE_COLUMNS)].to_numpy()[row], stage.optimum.parameters[:6])


def test_stage_without_a_curvature_keeps_its_samples(gaussian):
    gaussian.information[0, :] = gaussian.information[:, 0] = 0.0
    gaussian.select = lambda numbers: gaussian
    optimum = optimise(gaussian, gaussian.means[0])
    stage = RejectionStage(np.arange(1, 13), np.zeros(12), optimum, 1)
    chain = Chain(np.random.default_rng(1).standard_normal((10, 10, 6)), np.zeros((10, 10)), np.zeros(10))
    table = uncertainty_by_stage(gaussian, [stage], [chain]).set_index("method")[list(SIGMA_COLUMNS)]
    assert table.loc["laplace"].isna().all()
    assert table.loc["mcmc"].notna().all()
