"""Whether the reported covariances can be right: sizes of the sigmas, and which columns look like an attitude."""

from typing import Final

import numpy as np

from linepose.arrays import Floats
from linepose.check.finding import Finding, ok, warning
from linepose.survey.navigation import NavigationCovariances

POSITION_M: Final = (1e-3, 5.0)  # plausible sigmas of a GNSS/INS
ANGLE_DEG: Final = (1e-3, 5.0)
_ALIKE: Final = 3.0  # ratio of the sigmas of roll and pitch, at most
_YAW_WORSE: Final = 1.5  # sigma of yaw over that of roll and pitch, at least, where the heading comes from an IMU
_BLOCKS: Final = ((3, 4, 5), (6, 7, 8), (9, 10, 11))
_SUBJECT: Final = "covariances"


def size_findings(covariances: NavigationCovariances) -> list[Finding]:
    """Median sigmas of position and angles, and whether a GNSS/INS can have them."""
    sigma = covariances.median_sigma()
    position, angle = sigma[:3], np.degrees(sigma[3:])
    told = f"median sigmas {_list(position * 1e3)} mm; roll, pitch, yaw {_list(angle)} deg"
    findings = [ok(_SUBJECT, f"{len(covariances.time_us)} of them, symmetric and positive; {told}")]
    names = ("north", "east", "down", "roll", "pitch", "yaw")
    exact = [name for name, value in zip(names, sigma, strict=True) if value == 0]
    if exact:
        findings.append(
            warning(
                _SUBJECT,
                f"the sigma of {', '.join(exact)} is 0, as if known exactly",
                "fill in what the navigation reports, or its data sheet's value",
            )
        )
    if np.any((position > 0) & ((position < POSITION_M[0]) | (position > POSITION_M[1]))):
        found = f"position sigmas {_list(position)} m, expected {POSITION_M[0] * 1e3:g} mm to {POSITION_M[1]:g} m"
        findings.append(warning(_SUBJECT, found, "check the unit: variances in m2, rows and columns 0-2"))
    if np.any((angle > 0) & ((angle < ANGLE_DEG[0]) | (angle > ANGLE_DEG[1]))):
        degrees = bool(np.all(sigma[3:] >= ANGLE_DEG[0]) and np.all(sigma[3:] <= ANGLE_DEG[1]) and angle.max() > 5.0)
        findings.append(
            warning(
                _SUBJECT,
                f"angle sigmas {_list(angle)} deg, expected {ANGLE_DEG[0]:g} to {ANGLE_DEG[1]:g} deg",
                "they look like deg2: convert them to rad2 (divide by 3283)"
                if degrees
                else "check the unit (variances in rad2) and navigation.covariance_columns",
            )
        )
    return findings


def attitude_findings(sigma: Floats, chosen: tuple[int, ...]) -> list[Finding]:
    """Which block of three columns looks like roll, pitch, yaw, given median sigmas (12,) of a 12x12 covariance.

    Of an INS, roll and pitch are about equally sure and yaw less so; of a velocity, the two horizontal ones are alike
    and down is as good or better.
    """
    like = [block for block in _BLOCKS if _looks_like_attitude(sigma[list(block)])]
    told = ", ".join(
        f"{block[0]}-{block[2]}: {_list(np.degrees(sigma[list(block)]))}"
        for block in _BLOCKS
        if np.any(sigma[list(block)])
    )
    subject = "attitude columns"
    if tuple(chosen) in like or tuple(chosen) not in _BLOCKS:
        return [ok(subject, f"columns {_list(np.array(chosen))} hold roll, pitch, yaw")]
    if like:
        block = like[0]
        return [
            warning(
                subject,
                f"columns {block[0]}-{block[2]} look more like roll, pitch, yaw (yaw least sure) than "
                f"{_list(np.array(chosen))}; median sigmas as degrees: {told}",
                f"look it up in the navigation's manual; if so, set navigation.covariance_columns: {list(block)}",
            )
        ]
    return [ok(subject, f"no three columns look more like roll, pitch, yaw than {_list(np.array(chosen))}")]


def _looks_like_attitude(sigma: Floats) -> bool:
    level, yaw = sigma[:2], sigma[2]
    if np.any(sigma <= 0) or not np.all(np.degrees(sigma) <= ANGLE_DEG[1]):
        return False
    return bool(level.max() <= _ALIKE * level.min() and yaw >= _YAW_WORSE * level.max())


def _list(values: Floats) -> str:
    return ", ".join(f"{value:.3g}" for value in np.asarray(values))
