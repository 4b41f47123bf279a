"""From how many starts outside the paper's triangle a search finds the optimum, on surveys like a simulated platform's.

The simulated platform is one survey, so that a limit on its share cannot be read off it. Here several are drawn: the
same drive, camera and navigation errors, other random numbers, without the observations that carry a planted fault.
`python -m linepose.paper.expected_basin` prints, for each simulated platform of config/paper, the interval in which the
share of one more survey is expected; config/paper/regression.yaml declares it. The grid of starts is that of the field
platform that the simulated one is like, where there is one: the interval is then the field platform's.
"""

import argparse
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from linepose.config.platform import Platform, load_platform
from linepose.estimation.likelihood_estimator import LikelihoodEstimator
from linepose.experiments.basin import SECTION, BasinSettings, Sweep, summarise
from linepose.paper.declarations import load_declarations
from linepose.paper.simulated_estimate import simulated_estimate

QUANTILE: Final = 0.995  # of Student's t, either way
_SEARCH: Final = "powell"  # the search that section 4.7 describes


def shares_outside(
    platform: Platform, grid: BasinSettings, n_surveys: int, n_starts: int, seed: int
) -> "pd.Series[float]":
    """Share of `n_starts` starts outside the triangle that find the optimum; one number a survey.

    The starts are cells of the platform's grid, drawn anew for each survey. Survey k is drawn from `[seed, k]`,
    whatever their number.
    """
    return pd.Series(
        [_share_of_survey(platform, grid, n_starts, np.random.default_rng([seed, k])) for k in range(n_surveys)],
        dtype=float,
    )


def _share_of_survey(platform: Platform, grid: BasinSettings, n_starts: int, random: np.random.Generator) -> float:
    one = simulated_estimate(platform, random)
    outside = [cell for cell in range(grid.n_cells) if not grid.region().holds(*grid.offset(cell))]
    cells = random.choice(outside, n_starts, replace=False)
    estimator = LikelihoodEstimator(one.likelihood)
    sweep = Sweep(estimator, one.optimum, one.covariance, grid, int(random.integers(2**31)), grid.success_threshold)
    rows = sweep.rows(_SEARCH, [int(cell) for cell in cells])
    return float(summarise(rows, grid.region()).set_index("region").loc["outside", "success_rate"])


def interval(shares: ArrayLike, n_starts: int, n_outside: int) -> tuple[float, float]:
    """Centre and half width of what is expected of one more survey with `n_outside` starts.

    The spread of the shares is that from survey to survey and that of `n_starts` starts; the latter's binomial variance
    is exchanged for that of `n_outside`. Where the shares spread less than binomially, none is from survey to survey.
    """
    from scipy.stats import t  # slow to import

    values = np.asarray(shares, dtype=float)
    mean, n = float(values.mean()), len(values)
    binomial = mean * (1 - mean)
    between = max(float(values.var(ddof=1)) - binomial / n_starts, 0.0)
    variance = between + binomial / n_outside + float(values.var(ddof=1)) / n
    return mean, float(t.ppf(QUANTILE, n - 1)) * float(np.sqrt(variance))


def main() -> None:
    """Print the interval of each simulated platform whose basin is held against section 4.7."""
    parser = argparse.ArgumentParser(prog="python -m linepose.paper.expected_basin", description=__doc__)
    parser.add_argument("--surveys", type=int, default=12, help="simulated surveys of each platform")
    parser.add_argument("--starts", type=int, default=40, help="starts of each survey")
    parser.add_argument("--seed", type=int, default=2017, help="seed that every random number follows from")
    parser.add_argument("--project", type=Path, default=Path(), help="folder of config/")
    options = parser.parse_args()
    config = options.project / "config"
    declared = load_declarations(config / "paper" / "regression.yaml").platforms
    for name, numbers in declared.items():
        platform = load_platform(config / "platforms", name)
        swept = next((one for one, of in declared.items() if of == numbers.removesuffix("_simulated")), name)
        grid = SECTION.of(load_platform(config / "platforms", swept))
        if platform.simulation is None or grid is None:
            continue
        shares = shares_outside(platform, grid, options.surveys, options.starts, options.seed)
        n_outside = sum(not grid.region().holds(*grid.offset(cell)) for cell in range(grid.n_cells))
        expected, tolerance = interval(shares, options.starts, n_outside)
        print(f"{name}: {options.surveys} surveys, {options.starts} starts each, seed {options.seed}")
        print(" ".join(f"{share:.2f}" for share in shares))
        print(f"share of {n_outside} starts: expected {expected:.3f}, tolerance {tolerance:.3f}", flush=True)


if __name__ == "__main__":
    main()
