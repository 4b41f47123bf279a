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

from linepose.estimation.noise_models import PUBLISHED
from linepose.estimation.optimise import Search
from linepose.experiments.estimate import estimate_by_curvature, estimate_fields
from linepose.experiments.experiment import Experiment, Section
from linepose.experiments.inputs import Inputs, log_rows
from linepose.geometry.camera import Camera
from linepose.geometry.distance import euclidean_distance_m, geodesic_angle_rad, mahalanobis_distance
from linepose.likelihood.base import Likelihood
from linepose.likelihood.pixels import PixelLikelihood
from linepose.pipeline.platform_likelihood import platform_likelihood
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


def _run(inputs: Inputs) -> dict[str, pd.DataFrame]:
    platform, nominal = inputs.platform, inputs.data.accepted
    changes: dict[str, Likelihood] = {}
    if platform.noise_model == PUBLISHED.name:  # the other models' residuals are in pixels
        changes["residual in pixels"] = PixelLikelihood(nominal)
    for name, camera in camera_changes(platform.intrinsics()).items():
        changes[name] = platform_likelihood(platform, nominal.survey, camera)
    changes |= {name: other.accepted for name, other in inputs.other_data.items()}
    table = sensitivity(nominal, changes, platform.start_pose(), inputs.search)
    log_rows(_logger, "%s: %.2f sigmas", table, ("change", "mahalanobis"))
    return {"sensitivity": table}


EXPERIMENT: Final = Experiment(
    name="sensitivity",
    title="Sensitivity to other choices",
    outputs={"sensitivity": SENSITIVITY},
    run=_run,
    section=SECTION,
    needs=("observations", "outliers"),
    study=("search",),
    compares=True,
)
