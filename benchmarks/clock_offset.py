"""Whether the clock offset's sigma is honest: its error in sigmas over simulated surveys with 30 ms planted.

`python benchmarks/clock_offset.py [SURVEYS]` (default 6). The simulated Ladybird's 25 passes without faults, read
through the raw log, under the published noise model: with errors as that model takes them (white, as large as
reported), and with the platform's own, which the points of a view share. Root mean square over the surveys: 1 is
honest, more is a sigma that is too small.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from linepose.config.platform import Platform, load_platform
from linepose.estimation.optimise import laplace_covariance, optimise
from linepose.experiments.jackknife import jackknife_sigma
from linepose.simulation.settings import SimulationSettings
from linepose.simulation.survey import without_faults

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests"))
from unit import clock_survey  # noqa: E402

PLANTED_S, MAXIMUM_S = 0.03, 0.3


def errors_in_sigmas(platform: Platform, settings: SimulationSettings, seed: int) -> tuple[float, float, float]:
    """Error of one survey's offset in sigmas of the curvature and of the jackknife, and the curvature's sigma (s)."""
    survey, log = clock_survey.record(platform.intrinsics(), settings, PLANTED_S, seed)
    likelihood = clock_survey.likelihood(platform.intrinsics(), survey, log, MAXIMUM_S)
    found = optimise(likelihood, platform.start_pose()).parameters
    covariance = laplace_covariance(likelihood, found)
    sigma = float(np.sqrt(covariance[-1, -1]))
    error = float(found[-1]) - PLANTED_S
    return error / sigma, error / float(jackknife_sigma(likelihood, found, covariance)[-1]), sigma


def main() -> None:
    """Both kinds of errors, one line each."""
    n_surveys = int(sys.argv[1]) if len(sys.argv) > 1 else 6
    platform = load_platform(ROOT / "config" / "platforms", "ladybird-sim")
    assert platform.simulation is not None
    own = without_faults(platform.simulation)
    white = replace(own, navigation_error=clock_survey.honest(own).navigation_error)
    for name, settings in {"white, as large as reported": white, "shared by a view's points": own}.items():
        each = np.array([errors_in_sigmas(platform, settings, seed) for seed in range(n_surveys)])
        noise_model, jackknife = np.sqrt(np.mean(each[:, :2] ** 2, axis=0))
        print(
            f"{n_surveys} surveys, errors {name}: {noise_model:.1f} sigmas of the noise model (median sigma "
            f"{1e3 * np.median(each[:, 2]):.0f} ms), {jackknife:.1f} of the jackknife"
        )


if __name__ == "__main__":
    main()
