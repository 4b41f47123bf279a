"""Where the experiments' inputs come from."""

import numpy as np
import pandas as pd

from linepose.experiments.accepted import read_reference
from linepose.geometry.pose import POSE_COLUMNS
from linepose.pipeline.stages import LAPLACE_SIGMA_COLUMNS, OPTIMA, SAMPLES
from linepose.tables import write_table


def test_reference_is_the_inliers_optimum_with_their_samples_covariance(tmp_path):
    random = np.random.default_rng(1)
    optima = pd.DataFrame(random.random((2, 6)), columns=POSE_COLUMNS)
    optima[list(LAPLACE_SIGMA_COLUMNS)] = 1.0
    rest = {name: 1 for name in OPTIMA.names if name not in optima}
    optima = optima.assign(**(rest | {"converged": True, "stage": ["all", "inliers"]}))
    write_table(optima, tmp_path / "optima.parquet", OPTIMA)
    samples = random.standard_normal((40, 6)) @ random.standard_normal((6, 6))
    chain = pd.DataFrame(samples, columns=POSE_COLUMNS).assign(log_likelihood=0.0)
    chain["step"], chain["walker"] = np.divmod(np.arange(40), 8)
    write_table(chain, tmp_path / "mcmc" / "inliers.parquet", SAMPLES)
    reference = read_reference(tmp_path / "optima.parquet", tmp_path / "mcmc")
    np.testing.assert_array_equal(reference.pose, optima.loc[1, list(POSE_COLUMNS)].to_numpy(dtype=float))
    deviation = samples - samples.mean(axis=0)
    np.testing.assert_allclose(reference.covariance, deviation.T @ deviation / 39, rtol=1e-12)
    reference.pose[0] = 0.0  # its own: writable
