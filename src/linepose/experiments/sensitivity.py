"""Sensitivity: the pose and its sigma when one choice of the calibration is changed.

The sigmas are the curvature's: a sampled one carries the chain's noise, which is larger than most of the changes.
"""

import logging
from collections.abc import Mapping
from typing import Final

import pandas as pd
import pyarrow as pa
from numpy.typing import ArrayLike
from pydantic import Field

from linepose.estimation.estimator import Estimator
from linepose.experiments.estimate import estimate_fields, estimate_row
from linepose.experiments.experiment import Experiment
from linepose.experiments.inputs import Inputs, log_rows
from linepose.experiments.section import Section
from linepose.geometry.camera import Camera
from linepose.geometry.distance import euclidean_distance_m, geodesic_angle_rad, mahalanobis_distance
from linepose.settings import Settings
from linepose.tables import floats, optional_floats, texts

_logger = logging.getLogger(__name__)
NOMINAL = "nominal"

SENSITIVITY: Final = pa.schema(
    [*texts("change"), *estimate_fields(), *floats("distance_m", "angle_rad"), *optional_floats("mahalanobis")]
)


class SensitivitySettings(Settings):
    """The pose under other choices."""

    platforms: list[str] = Field(
        [],
        description="Platform files of the same camera with other data choices (covariance columns, views), whose pose "
        "is held against this one; they are run as far as the outlier removal.",
    )


SECTION: Final = Section("sensitivity", SensitivitySettings, SensitivitySettings(), "Other choices.")


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


def sensitivity(nominal: Estimator, changes: Mapping[str, Estimator], start: ArrayLike) -> pd.DataFrame:
    """One row a change, the unchanged first: pose, sigma, and how far it moved from the unchanged; start pose (6,)."""
    reference = nominal.estimate(start)
    rows = []
    for name, estimator in {NOMINAL: nominal, **changes}.items():
        changed = reference if name == NOMINAL else estimator.estimate(start)
        rows.append(
            {
                "change": name,
                **estimate_row(changed),
                "distance_m": float(euclidean_distance_m(changed.pose, reference.pose)),
                "angle_rad": float(geodesic_angle_rad(changed.pose, reference.pose)),
                "mahalanobis": float(mahalanobis_distance(changed.pose, reference.pose, reference.covariance)),
            }
        )
    return pd.DataFrame(rows)


def _run(inputs: Inputs) -> dict[str, pd.DataFrame]:
    platform, nominal = inputs.platform, inputs.data.accepted
    changes = dict(nominal.variations())
    for name, camera in camera_changes(platform.intrinsics()).items():
        changes[name] = inputs.estimator_with(camera)
    changes |= {name: other.accepted for name, other in inputs.other_data.items()}
    table = sensitivity(nominal, changes, platform.start_pose())
    log_rows(_logger, "%s: %.2f sigmas", table, ("change", "mahalanobis"))
    return {"sensitivity": table}


EXPERIMENT: Final = Experiment(
    name="sensitivity",
    title="Sensitivity to other choices",
    outputs={"sensitivity": SENSITIVITY},
    run=_run,
    section=SECTION,
    needs=("observations", "outliers"),
    compares=True,
)
