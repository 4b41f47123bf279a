"""What share of the starts outside the paper's triangle finds the optimum, on other starts than the workflow's.

Section 4.7 prints approx. 60 % for its own survey and starts. Here the same grid is swept with other directions: on the
accepted observations of the field data, and, of a simulated platform, on other surveys like it. `python -m
linepose.paper.expected_basin`, after a run, prints for each platform of config/paper that has a basin the interval that
holds 99 % of such shares, one more sweep included; config/paper/regression.yaml declares it.
"""

import argparse
from pathlib import Path

import numpy as np
from scipy.stats import t as student

from linepose.arrays import Floats
from linepose.config.platform import Platform, load_platform
from linepose.estimation.likelihood_estimator import LikelihoodEstimator
from linepose.estimation.optimise import laplace_covariance, minimise
from linepose.estimation.outliers import OUTLIERS, stage_observations
from linepose.experiments.basin import SECTION, BasinSettings, Sweep, summarise
from linepose.likelihood.published import PublishedLikelihood
from linepose.paper.declarations import load_declarations
from linepose.paper.experiment_numbers import SWEEP
from linepose.simulation.survey import faulty_observations, simulate_survey
from linepose.survey.observations import OBSERVATIONS, Survey, survey_from_table
from linepose.tables import read_table

PROBABILITY = 0.99


def share_outside(platform: Platform, survey: Survey, grid: BasinSettings, seed: int) -> float:
    """Share of the starts of one sweep outside the triangle that find the survey's optimum."""
    likelihood, start = PublishedLikelihood(survey, platform.intrinsics()), platform.start_pose()
    found = minimise(likelihood, likelihood.start(start), start)
    covariance = laplace_covariance(likelihood, found.parameters)
    sweep = Sweep(LikelihoodEstimator(likelihood), found.parameters, covariance, grid, seed, grid.success_threshold)
    summary = summarise(sweep.rows(SWEEP, range(grid.n_cells)), grid.region()).set_index("region")
    return float(summary.loc["outside", "success_rate"])


def accepted_survey(platform: Platform, name: str, results: Path, seed: int, k: int) -> Survey:
    """The accepted observations of the field data; of a simulated platform, survey k of a seed without its faults."""
    if platform.simulation is None:
        survey = survey_from_table(read_table(results / name / "observations.parquet", OBSERVATIONS))
        return survey.select(stage_observations(read_table(results / name / "outliers.parquet", OUTLIERS))["inliers"])
    drawn = int(np.random.default_rng([seed, k]).integers(2**63))
    survey, _ = simulate_survey(platform.intrinsics(), platform.simulation, drawn)
    faulty = set(faulty_observations(platform.simulation))
    return survey.select([number for number in survey.number if number not in faulty])


def interval(shares: Floats) -> tuple[float, float]:
    """Centre and half-width of the interval that holds one more share (Student's t) beside these (n,)."""
    quantile = float(student.ppf(0.5 + PROBABILITY / 2, len(shares) - 1))
    return float(np.mean(shares)), quantile * float(np.std(shares, ddof=1)) * float(np.sqrt(1 + 1 / len(shares)))


def main() -> None:
    """Print the interval of each platform with a basin that is held against numbers of the paper."""
    parser = argparse.ArgumentParser(prog="python -m linepose.paper.expected_basin", description=__doc__)
    parser.add_argument("--sweeps", type=int, default=6, help="sweeps of each platform")
    parser.add_argument("--seed", type=int, default=2017, help="seed that every random number follows from")
    parser.add_argument("--project", type=Path, default=Path(), help="folder of config/ and results/")
    options = parser.parse_args()
    config, results = options.project / "config", options.project / "results"
    for name in load_declarations(config / "paper" / "regression.yaml").platforms:
        platform = load_platform(config / "platforms", name)
        grid = SECTION.of(platform)
        if grid is None:
            continue
        shares = [
            share_outside(platform, accepted_survey(platform, name, results, options.seed, k), grid, options.seed + k)
            for k in range(options.sweeps)
        ]
        centre, half_width = interval(np.array(shares))
        found = " ".join(f"{share:.3f}" for share in shares)
        print(f"{name}, section 4.7, success outside: {found}; expected {centre:.3f} +- {half_width:.3f}", flush=True)


if __name__ == "__main__":
    main()
