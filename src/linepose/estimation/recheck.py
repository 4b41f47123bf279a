"""New views against a calibration: the views are adjusted alone, and the two estimates compared.

What both estimates rest on counts once. The hand measurement belongs to the calibration only. The views are adjusted
at the calibration's intrinsics, held, so that an error of these moves both estimates: how each follows is known from
its normal equations. A wide prior about the calibrated pose keeps what few views leave open from running off; its pull
is part of the comparison, so that it takes nothing from a move. The levels of the errors start from the calibration's.

With pose error e of the calibration (covariance S, with the intrinsics' error f, covariance F, S_ef = A F), of views
that would say L alone (their information), prior information 1/P, and V = (L + 1/P)^-1, the difference of the two is

    d = V L (move - e) + B f + V L n,    n of covariance L^-1

with B how the views' estimate follows the intrinsics.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from linepose.adjustment.adjust import adjust
from linepose.adjustment.known_points import KnownPoints
from linepose.adjustment.levels import LEAST, LevelPriors, Levels
from linepose.adjustment.result import Adjustment
from linepose.adjustment.settings import AdjustmentSection, AdjustmentSettings
from linepose.arrays import Floats
from linepose.estimation.pose_change import SCALE, PoseChange, change_of_shrunk
from linepose.geometry.camera import Camera
from linepose.geometry.distance import difference_covariance, pose_difference
from linepose.survey.observations import Survey

_HELD: Final = 1e-3  # of the sigmas of the intrinsics, while the views are adjusted
_TWO_SIDED_95: Final = 2 * 1.959963984540054
_ANOTHER_DAY: Final = 0.3  # by which the logarithm of a level differs from one survey to the next


@dataclass(frozen=True, eq=False)
class Rechecked:
    """The change, and the adjustment of the views on which it rests."""

    change: PoseChange
    views: Adjustment


def recheck(
    calibrated: Adjustment,
    survey: Survey,
    camera: Camera,
    section: AdjustmentSection,
    known_points: KnownPoints | None = None,
    seed: int = 0,
) -> Rechecked:
    """How far the pose has moved from a calibration to the views of a survey.

    Raises InputError and EstimationError as `adjust` does.
    """
    settings = AdjustmentSettings(**dict(section)).replaced(priors=_priors(calibrated, section.priors), seed=seed)
    views = adjust(survey, _held(camera, calibrated), calibrated.pose, np.diag(SCALE**2), settings, known_points)
    return Rechecked(_change(calibrated, views), views)


def _change(calibrated: Adjustment, views: Adjustment) -> PoseChange:
    information = _own_information(difference_covariance(views.pose, views.covariance))
    shrunk = np.linalg.inv(information + np.diag(SCALE**-2))
    seen = shrunk @ information
    by_calibration = np.hstack([-seen, views.pose_by_intrinsics])
    covariance = shrunk @ information @ shrunk + by_calibration @ _with_intrinsics(calibrated) @ by_calibration.T
    return change_of_shrunk(pose_difference(views.pose, calibrated.pose), covariance, seen)


def _own_information(covariance: Floats) -> Floats:
    """Information (6, 6) of the views without the wide prior."""
    values, vectors = np.linalg.eigh(np.linalg.inv(covariance / np.outer(SCALE, SCALE)))
    own = (vectors * np.maximum(values - 1, 0)) @ vectors.T
    return own / np.outer(SCALE, SCALE)


def _with_intrinsics(found: Adjustment) -> Floats:
    """Covariance (6 + I, 6 + I) of an adjustment's step of the pose, and of its intrinsics."""
    size = 6 + len(found.intrinsics_covariance)
    both = np.empty((size, size))
    both[:6, :6] = difference_covariance(found.pose, found.covariance)
    both[6:, 6:] = found.intrinsics_covariance
    both[:6, 6:] = found.pose_by_intrinsics @ found.intrinsics_covariance
    both[6:, :6] = both[:6, 6:].T
    return both


def _held(camera: Camera, calibrated: Adjustment) -> Camera:
    """The camera with the calibration's intrinsics, which stay as they are."""
    pair = {"principal_point_px": calibrated.principal_point_px, "focal_length_m": calibrated.focal_length_m}
    values = pair | calibrated.coefficients
    held = {name: _HELD * getattr(camera.sigmas, name) for name in values}
    return camera.replaced(**values, sigmas=camera.sigmas.replaced(**held))


def _priors(calibrated: Adjustment, priors: LevelPriors) -> LevelPriors:
    """Priors of the levels: as the calibration found them, but for another day; its own where it could not tell."""
    low, high = np.log(np.maximum(calibrated.level_intervals, LEAST)).T
    told = np.isfinite(low + high) & (np.asarray(calibrated.levels) > LEAST)
    sigma = np.hypot((high - low) / _TWO_SIDED_95, _ANOTHER_DAY)
    median = np.where(told, calibrated.levels, priors.median)
    log_sigma = np.where(told, np.minimum(sigma, priors.log_sigma), priors.log_sigma)
    return LevelPriors(median=Levels(*median.tolist()), log_sigma=Levels(*log_sigma.tolist()))
