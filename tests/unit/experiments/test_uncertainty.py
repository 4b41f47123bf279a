import numpy as np
import pandas as pd

from linepose.experiments.uncertainty import uncertainty_by_stage
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from linepose.pipeline.stages import LAPLACE_SIGMA_COLUMNS


def test_each_stage_has_both_sigmas_beside_its_pose():
    random = np.random.default_rng(1)
    stages, sizes = ["all", "observations_24", "inliers"], [25, 24, 23]
    optima = pd.DataFrame(random.random((3, 6)), columns=POSE_COLUMNS).assign(stage=stages, n_observations=sizes)
    optima[list(LAPLACE_SIGMA_COLUMNS)] = random.random((3, 6))
    poses = pd.DataFrame(random.random((4, 6)), columns=SIGMA_COLUMNS)
    poses["stage"] = ["hand_measured", "inliers", "all", "observations_24"]  # another order
    table = uncertainty_by_stage(optima, poses)
    assert table[["stage", "method"]].to_numpy().tolist() == [
        ["all", "mcmc"],
        ["all", "laplace"],
        ["observations_24", "mcmc"],
        ["observations_24", "laplace"],
        ["inliers", "mcmc"],
        ["inliers", "laplace"],
    ]
    found = table.set_index(["stage", "method"])
    for k, stage in enumerate(stages):
        sampled = poses.set_index("stage").loc[stage, list(SIGMA_COLUMNS)].to_numpy(dtype=float)
        np.testing.assert_array_equal(found.loc[(stage, "mcmc"), list(SIGMA_COLUMNS)].to_numpy(dtype=float), sampled)
        curved = optima.loc[k, list(LAPLACE_SIGMA_COLUMNS)].to_numpy(dtype=float)
        np.testing.assert_array_equal(found.loc[(stage, "laplace"), list(SIGMA_COLUMNS)].to_numpy(dtype=float), curved)
        for method in ("mcmc", "laplace"):
            pose = optima.loc[k, list(POSE_COLUMNS)].to_numpy(dtype=float)
            np.testing.assert_array_equal(found.loc[(stage, method), list(POSE_COLUMNS)].to_numpy(dtype=float), pose)
