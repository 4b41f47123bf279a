"""Sensitivity: the pose and its sigma when one choice of the calibration is changed.

The sigmas are the curvature's: a sampled one carries the chain's noise, which is larger than most of the changes.
"""

from collections.abc import Mapping

import pandas as pd
from numpy.typing import ArrayLike

from linepose.estimation.optimise import Search
from linepose.experiments.estimate import estimate_by_curvature
from linepose.geometry.camera import Camera
from linepose.geometry.distance import euclidean_distance_m, geodesic_angle_rad, mahalanobis_distance
from linepose.likelihood.base import Likelihood

NOMINAL = "nominal"


def camera_changes(camera: Camera) -> dict[str, Camera]:
    """The camera with focal length and principal point one standard deviation up and down, by name."""
    sigmas = camera.sigmas
    return {
        "focal length + 1 sigma": camera.replaced(focal_length_m=camera.focal_length_m + sigmas.focal_length_m),
        "focal length - 1 sigma": camera.replaced(focal_length_m=camera.focal_length_m - sigmas.focal_length_m),
        "principal point + 1 sigma": camera.replaced(
            principal_point_px=camera.principal_point_px + sigmas.principal_point_px
        ),
        "principal point - 1 sigma": camera.replaced(
            principal_point_px=camera.principal_point_px - sigmas.principal_point_px
        ),
    }


def sensitivity(
    nominal: Likelihood,
    changes: Mapping[str, Likelihood],
    start: ArrayLike,
    search: Search | None = None,
) -> pd.DataFrame:
    """One row a change, the unchanged first: pose, sigma, and how far it moved from the unchanged; start pose (6,)."""
    reference = estimate_by_curvature(nominal, start, search)
    rows = []
    for name, likelihood in {NOMINAL: nominal, **changes}.items():
        changed = reference if name == NOMINAL else estimate_by_curvature(likelihood, start, search)
        rows.append(
            {
                "change": name,
                **changed.row(),
                "distance_m": float(euclidean_distance_m(changed.pose, reference.pose)),
                "angle_rad": float(geodesic_angle_rad(changed.pose, reference.pose)),
                "mahalanobis": float(mahalanobis_distance(changed.pose, reference.pose, reference.covariance)),
            }
        )
    return pd.DataFrame(rows)
