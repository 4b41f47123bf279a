"""Mapping: the observed points projected onto the pattern's plane, and how far the projections scatter (section 3.6).

One plane serves all poses that are compared, that of the calibrated one, so that only the pose moves the projections.
"""

import logging
from collections.abc import Mapping
from typing import Final

import numpy as np
import pandas as pd
import pyarrow as pa
from numpy.typing import ArrayLike
from pydantic import Field, PositiveFloat

from linepose.arrays import Floats
from linepose.experiments.experiment import ESTIMATE, Experiment
from linepose.experiments.inputs import Inputs, log_rows
from linepose.experiments.section import Section
from linepose.geometry import lens
from linepose.geometry.camera import Camera, normalised_from_pixel, rays
from linepose.geometry.plane import Plane, fit_plane, fit_plane_by_height, intersect
from linepose.geometry.pose import N_PARAMETERS
from linepose.geometry.rotations import (
    left_jacobian_so3,
    matrix_from_euler,
    matrix_from_rotation_vector,
    rotation_vector_from_matrix,
    skew,
    small_rotation_by_euler,
)
from linepose.pipeline.residual_tables import ESTIMATED_POINTS
from linepose.settings import Settings
from linepose.survey.observations import POSITION_COLUMNS, POSITION_COVARIANCE_INDICES, Survey
from linepose.tables import floats, optional_floats, point_column, texts, whole_numbers

_logger = logging.getLogger(__name__)
PROJECTED_COLUMNS = ("north_m", "east_m", "down_m")
_AXES = ("north", "east", "down")
PROJECTED_COVARIANCE_COLUMNS = tuple(f"covariance_{_AXES[i]}_{_AXES[j]}_m2" for i, j in POSITION_COVARIANCE_INDICES)

MAPPING: Final = pa.schema(
    [
        *texts("pose"),
        *whole_numbers("observation"),
        point_column(),
        *optional_floats(*PROJECTED_COLUMNS, *PROJECTED_COVARIANCE_COLUMNS),
    ]
)
MAPPING_SUMMARY: Final = pa.schema(
    [
        *texts("pose", "observations"),
        *whole_numbers("n_projected"),
        *optional_floats("spread_mm", "sigma_mm"),
        *floats("normal_north", "normal_east", "normal_down", "plane_rms_mm", "equation_26_angle_rad"),
    ]
)


class MappingSettings(Settings):
    """The observed points projected onto the pattern's plane."""

    perturbation_deg: PositiveFloat = Field(1.0, description="Turn about each body axis of the perturbed pose (deg).")


SECTION: Final = Section("mapping", MappingSettings, MappingSettings(), "Mapping.")


def project(survey: Survey, camera: Camera, pose: ArrayLike, plane: Plane) -> Floats:
    """All observed points (N, M, 3), from the survey origin, projected onto the plane with a camera pose (6,) (Eq. 27).

    NaN where a point was not observed or its ray misses the plane.
    """
    centres, directions = _rays(survey, camera, np.asarray(pose, dtype=float))
    return intersect(plane, centres, directions)


def projection_covariance(
    survey: Survey, camera: Camera, pose: ArrayLike, pose_covariance: ArrayLike, plane: Plane
) -> Floats:
    """Covariance (N, M, 3, 3) of each projected point, to first order (Eq. 28).

    From the camera pose (6,) with covariance (6, 6), the body pose, the pixel (u, v) and the intrinsics. It has
    rank 2 at most: a projected point cannot leave the plane.
    """
    pose = np.asarray(pose, dtype=float)
    centres, directions = _rays(survey, camera, pose)
    reach = -plane.height_m(centres) / (directions @ plane.normal)
    onto = np.eye(3) - np.einsum("nmi,j->nmij", directions, plane.normal) / (directions @ plane.normal)[..., None, None]

    body = matrix_from_euler(np.nan_to_num(survey.euler_rad))
    mount = matrix_from_rotation_vector(pose[3:])
    seen = np.einsum("nmji,nmj->nmi", body, directions)  # ray direction in the body frame
    total = np.zeros((*reach.shape, 3, 3))

    # camera pose: the centre moves by R_wb dr, the direction turns in the body frame
    turn = left_jacobian_so3(pose[3:])
    by_pose = np.concatenate([body, -reach[..., None, None] * body @ skew(seen) @ turn], axis=-1)
    total += _quadratic(onto @ by_pose, np.asarray(pose_covariance, dtype=float)[:N_PARAMETERS, :N_PARAMETERS])

    # body pose: lever arm and ray turn together about the body's position
    swing = np.einsum("nmij,j->nmi", body, pose[:3]) + reach[..., None] * directions
    by_body = -skew(swing) @ small_rotation_by_euler(np.nan_to_num(survey.euler_rad))
    by_body = np.concatenate([np.broadcast_to(np.eye(3), by_body.shape), by_body], axis=-1)
    total += _quadratic(onto @ by_body, survey.covariance)

    # pixel and intrinsics: the direction moves in the camera's normalised plane
    by_plane = reach[..., None, None] * body @ mount[:, :2]
    total += _quadratic(onto @ by_plane, _normalised_covariance(camera, survey.u_px))
    return total


def perturbed(pose: ArrayLike, angle_rad: float) -> Floats:
    """A pose (6,) with each of roll, pitch and yaw of its camera turned by an angle: the paper's 1 deg (Fig. 14)."""
    pose = np.asarray(pose, dtype=float)
    turned = matrix_from_euler(np.full(3, angle_rad)) @ matrix_from_rotation_vector(pose[3:])
    return np.concatenate([pose[:3], rotation_vector_from_matrix(turned)])


def spread_mm(projected_m: ArrayLike) -> float:
    """RMS distance of projections (N, M, 3) from the mean of their point, in mm; points projected once do not count."""
    projected = np.asarray(projected_m, dtype=float)
    valid = np.isfinite(projected[..., 0])
    count = valid.sum(axis=0)
    mean = np.nansum(projected, axis=0) / np.maximum(count, 1)[:, None]
    squared = np.sum((projected - mean) ** 2, axis=-1)
    return float(1e3 * np.sqrt(np.mean(squared[valid & (count > 1)])))


def mapping_table(
    survey: Survey, camera: Camera, poses: Mapping[str, tuple[ArrayLike, ArrayLike]], plane: Plane
) -> pd.DataFrame:
    """One row a pose, observation and point: the projection in map coordinates and its covariance.

    `poses` has a name, a pose (6,) and its covariance (6, 6) each; unobserved points have no row.
    """
    row, column = np.nonzero(np.isfinite(survey.u_px))
    parts = []
    for name, (pose, covariance) in poses.items():
        position = project(survey, camera, pose, plane)[row, column] + survey.origin_m
        spread = projection_covariance(survey, camera, pose, covariance, plane)[row, column]
        parts.append(
            pd.DataFrame(
                {
                    "pose": name,
                    "observation": survey.number[row],
                    "point": survey.names[column],
                    **{axis: position[:, k] for k, axis in enumerate(PROJECTED_COLUMNS)},
                    **{
                        axes: spread[:, i, j]
                        for axes, (i, j) in zip(PROJECTED_COVARIANCE_COLUMNS, POSITION_COVARIANCE_INDICES, strict=True)
                    },
                }
            )
        )
    return pd.concat(parts, ignore_index=True)


def mapping_summary(
    table: pd.DataFrame, plane: Plane, estimated_points_m: ArrayLike, accepted: ArrayLike
) -> pd.DataFrame:
    """Two rows a pose of `mapping_table`, of all observations and of the accepted ones: how far projections scatter.

    `spread_mm` is the RMS distance to each point's mean, `sigma_mm` what the covariances predict of one projection.
    The plane stands beside it: its normal, the RMS distance of the estimated points (M, 3) from it, and the angle to
    the plane of Eq. 26.
    """
    by_height = fit_plane_by_height(estimated_points_m)
    about_plane = {
        **{f"normal_{axis}": plane.normal[k] for k, axis in enumerate(_AXES)},
        "plane_rms_mm": float(1e3 * np.sqrt(np.nanmean(plane.height_m(estimated_points_m) ** 2))),
        "equation_26_angle_rad": float(
            np.arctan2(np.linalg.norm(np.cross(by_height.normal, plane.normal)), by_height.normal @ plane.normal)
        ),
    }
    rows = []
    for pose in table["pose"].unique():
        for name, chosen in (("all", table["observation"].unique()), ("accepted", np.asarray(accepted))):
            part = table[(table["pose"] == pose) & table["observation"].isin(chosen)]
            projected = _gridded(part)
            variance = part[[PROJECTED_COVARIANCE_COLUMNS[k] for k in (0, 3, 5)]].sum(axis=1, skipna=False)
            rows.append(
                {
                    "pose": pose,
                    "observations": name,
                    "n_projected": int(np.isfinite(projected[..., 0]).sum()),
                    "spread_mm": spread_mm(projected - np.nanmean(projected, axis=(0, 1))),
                    "sigma_mm": float(1e3 * np.sqrt(variance.mean())),
                    **about_plane,
                }
            )
    return pd.DataFrame(rows)


def _gridded(part: pd.DataFrame) -> Floats:
    """Projections of one pose's rows as (N, M, 3), NaN where there is none."""
    observations, row = np.unique(part["observation"], return_inverse=True)
    points, column = np.unique(part["point"], return_inverse=True)
    grid = np.full((len(observations), len(points), 3), np.nan)
    grid[row, column] = part[list(PROJECTED_COLUMNS)].to_numpy()
    return grid


def _rays(survey: Survey, camera: Camera, pose: Floats) -> tuple[Floats, Floats]:
    body = matrix_from_euler(np.nan_to_num(survey.euler_rad))
    return rays(camera, matrix_from_rotation_vector(pose[3:]), pose[:3], body, survey.position_m, survey.u_px)


def _normalised_covariance(camera: Camera, u_px: Floats) -> Floats:
    """Covariance (..., 2, 2) of the ray's coordinates in the normalised plane, from pixel and intrinsics."""
    sigmas, focal_px, optics = camera.sigmas, camera.focal_length_px, camera.lens
    x = normalised_from_pixel(camera, u_px)
    names = camera.uncertain_coefficients
    by_s, by_y = lens.by_coefficients(x, names)
    distorted = (u_px - camera.principal_point_px) / focal_px
    slope, bend = 1 / lens.distortion_slope(x, optics), lens.across_slope(x, optics)
    known = [np.hypot(sigmas.u_px, sigmas.principal_point_px) / focal_px, sigmas.focal_length_m / camera.focal_length_m]
    of_s = np.stack([np.full_like(x, known[0]), distorted * known[1]], axis=-1)
    of_each = np.array([getattr(sigmas, name) for name in names])
    of_s = np.concatenate([of_s, by_s * of_each], axis=-1) * slope[..., None]  # the ray's x by one sigma of each
    of_y = np.concatenate([np.zeros((*x.shape, 2)), by_y * of_each], axis=-1) + bend[..., None] * of_s
    covariance = np.zeros((*u_px.shape, 2, 2))
    covariance[..., 0, 0] = np.sum(of_s**2, axis=-1)
    covariance[..., 0, 1] = covariance[..., 1, 0] = np.sum(of_s * of_y, axis=-1)
    covariance[..., 1, 1] = np.sum(of_y**2, axis=-1) + (sigmas.v_px / focal_px) ** 2
    return covariance


def _quadratic(jacobian: Floats, covariance: Floats) -> Floats:
    return np.asarray(jacobian @ covariance @ np.swapaxes(jacobian, -1, -2))


def _run(inputs: Inputs) -> dict[str, pd.DataFrame]:
    platform, data, reference = inputs.platform, inputs.data, inputs.reference
    angle_rad = float(np.deg2rad(inputs.required(SECTION).perturbation_deg))
    points = inputs.table("estimated_points", ESTIMATED_POINTS)
    estimated = points.loc[points["stage"] == "inliers", list(POSITION_COLUMNS)].to_numpy() - data.all.survey.origin_m
    plane = fit_plane(estimated)
    poses = {
        "hand_measured": (platform.start_pose(), platform.start_covariance()),
        "calibrated": (reference.pose, reference.covariance),
        "perturbed": (perturbed(reference.pose, angle_rad), reference.covariance),
    }
    table = mapping_table(data.all.survey, data.all.camera, poses, plane)
    summary = mapping_summary(table, plane, estimated, data.accepted.survey.number)
    log_rows(_logger, "%s, %s observations: %.1f mm", summary, ("pose", "observations", "spread_mm"))
    return {"mapping": table, "mapping_summary": summary}


EXPERIMENT: Final = Experiment(
    name="mapping",
    title="Mapping before and after",
    outputs={"mapping": MAPPING, "mapping_summary": MAPPING_SUMMARY},
    run=_run,
    section=SECTION,
    needs=(*ESTIMATE, "estimated_points"),
)
