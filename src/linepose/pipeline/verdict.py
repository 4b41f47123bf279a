"""The verdict on a calibration: all checks, and the sentence that sums them up."""

from dataclasses import dataclass

from linepose.pipeline.adjusted_checks import camera, curvature, doubtful_views, draws, error_size, known_target, times
from linepose.pipeline.checks import (
    Check,
    Evidence,
    Level,
    angular_diversity,
    chain_length,
    converged,
    hand_measurement,
    independence,
    repeatability,
    residual_size,
    truth,
    worst_observation,
)
from linepose.pipeline.navigation_checks import reported_sigmas


@dataclass(frozen=True)
class Verdict:
    """All checks, and the sentence that sums them up."""

    level: Level
    sentence: str
    checks: tuple[Check, ...]

    @property
    def reasons(self) -> tuple[Check, ...]:
        """The checks that ask for something, the worst first."""
        return tuple(sorted((check for check in self.checks if check.level), key=lambda check: -check.level))


def judge(evidence: Evidence) -> Verdict:
    """The verdict on one platform, what matters most to who will use the pose first."""
    checks = [converged(evidence)]
    if evidence.sigma_factor is not None:
        checks.append(repeatability(evidence.sigma_factor))
    if evidence.adjusted is None:
        checks += [
            worst_observation(evidence),
            angular_diversity(evidence),
            residual_size(evidence),
            independence(evidence),
            hand_measurement(evidence),
            chain_length(evidence),
        ]
    else:
        adjusted = evidence.adjusted
        checks += [doubtful_views(evidence, adjusted), angular_diversity(evidence), curvature(adjusted)]
        checks += [hand_measurement(evidence), camera(adjusted), error_size(adjusted), draws(adjusted), times(adjusted)]
        if adjusted.target_misfit is not None:
            checks.append(known_target(adjusted.target_misfit))
    checks.append(reported_sigmas(evidence))
    if evidence.truth_sigmas is not None:
        checks.append(truth(evidence, evidence.truth_sigmas))
    level = max(check.level for check in checks)
    count = f"{sum(check.level == level for check in checks)} of {len(checks)} checks"
    sentence = {
        Level.GOOD: "Use this pose: every check passed.",
        Level.CARE: f"Use this pose with care: look at {count}.",
        Level.BAD: f"Do not use this pose yet: {count} failed.",
    }[level]
    return Verdict(level, sentence, tuple(checks))
