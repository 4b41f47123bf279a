"""Coverage: how often the region that an estimate calls 68 % holds the truth, over many surveys with a known truth.

A cell is a simulated platform under one regime of true noise, estimated by one noise model from the hand-measured pose.
Where the hand measurement counts as a prior it is drawn from that prior about the truth, anew for each survey.
"""

import zlib
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np
import pandas as pd
import pyarrow as pa

from linepose.adjustment.settings import default_hand_covariance
from linepose.arrays import Floats
from linepose.errors import LineposeError
from linepose.estimation.noise_models import noise_model
from linepose.experiments.coverage_estimates import Start, judged_estimate
from linepose.geometry.camera import Camera
from linepose.geometry.pose import N_PARAMETERS, POSE_COLUMNS
from linepose.geometry.rotations import matrix_from_rotation_vector, rotation_vector_from_matrix
from linepose.simulation.noise_levels import NoiseLevels
from linepose.simulation.noisy_survey import draw_survey
from linepose.simulation.settings import SimulationSettings
from linepose.survey.observations import Survey
from linepose.tables import flags, floats, optional_floats, texts, whole_numbers

CELL: Final = ["platform", "regime", "noise_model"]
AXES: Final = ("r_x_m", "r_y_m", "r_z_m", "turn_x_rad", "turn_y_rad", "turn_z_rad")
ERROR_COLUMNS: Final = tuple(f"error_{axis}" for axis in AXES)
ERROR_SIGMA_COLUMNS: Final = tuple(f"sigma_{axis}" for axis in AXES)
NOT_CONVERGED: Final = "the search has not converged"

COVERAGE_SURVEYS: Final = pa.schema(
    [
        *texts(*CELL),
        *whole_numbers("survey"),
        *flags("failed"),
        *texts("reason"),
        *floats("credibility"),
        *optional_floats(*POSE_COLUMNS, *ERROR_COLUMNS, *ERROR_SIGMA_COLUMNS),
        *flags("heavy_tails"),
        *optional_floats("least_eigenvalue"),
    ]
)


@dataclass(frozen=True)
class Cell:
    """One cell of the study: a simulated platform under one regime of noise, estimated by one noise model.

    start_pose (6,): the platform's hand-measured one; `levels` of the true noise; with_faults: whether the
    observations with planted faults stay in; hand_measured_prior: whether the hand measurement is drawn and counts.
    """

    platform: str
    regime: str
    noise_model: str
    camera: Camera
    settings: SimulationSettings
    start_pose: Floats
    levels: NoiseLevels
    seed: int
    with_faults: bool = False
    hand_measured_prior: bool = False

    def __post_init__(self) -> None:
        noise_model(self.noise_model)  # raises for an unknown one

    def survey(self, index: int) -> tuple[Survey, Floats, Floats]:
        """The survey of this number, the same for every noise model; its true and its hand-measured pose (6,)."""
        random = np.random.default_rng([self.seed, *map(_digest, (self.platform, self.regime)), index])
        survey, truth = draw_survey(self.camera, self.settings, self.levels, random, with_faults=self.with_faults)
        return survey, truth, drawn_hand_measurement(truth, random) if self.hand_measured_prior else self.start_pose

    def compile(self) -> None:
        """Estimate one survey, or evaluate its likelihood on one core, so that processes that fork need not compile it.

        What runs on several threads must not have run before a fork.
        """
        make_likelihood = noise_model(self.noise_model).likelihood
        if make_likelihood is None:
            self.row(0)
        else:
            make_likelihood(self.survey(0)[0], self.camera).log_likelihood(self.start_pose)

    def row(self, index: int) -> dict[str, Any]:
        """One row: a survey's estimate beside the truth.

        An estimate that fails has no region and so does not hold the truth: its credibility is 1.
        """
        survey, truth, hand = self.survey(index)
        start = Start(hand, self.hand_measured_prior, 1.0 / self.settings.image.line_rate_hz)
        row = {"platform": self.platform, "regime": self.regime, "noise_model": self.noise_model, "survey": index}
        try:
            found = judged_estimate(self.noise_model, survey, self.camera, start, truth)
        except LineposeError as error:
            return row | failed_estimate(str(error))
        return row | {
            "failed": not found.converged,
            "reason": "" if found.converged else NOT_CONVERGED,
            "credibility": found.credibility if found.converged else 1.0,
            **dict(zip(POSE_COLUMNS, found.pose, strict=True)),
            **dict(zip(ERROR_COLUMNS, found.error, strict=True)),
            **dict(zip(ERROR_SIGMA_COLUMNS, found.sigma, strict=True)),
            "heavy_tails": found.heavy_tails,
            "least_eigenvalue": found.least_eigenvalue,
        }

    def rows(self, surveys: Iterable[int]) -> pd.DataFrame:
        """One row a survey; each depends on its number alone, not on which others are estimated with it."""
        return pd.DataFrame([self.row(index) for index in surveys])


def failed_estimate(reason: str) -> dict[str, Any]:
    """What is told of a survey without an estimate."""
    unknown = [*POSE_COLUMNS, *ERROR_COLUMNS, *ERROR_SIGMA_COLUMNS, "least_eigenvalue"]
    return {
        "failed": True,
        "reason": reason,
        "credibility": 1.0,
        "heavy_tails": False,
        **dict.fromkeys(unknown, float("nan")),
    }


def drawn_hand_measurement(truth: Floats, random: np.random.Generator) -> Floats:
    """A pose (6,) measured by hand: drawn about the true one (6,) with the sigmas that the adjustment has for it."""
    error = np.linalg.cholesky(default_hand_covariance()) @ random.standard_normal(N_PARAMETERS)
    turned = matrix_from_rotation_vector(error[3:]) @ matrix_from_rotation_vector(truth[3:])
    return np.concatenate([truth[:3] + error[:3], rotation_vector_from_matrix(turned)])


def _digest(name: str) -> int:
    return zlib.crc32(name.encode())
