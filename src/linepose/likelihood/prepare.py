"""What the kernel needs of a survey and a camera, worked out once: covariances in body axes, rays in the camera."""

import logging

import numpy as np

from linepose.arrays import Floats
from linepose.errors import InputError
from linepose.geometry import rotations
from linepose.geometry.camera import Camera, normalised_from_pixel
from linepose.geometry.lens import by_coefficients, distortion_slope
from linepose.likelihood import layout
from linepose.likelihood.layout import LANES
from linepose.survey.observations import Survey
from linepose.survey.point_names import in_words

_logger = logging.getLogger(__name__)
_PAIRS_6 = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
_PAIRS_9 = tuple((i, j) for i in range(3) for j in range(3))


def usable(survey: Survey) -> Floats:
    """1 where a point was observed, and by at least one other observation too, else 0; (N, M).

    A point seen once is logged; raises InputError where the body pose or covariance of an observed point is missing.
    """
    seen = np.isfinite(survey.u_px)
    complete = (
        np.isfinite(survey.position_m).all(axis=-1)
        & np.isfinite(survey.euler_rad).all(axis=-1)
        & np.isfinite(survey.covariance).all(axis=(-2, -1))
    )
    if np.any(seen & ~complete):
        row, point = np.argwhere(seen & ~complete)[0]
        raise InputError(
            f"observation {survey.number[row]}, point {survey.names[point]}",
            "a pixel without a finite body pose and covariance",
            "all of them",
            "associate it with navigation or remove it",
        )
    views = seen.sum(axis=0)
    alone = np.flatnonzero(views < 2)
    if len(alone):
        _logger.warning("points %s have fewer than two views and do not enter", in_words(survey.names[alone]))
    return np.where(seen & (views >= 2), 1.0, 0.0)


def body_covariance(euler_rad: Floats, covariance: Floats) -> Floats:
    """Covariance of the body's position and small rotation, both in body axes; (..., 3), (..., 6, 6) to (..., 6, 6)."""
    to_body = np.swapaxes(rotations.matrix_from_euler(euler_rad), -1, -2)
    jacobian = np.zeros_like(covariance)
    jacobian[..., :3, :3] = to_body
    jacobian[..., 3:, 3:] = to_body @ rotations.small_rotation_by_euler(euler_rad)
    return jacobian @ covariance @ np.swapaxes(jacobian, -1, -2)


def normalised_by_intrinsics(camera: Camera, u_px: Floats) -> tuple[Floats, Floats, Floats]:
    """Normalised x of pixels, its derivative by u (1/px), and by u0, f, k1, k2; (...) to (...), (...), (..., 4)."""
    x = normalised_from_pixel(camera, u_px)
    by_distorted = 1 / distortion_slope(x, camera.lens)
    by_u = by_distorted / camera.focal_length_px
    distorted = (u_px - camera.principal_point_px) / camera.focal_length_px
    by_k = -by_distorted[..., None] * by_coefficients(x, ("k1", "k2"))[0]
    by_pair = np.stack([-by_u, -by_distorted * distorted / camera.focal_length_m], axis=-1)
    return x, by_u, np.concatenate([by_pair, by_k], axis=-1)


def check_straight(camera: Camera) -> None:
    """Raise InputError for a camera that the paper's equations do not have: another line, or other sigmas.

    Their line is straight; their sigmas are those of principal point, focal length, k1 and k2.
    """
    bent = not camera.lens.is_straight
    other = [name for name in camera.uncertain_coefficients if name not in ("k1", "k2")]
    if bent or other:
        found = "tilt, smile, or angles across the line" if bent else f"sigmas of {', '.join(other)}"
        expected = "none with the paper's noise models, whose scan line is straight"
        raise InputError("camera", found, expected, "set noise_model: adjustment, or leave these out")


def point_origins(survey: Survey, mask: Floats) -> Floats:
    """Mean body position over each point's observations, so that coordinates stay small; (M, 3)."""
    count = np.maximum(mask.sum(axis=0), 1)
    return np.asarray(np.where(mask[..., None] > 0, survey.position_m, 0).sum(axis=0) / count[:, None])


def survey_rows(survey: Survey, camera: Camera, mask: Floats, origins: Floats) -> Floats:
    """The survey in the kernel's layout, (blocks, N, SURVEY_COLUMNS); unseen points have mask 0 and finite values."""
    seen = mask > 0
    u_px = np.where(seen, survey.u_px, camera.principal_point_px)
    euler = np.where(seen[..., None], survey.euler_rad, 0.0)
    covariance = np.where(seen[..., None, None], survey.covariance, np.eye(6))
    matrices, cov = rotations.matrix_from_euler(euler), body_covariance(euler, covariance)
    position = np.where(seen[..., None], survey.position_m - origins, 0.0)
    sigmas = camera.sigmas
    x, by_u, by_intrinsics = normalised_by_intrinsics(camera, u_px)
    cosine2 = 1 / (1 + x**2)
    share = by_intrinsics * [sigmas.principal_point_px, sigmas.focal_length_m, sigmas.k1, sigmas.k2]
    plane_x = (by_u * sigmas.u_px) ** 2 + np.sum(share**2, axis=-1)
    plane_y = np.full_like(x, (sigmas.v_px / camera.focal_length_px) ** 2)
    columns = [matrices[..., i, j] for i, j in _PAIRS_9]
    columns += [position[..., i] for i in range(3)]
    columns += [cov[..., i, j] for i, j in _PAIRS_6]
    columns += [cov[..., i, 3 + j] for i, j in _PAIRS_9]
    columns += [cov[..., 3 + i, 3 + j] for i, j in _PAIRS_6]
    columns += [x * np.sqrt(cosine2), np.sqrt(cosine2), plane_x * cosine2**2, plane_y * cosine2]
    columns += [share[..., i] * cosine2 for i in range(4)]
    columns += [plane_x, plane_y, mask]
    return _in_lanes(np.stack(columns, axis=1), _absent_column())


def _absent_column() -> Floats:
    """Values (quantities,) of a lane without a point: a level camera at the origin, with unit covariance."""
    values = np.zeros(layout.SURVEY_COLUMNS // LANES)
    ones = [layout.R_NX, layout.R_EY, layout.R_DZ, layout.S_XX, layout.S_YY, layout.S_ZZ]
    ones += [layout.S_AA, layout.S_BB, layout.S_CC, layout.COSINE, layout.SPREAD_ALONG, layout.SPREAD_ACROSS]
    values[np.array(ones) // LANES] = 1
    return values


def _in_lanes(quantities: Floats, absent: Floats) -> Floats:
    """(N, quantities, M) to (blocks, N, quantities * LANES), padded with `absent` (quantities,)."""
    n, count, m = quantities.shape
    blocks = max(1, -(-m // LANES))
    padded = np.broadcast_to(absent[:, None], (n, count, blocks * LANES)).copy()
    padded[..., :m] = quantities
    return np.ascontiguousarray(
        padded.reshape(n, count, blocks, LANES).transpose(2, 0, 1, 3).reshape(blocks, n, count * LANES)
    )
