"""What the report says of one platform, gathered from its results."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np
import pandas as pd
import pyarrow as pa

from linepose.arrays import Floats
from linepose.estimation.outliers import OUTLIERS
from linepose.experiments.leave_one_out import LEAVE_ONE_OUT
from linepose.experiments.splits import SPLITS, sigma_factor
from linepose.output.figures.checks import accepted_rows, stage_rows, usable_chain
from linepose.output.figures.results import PlatformResults
from linepose.pipeline.pose_tables import (
    PoseNumber,
    PoseWithCovariance,
    euler_numbers,
    quaternion,
    rotation_vector_numbers,
)
from linepose.pipeline.residual_tables import RESIDUALS, intraclass_correlation
from linepose.pipeline.stages import DIAGNOSTICS, OPTIMA
from linepose.pipeline.verdict import Evidence, Verdict, judge
from linepose.survey.body_angles import body_angles_rad
from linepose.survey.observations import Survey


class Results(Protocol):
    """The results of one platform, from files or from memory, as the verdict asks for them."""

    @property
    def name(self) -> str:
        """Of the platform, for messages."""

    @property
    def threshold_px(self) -> float:
        """Mean error (px) below which an observation is accepted."""

    @property
    def noise_model(self) -> str:
        """Name of the noise model."""

    def table(self, name: str, schema: pa.Schema) -> pd.DataFrame:
        """A result by its name."""

    def has(self, name: str) -> bool:
        """Whether this result was made."""

    def survey(self) -> Survey:
        """All observations."""

    def accepted(self) -> list[int]:
        """Numbers of the accepted observations."""

    def samples(self) -> pd.DataFrame:
        """The chain of the accepted observations."""


@dataclass(frozen=True)
class PlatformSummary:
    """One platform's part of the report."""

    name: str
    description: str
    noise_model: str
    verdict: Verdict
    rotation_vector: list[PoseNumber]
    euler: list[PoseNumber]
    quaternion: Floats
    n_observations: int
    n_accepted: int
    neg_log_likelihood: float
    simulated: bool

    @property
    def plain_pose(self) -> list[PoseNumber]:
        """Position and Euler angles, or the rotation vector where they do not tell the rotation."""
        return self.rotation_vector[:3] + (self.euler or self.rotation_vector[3:])


def summarise(results: PlatformResults) -> PlatformSummary:
    """The summary of a platform whose stages have all been run."""
    covariance = np.cov(usable_chain(results.samples()), rowvar=False)
    estimate = PoseWithCovariance(results.pose("inliers"), covariance)
    hand = PoseWithCovariance(results.platform.start_pose(), results.platform.start_covariance())
    numbers = rotation_vector_numbers(estimate, hand, results.true_pose)
    evidence = gather_evidence(results, numbers)
    optimum = _accepted_stage(results, "optima", OPTIMA).iloc[0]
    return PlatformSummary(
        name=results.name,
        description=results.platform.description or results.name,
        noise_model=results.platform.noise_model,
        verdict=judge(evidence),
        rotation_vector=numbers,
        euler=euler_numbers(estimate, hand, results.true_pose),
        quaternion=quaternion(estimate.pose),
        n_observations=evidence.n_observations,
        n_accepted=evidence.n_accepted,
        neg_log_likelihood=float(optimum["neg_log_likelihood"]),
        simulated=results.true_pose is not None,
    )


def gather_evidence(results: Results, numbers: list[PoseNumber]) -> Evidence:
    """The numbers that the verdict rests on; `numbers` are the pose's six."""
    optimum = _accepted_stage(results, "optima", OPTIMA).iloc[0]
    chain = _accepted_stage(results, "diagnostics", DIAGNOSTICS)
    residuals = _accepted_stage(results, "residuals", RESIDUALS)
    outliers = results.table("outliers", OUTLIERS)
    accepted = accepted_rows(outliers)
    worst = accepted.loc[accepted["error_px"].idxmax()]
    farthest = max(numbers, key=lambda number: abs(number.difference_sigmas))
    wrong = max(numbers, key=lambda number: abs(number.error_sigmas or 0.0))
    most_influential, influence = _influence(results)
    return Evidence(
        n_observations=int(outliers["n_observations"].max()),
        n_accepted=len(accepted),
        converged=bool(optimum["converged"]),
        n_steps=int(results.samples()["step"].max()) + 1,
        autocorrelation_time=float(chain["autocorrelation_time"].max()),
        split_r_hat=float(chain["split_r_hat"].max()),
        reduced_chi_square=float(optimum["reduced_chi_square"]),
        intraclass_correlation=max(
            intraclass_correlation(residuals, column) for column in ("error_u_px", "error_v_px")
        ),
        tilt_spread_deg=tilt_spread_deg(results.survey().select(results.accepted())),
        worst_observation=int(worst["observation"]),
        worst_error_px=float(worst["error_px"]),
        threshold_px=results.threshold_px,
        hand_sigmas=abs(farthest.difference_sigmas),
        hand_parameter=farthest.name,
        undecided=tuple(number.name for number in numbers if number.sigma >= number.hand_sigma),
        sigma_factor=_sigma_factor(results),
        most_influential=most_influential,
        influence=influence,
        truth_sigmas=None if wrong.error_sigmas is None else abs(wrong.error_sigmas),
        truth_parameter=wrong.name,
        noise_model=results.noise_model,
    )


def _accepted_stage(results: Results, name: str, schema: pa.Schema) -> pd.DataFrame:
    return stage_rows(results.table(name, schema), "inliers", [], f"{results.name}/{name}.parquet")


def tilt_spread_deg(survey: Survey) -> float:
    """RMS distance of the observations' (roll, pitch) from their mean, in degrees."""
    tilt = np.degrees(body_angles_rad(survey)[:, :2])
    return float(np.sqrt(np.mean(np.sum((tilt - tilt.mean(axis=0)) ** 2, axis=1))))


def _sigma_factor(results: Results) -> float | None:
    if not results.has("splits"):
        return None
    splits = results.table("splits", SPLITS)
    return sigma_factor(splits) if splits["mahalanobis"].notna().any() else None


def _influence(results: Results) -> tuple[int | None, float | None]:
    if not results.has("leave_one_out"):
        return None, None
    table = results.table("leave_one_out", LEAVE_ONE_OUT)
    most = table.loc[table["influence"].idxmax()]
    return int(most["left_out"]), float(most["influence"])
