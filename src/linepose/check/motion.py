"""Whether the body moves the way it points, and at what speed: wrong axes and units show without any camera."""

from typing import Final

import numpy as np

from linepose.arrays import Floats
from linepose.check.finding import Finding, ok, warning
from linepose.survey.observations import Survey

_SHORTEST_M: Final = 0.1  # of a view's way, below which it says nothing of the heading
_FASTEST_M_S: Final = 15.0
_OFF_DEG: Final = 20.0
_SUBJECT: Final = "body pose"
OFF_HEADING: Final = (
    "unless it drives sideways: yaw counts from north to the east, in radians; check that positions are north, east, "
    "down and angles roll, pitch, yaw (not east, north, up)"
)


def motion_findings(survey: Survey) -> list[Finding]:
    """Findings on speed, and on heading against the direction of travel."""
    way, seconds, yaw = _ways(survey)
    findings = []
    timed = seconds > 0
    if timed.any():
        speed = np.linalg.norm(way[timed], axis=1) / seconds[timed]
        if np.median(speed) > _FASTEST_M_S:
            found = f"the body moves at {np.median(speed):.3g} m/s while it passes the pattern"
            findings.append(warning(_SUBJECT, found, "check the units of time (us) and position (m)"))
        else:
            findings.append(ok(_SUBJECT, f"the body passes the pattern at {np.median(speed):.2g} m/s"))
    moved = np.linalg.norm(way, axis=1) > _SHORTEST_M
    if moved.sum() >= 2:
        off_deg = off_heading_deg(way[moved], yaw[moved])
        if abs(off_deg) > _OFF_DEG:
            findings.append(warning(_SUBJECT, f"the body moves {off_deg:.0f} deg off its heading", OFF_HEADING))
        else:
            findings.append(ok(_SUBJECT, f"the body moves the way it points, within {abs(off_deg):.1f} deg"))
    return findings


def off_heading_deg(way_m: Floats, yaw_rad: Floats) -> float:
    """Typical angle from the heading (K,) to the direction of ways (K, 2) north, east, driven forward or back.

    -90 to 90 deg: the mean of doubled angles, for which forward and reverse are the same; ways that do not follow the
    heading at all give the largest deviation.
    """
    off = 2 * (np.arctan2(way_m[:, 1], way_m[:, 0]) - yaw_rad)
    mean = np.mean(np.exp(1j * off))
    typical = float(np.degrees(np.angle(mean)) / 2)
    scatter = float(np.degrees(np.sqrt(np.mean(np.angle(np.exp(1j * off) / np.exp(1j * np.angle(mean))) ** 2))) / 2)
    return typical if scatter <= _OFF_DEG else max(typical, scatter, key=abs)


def _ways(survey: Survey) -> tuple[Floats, Floats, Floats]:
    """Way (N, 2) north, east, time (N,) and middle heading (N,) from the first to the last point of each view."""
    way, seconds, yaw = np.zeros((survey.n_observations, 2)), np.zeros(survey.n_observations), []
    for row in range(survey.n_observations):
        seen = np.flatnonzero(np.isfinite(survey.u_px[row]))
        order = seen[np.argsort(survey.time_us[row, seen], kind="stable")]
        way[row] = survey.position_m[row, order[-1], :2] - survey.position_m[row, order[0], :2]
        seconds[row] = (survey.time_us[row, order[-1]] - survey.time_us[row, order[0]]) / 1e6
        yaw.append(float(np.angle(np.mean(np.exp(1j * survey.euler_rad[row, seen, 2])))))
    return way, seconds, np.array(yaw)
