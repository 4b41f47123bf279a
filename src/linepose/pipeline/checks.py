"""The checks of a calibration: each a reason to trust or doubt it as one sentence, and what to do about it.

Only decisions stand here; the numbers they rest on come in as `Evidence`.
"""

from dataclasses import dataclass
from enum import IntEnum
from math import isnan
from typing import Final

from linepose.estimation.diagnostics import MAXIMUM_R_HAT, MINIMUM_STEPS_PER_TIME
from linepose.estimation.noise_models import DEFAULT

CONSISTENT: Final = (0.5, 1.5)  # reduced chi-square of errors that are about as large as their sigmas
MAX_INTRACLASS_CORRELATION: Final = (
    0.3  # share of the variance that a view's points have in common, above which they are not apart
)
SIGMA_FACTOR: Final = 1.25  # by which splits may ask for larger sigmas
TILT_SPREAD_DEG: Final = 2.0  # the paper's subsets of high and low diversity (Table 4) have 2.7 and 1.4
NEAR_THRESHOLD: Final = 0.9  # share of the outlier threshold from which the worst observation is worth a look
HAND_SIGMAS: Final = 3.0  # from the hand measurement, in sigmas of the difference
CONTRADICTION_SIGMAS: Final = 6.0  # from which on a hand measurement that counts is wrong, and the pose with it
TRUTH_SIGMAS: Final = 3.0
CAMERA_SIGMAS: Final = 3.0  # of an intrinsic from the platform's file


class Level(IntEnum):
    """How a check ended; the larger the worse."""

    GOOD = 0
    CARE = 1
    BAD = 2


@dataclass(frozen=True)
class DoubtfulView:
    """A view that the adjustment gave little weight, and what its errors look like."""

    observation: int
    weight: float
    fault: str


@dataclass(frozen=True)
class LostMeasurement:
    """A measurement that has lost its weight while its observation as a whole has not: its observation and point."""

    observation: int
    point: str
    weight: float


@dataclass(frozen=True)
class AdjustedEvidence:
    """What the verdict on an adjustment rests on beside the rest.

    least_eigenvalue: of the curvature in units of the normal equations, NaN where it could not be had; effective_draws,
    pareto_shape: of the levels; drift_known: whether there are times, without which drift is not allowed for;
    navigation_error: of the whole navigation error, in what is reported; lost: single measurements that have lost
    their weight, the lightest first, and n_measurements: of how many they are; camera_sigmas: of the intrinsic
    that lies farthest from the platform's file, camera_parameter, None where the survey tests none, NaN where it cannot
    be had; camera_held: intrinsics whose sigmas in the file are so small that the survey's part cannot be computed.
    """

    least_eigenvalue: float
    effective_draws: float
    pareto_shape: float
    doubtful: tuple[DoubtfulView, ...]
    drift_known: bool = True
    navigation_error: float = 1.0
    lost: tuple[LostMeasurement, ...] = ()
    n_measurements: int = 0
    target_misfit: float | None = None
    camera_sigmas: float | None = None
    camera_parameter: str = ""
    camera_held: tuple[str, ...] = ()


@dataclass(frozen=True)
class Evidence:
    """What the verdict rests on, all of the accepted observations.

    `sigma_factor`, `influence` (sigmas that the pose moves without the most influential observation) and
    `truth_sigmas` (largest error of a parameter, in its sigmas) are None where nothing is known of them. `adjusted` is
    None for a noise model that removes observations. `hand_counts`: whether the hand measurement is a prior that
    `hand_sigmas` is counted from without; `undecided`, `decided_by_both`: numbers that it knows better than the data,
    or that neither decides alone; `exact_axes`: of the body pose, reported with next to no sigma.
    """

    n_observations: int
    n_accepted: int
    converged: bool
    n_steps: int
    autocorrelation_time: float
    split_r_hat: float
    reduced_chi_square: float
    intraclass_correlation: float
    tilt_spread_deg: float
    worst_observation: int
    worst_error_px: float
    threshold_px: float
    hand_sigmas: float
    hand_parameter: str
    undecided: tuple[str, ...]
    noise_model: str
    sigma_factor: float | None = None
    most_influential: int | None = None
    influence: float | None = None
    adjusted: "AdjustedEvidence | None" = None
    truth_sigmas: float | None = None
    truth_parameter: str = ""
    hand_counts: bool = False
    exact_axes: tuple[str, ...] = ()
    decided_by_both: tuple[str, ...] = ()


@dataclass(frozen=True)
class Check:
    """One reason: its name, how it ended, what was found, what to do, and the finding in a few words.

    `advice` and `brief` are empty where there is nothing to do.
    """

    name: str
    level: Level
    found: str
    advice: str = ""
    brief: str = ""


def converged(evidence: Evidence) -> Check:
    """Whether the search ended at a minimum."""
    if evidence.converged:
        return Check("Convergence", Level.GOOD, "The search ended at a minimum.")
    return Check(
        "Convergence",
        Level.BAD,
        "The search stopped before it reached a minimum.",
        "Measure the start pose by hand again, or check the conventions of the navigation's angles.",
        "the search stopped before it reached a minimum",
    )


def chain_length(evidence: Evidence) -> Check:
    """Whether the chain is long enough for its sigmas."""
    needed = int(-(-MINIMUM_STEPS_PER_TIME * evidence.autocorrelation_time // 1))
    found = (
        f"{evidence.n_steps} steps for an autocorrelation time of {evidence.autocorrelation_time:.0f}, split R-hat "
        f"{evidence.split_r_hat:.2f}."
    )
    if evidence.n_steps >= needed and evidence.split_r_hat <= MAXIMUM_R_HAT:
        return Check("Chain length", Level.GOOD, found)
    steps = max(needed, 10 * evidence.n_steps) if evidence.split_r_hat > MAXIMUM_R_HAT else needed
    return Check(
        "Chain length",
        Level.CARE,
        f"Chain too short: {found} The rule is {MINIMUM_STEPS_PER_TIME} autocorrelation times and an R-hat below "
        f"{MAXIMUM_R_HAT}. The pose is not affected, its sampled sigmas are rough.",
        f"Set sampling.n_steps to {steps} or more and run again.",
        f"the chain has {evidence.n_steps} steps where {steps} are needed",
    )


def residual_size(evidence: Evidence) -> Check:
    """Whether errors are as large as their sigmas say."""
    low, high = CONSISTENT
    found = f"Reduced chi-square {evidence.reduced_chi_square:.2f}, expected near 1."
    if evidence.reduced_chi_square > high:
        return Check(
            "Size of the residuals",
            Level.BAD if evidence.reduced_chi_square > high**2 else Level.CARE,
            f"{found} The errors are larger than the stated sigmas explain.",
            "Check the navigation's covariances and the camera's sigmas, or lower outliers.threshold_px.",
            f"errors are larger than their sigmas (reduced chi-square {evidence.reduced_chi_square:.2f})",
        )
    if evidence.reduced_chi_square < low:
        return Check(
            "Size of the residuals",
            Level.CARE,
            f"{found} The errors are smaller than the stated sigmas: either the navigation's sigmas are too large, or "
            "its errors are common to many points and do not show as scatter.",
            "Check which columns hold the navigation's covariances, and in which units.",
            f"errors are smaller than their sigmas (reduced chi-square {evidence.reduced_chi_square:.2f})",
        )
    return Check("Size of the residuals", Level.GOOD, found)


def independence(evidence: Evidence) -> Check:
    """Whether the points of a view err independently, where the noise model takes them to."""
    if isnan(evidence.intraclass_correlation):
        return Check("Independence within a view", Level.GOOD, "Not known: it takes two observations of two points.")
    share = 100 * max(evidence.intraclass_correlation, 0.0)
    found = f"{share:.0f} % of the residuals' variance is common to all points of a view."
    if evidence.intraclass_correlation <= MAX_INTRACLASS_CORRELATION:
        return Check("Independence within a view", Level.GOOD, found)
    if evidence.sigma_factor is not None and evidence.sigma_factor <= SIGMA_FACTOR:
        return Check(
            "Independence within a view",
            Level.GOOD,
            f"{found} The published noise model takes points as independent; its sigmas are wide enough here all the "
            "same, for halves of the observations agree as they promise.",
        )
    return Check(
        "Independence within a view",
        Level.CARE,
        f"{found} The published noise model takes points as independent, so its sigmas come out too small.",
        f"Set noise_model: {DEFAULT.name} in the platform's file, which allows for it; more observations help, more "
        "points in a view do not.",
        f"{share:.0f} % of the errors' variance is common to a whole view",
    )


def angular_diversity(evidence: Evidence) -> Check:
    """Whether the body was tilted differently enough from view to view.

    An adjustment's sigmas say what too little of it costs, so that it is enough that the data say something of all.
    """
    found = f"Roll and pitch spread by {evidence.tilt_spread_deg:.1f}° (RMS) over the accepted observations."
    if evidence.undecided:
        return Check(
            "Angular diversity",
            Level.CARE,
            f"{found} The data say no more than the hand measurement about {', '.join(evidence.undecided)}.",
            "Add observations with the vehicle rolled or pitched by 4° or more, and from other sides; from the air, "
            "fly a cross strip and strips at a second height.",
            f"the data do not decide {', '.join(evidence.undecided)}",
        )
    if evidence.adjusted is not None:
        both = ", ".join(evidence.decided_by_both)
        found += (
            f" Data and hand measurement decide {both} together, the data all else."
            if both
            else " The data say more than the hand measurement about every number."
        )
        return Check("Angular diversity", Level.GOOD, found)
    if evidence.tilt_spread_deg >= TILT_SPREAD_DEG:
        return Check("Angular diversity", Level.GOOD, found)
    return Check(
        "Angular diversity",
        Level.CARE,
        f"{found} Below {TILT_SPREAD_DEG:g}° height and sideways position are hard to tell from the angles.",
        "Add observations with the vehicle rolled or pitched by 4° or more.",
        f"roll and pitch spread by {evidence.tilt_spread_deg:.1f}° only",
    )


def worst_observation(evidence: Evidence) -> Check:
    """Whether an accepted observation is close to being an outlier, or decides the pose alone."""
    found = (
        f"{evidence.n_accepted} of {evidence.n_observations} observations accepted. The worst of them is observation "
        f"{evidence.worst_observation} with a mean error of {evidence.worst_error_px:.1f} px, where "
        f"{evidence.threshold_px:g} px is the limit."
    )
    if evidence.influence is not None:
        found += (
            f" Observation {evidence.most_influential} has the most influence: without it the pose moves by "
            f"{evidence.influence:.1f} sigmas."
        )
    advice, brief = [], []
    if evidence.worst_error_px > NEAR_THRESHOLD * evidence.threshold_px:
        advice.append(
            f"Check the labels and the navigation of observation {evidence.worst_observation}, or run without it."
        )
        brief.append(
            f"observation {evidence.worst_observation} is at {evidence.worst_error_px:.1f} of "
            f"{evidence.threshold_px:g} px"
        )
    if evidence.influence is not None and evidence.influence > 1.0:
        advice.append(f"Repeat the view of observation {evidence.most_influential}, so that it does not stand alone.")
        brief.append(f"observation {evidence.most_influential} alone moves the pose by {evidence.influence:.1f} sigmas")
    return Check("Worst observation", Level.CARE if advice else Level.GOOD, found, " ".join(advice), ", ".join(brief))


def hand_measurement(evidence: Evidence) -> Check:
    """Whether the result agrees with the tape measure."""
    found = (
        f"The pose is at most {evidence.hand_sigmas:.1f} sigmas of the difference away from the hand measurement "
        f"({evidence.hand_parameter})."
    )
    if evidence.hand_sigmas <= HAND_SIGMAS:
        return Check("Hand measurement", Level.GOOD, found)
    brief = f"{evidence.hand_parameter} is {evidence.hand_sigmas:.1f} sigmas from the hand measurement"
    if evidence.hand_counts and evidence.hand_sigmas > CONTRADICTION_SIGMAS:
        return Check(
            "Hand measurement",
            Level.BAD,
            f"{found} Data and hand measurement contradict each other, and the latter, which counts as a prior, pulls "
            "the pose off what the data say.",
            "Measure again, or check the conventions of axes and angles, and correct hand_measured; if the tape cannot "
            "be right, set prior: none, so that the data decide alone.",
            brief,
        )
    return Check(
        "Hand measurement",
        Level.CARE,
        found,
        "Measure again; if the tape is right, check the conventions of axes and angles.",
        brief,
    )


def repeatability(factor: float) -> Check:
    """Whether halves of the observations agree as their sigmas say."""
    found = f"Random halves of the observations lie {factor:.2f} times as far apart as stated."
    if factor <= SIGMA_FACTOR:
        return Check("Repeatability", Level.GOOD, found)
    return Check(
        "Repeatability",
        Level.CARE,
        f"Random halves of the observations lie {factor:.2f} times as far apart as stated.",
        f"Multiply the sigmas by {factor:.1f} before you rely on them.",
        f"halves of the observations differ {factor:.1f} times as much as the sigmas promise",
    )


def truth(evidence: Evidence, sigmas: float) -> Check:
    """Whether the estimate is where the simulation put the camera."""
    found = f"The largest error against the truth is {sigmas:.1f} sigmas ({evidence.truth_parameter})."
    if sigmas <= TRUTH_SIGMAS:
        return Check("Truth", Level.GOOD, found)
    return Check(
        "Truth",
        Level.CARE,
        f"{found} The sigmas are too small for the errors that were simulated.",
        "Multiply the sigmas by the factor of the check on repeatability before you rely on them."
        if evidence.sigma_factor is not None
        else "Set experiments.repeatability in the platform's file, which finds by how much.",
        f"{evidence.truth_parameter} is {sigmas:.1f} sigmas from the truth",
    )
