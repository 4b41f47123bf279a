"""Where the truth lies in what an estimate states: the adjustment's posterior, or the published model's normal one.

The credibility of the smallest region that holds the truth is uniform over surveys where the estimate says the truth
about its uncertainty: a region of 68 % covers the surveys whose credibility is below 0.68. Of the adjustment it is the
share of the samples that lie nearer to their mean than the truth does, in Mahalanobis distance with the samples'
covariance; of the published model, whose posterior is taken as normal about its optimum, chi-square's.
"""

from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from linepose.adjustment import Adjustment, AdjustmentSettings, adjust
from linepose.arrays import Floats
from linepose.estimation.noise_models import noise_model
from linepose.estimation.optimise import laplace_covariance, optimise
from linepose.geometry.camera import Camera
from linepose.geometry.distance import difference_covariance, pose_difference
from linepose.geometry.pose import N_PARAMETERS, POSE_COLUMNS
from linepose.likelihood.base import Likelihood
from linepose.survey.observations import Survey


@dataclass(frozen=True)
class Start:
    """What an estimate starts from: a pose (6,), whether it counts as the hand measurement, the line's period (s)."""

    pose: Floats
    is_prior: bool
    line_period_s: float


@dataclass(frozen=True)
class Judged:
    """An estimate beside the truth.

    pose (6,): with a rotation vector; error, sigma (6,): of position (m) and turn about body axes (rad); credibility:
    of the smallest region that holds the truth; converged; heavy_tails, least_eigenvalue: as the adjustment tells them,
    False and NaN of the published model.
    """

    pose: Floats
    error: Floats
    sigma: Floats
    credibility: float
    converged: bool
    heavy_tails: bool = False
    least_eigenvalue: float = float("nan")


def judged_estimate(noise_model_name: str, survey: Survey, camera: Camera, start: Start, truth: Floats) -> Judged:
    """A noise model's estimate beside the true pose (6,); raises LineposeError where it has none, or no region."""
    make_likelihood = noise_model(noise_model_name).likelihood
    if make_likelihood is not None:
        return judged_optimum(make_likelihood(survey, camera), start.pose, truth)
    settings = AdjustmentSettings(hand_measured_prior=start.is_prior, line_period_s=start.line_period_s)
    return judged(adjust(survey, camera, start.pose, settings=settings), truth)


def judged(found: Adjustment, truth: Floats) -> Judged:
    """An adjustment beside the true pose (6,)."""
    steps = pose_difference(found.samples[list(POSE_COLUMNS)].to_numpy().copy(), found.pose)
    error = pose_difference(found.pose, truth)
    covariance = np.cov(steps.T)
    root, mean = np.linalg.cholesky(covariance), steps.mean(axis=0)
    distance = np.linalg.norm(np.linalg.solve(root, (steps - mean).T), axis=0)
    of_truth = np.linalg.norm(np.linalg.solve(root, pose_difference(truth, found.pose) - mean))
    return Judged(
        pose=found.pose,
        error=error,
        sigma=np.sqrt(np.diag(covariance)),
        credibility=float(np.mean(distance < of_truth)),
        converged=found.diagnostics.converged,
        heavy_tails=found.diagnostics.heavy_tails,
        least_eigenvalue=found.diagnostics.least_eigenvalue,
    )


def judged_optimum(likelihood: Likelihood, start: Floats, truth: Floats) -> Judged:
    """Optimum and curvature of a likelihood of a pose, from a start (6,), beside the truth (6,)."""
    found = optimise(likelihood, start)
    covariance = difference_covariance(found.parameters, laplace_covariance(likelihood, found.parameters))
    error = pose_difference(found.parameters, truth)
    return Judged(
        pose=found.parameters,
        error=error,
        sigma=np.sqrt(np.diag(covariance)),
        credibility=float(chi2.cdf(error @ np.linalg.solve(covariance, error), N_PARAMETERS)),
        converged=found.converged,
    )
