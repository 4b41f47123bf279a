"""How far off, in its own sigmas, the paper's likelihood is on surveys like a simulated platform's.

The simulated platforms are one survey each, so that a limit on their error in sigmas cannot be read off them. Here many
are drawn: the same drive, camera and navigation errors, other random numbers, without the observations that carry a
planted fault. `python -m linepose.paper.expected_errors` prints, for each simulated platform of config/paper, the
interval that holds 99 % of the errors; config/paper/regression.yaml declares it.
"""

import argparse
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from linepose.arrays import Floats
from linepose.config.platform import Platform, load_platform
from linepose.experiments.truth_error import truth_error_table
from linepose.geometry.pose import POSE_COLUMNS
from linepose.paper.declarations import load_declarations
from linepose.paper.importance import importance_samples
from linepose.paper.simulated_estimate import simulated_estimate

QUANTILES: Final = (0.005, 0.5, 0.995)
_N_DRAWS: Final = 2000
_STAGE: Final = "inliers"


def errors_in_sigmas(platform: Platform, n_surveys: int, seed: int) -> pd.DataFrame:
    """Errors of the estimates from `n_surveys` simulated surveys; a row a survey, a column a quantity.

    The quantities are those of `truth_error_table`: the six parameters, signed, and position, rotation and pose as
    Mahalanobis distances. Survey k is drawn from `[seed, k]`, whatever their number. Raises InputError for a platform
    without a simulation.
    """
    return pd.DataFrame([_errors_of_survey(platform, np.random.default_rng([seed, k])) for k in range(n_surveys)])


def _errors_of_survey(platform: Platform, random: np.random.Generator) -> "pd.Series[float]":
    one = simulated_estimate(platform, random)
    samples = importance_samples(one.likelihood, one.optimum, one.covariance, random, _N_DRAWS)
    optimum = dict(zip(POSE_COLUMNS, one.optimum, strict=True))
    optima = pd.DataFrame([{"stage": _STAGE, "n_observations": len(one.likelihood.survey.number), **optimum}])
    draws: Floats = samples.resample(random, _N_DRAWS)
    errors = truth_error_table(optima, {_STAGE: draws}, one.true_pose)
    return errors.set_index("quantity")["error_in_sigmas"]


def quantile_table(errors: pd.DataFrame) -> pd.DataFrame:
    """Quantiles of the errors, and centre and half-width of the interval between the outer two; a row a quantity."""
    table = errors.quantile(QUANTILES).T
    low, high = table[QUANTILES[0]], table[QUANTILES[-1]]
    return table.assign(expected=(low + high) / 2, tolerance=(high - low) / 2)


def main() -> None:
    """Print the intervals of each simulated platform that is held against numbers of the paper."""
    parser = argparse.ArgumentParser(prog="python -m linepose.paper.expected_errors", description=__doc__)
    parser.add_argument("--surveys", type=int, default=1000, help="simulated surveys of each platform")
    parser.add_argument("--seed", type=int, default=2017, help="seed that every random number follows from")
    parser.add_argument("--project", type=Path, default=Path(), help="folder of config/")
    options = parser.parse_args()
    config = options.project / "config"
    for name in load_declarations(config / "paper" / "regression.yaml").platforms:
        platform = load_platform(config / "platforms", name)
        if platform.simulation is not None:
            print(f"{name}: error against truth in sigmas, {options.surveys} surveys, seed {options.seed}")
            table = quantile_table(errors_in_sigmas(platform, options.surveys, options.seed))
            print(table.to_string(float_format=lambda value: f"{value:.2f}"), end="\n\n", flush=True)


if __name__ == "__main__":
    main()
