"""The check of what the navigation reports: a sigma of next to nothing leaves its errors out of those of the pose."""

from typing import Final

from linepose.pipeline.checks import Check, Evidence, Level

EXACT: Final = (1e-4, 1e-4, 1e-4, 1.7e-5, 1.7e-5, 1.7e-5)  # sigmas (m, rad) below which a level cannot make up for it
_POSITION: Final = ("north", "east", "down")
_ATTITUDE: Final = ("roll", "pitch", "yaw")


def reported_sigmas(evidence: Evidence) -> Check:
    """Whether the navigation reports a sigma of each number of the body pose."""
    name, exact = "Reported sigmas", evidence.exact_axes
    if not exact:
        return Check(name, Level.GOOD, "The navigation reports a sigma of position and attitude on every axis.")
    whole = any(set(block) <= set(exact) for block in (_POSITION, _ATTITUDE))
    return Check(
        name,
        Level.BAD if whole else Level.CARE,
        f"The navigation reports {', '.join(exact)} with a sigma below 0.1 mm or 0.001°, as if known exactly: "
        "hardly any error of it is allowed for, and the sigmas of the pose are too small.",
        "Give what the navigation system reports, or the sigmas of its data sheet, and run again.",
        f"the navigation reports {', '.join(exact)} as if known exactly",
    )
