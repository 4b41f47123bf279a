"""The Ladybird field data as a survey, read plainly and without the library's own readers."""

import os
from pathlib import Path

import numpy as np

from linepose.geometry.camera import Camera
from linepose.survey.observations import Survey

FOLDER = Path(os.environ.get("LINEPOSE_FIELD_DATA", Path(__file__).parents[4] / "shared" / "ladybird"))
PRESENT = (FOLDER / "nav_covs.csv").is_file()
INLIERS = (1, 2, 3, 4, 5, 6, 14, 15, 16, 17, 18, 19, 20, 21, 24, 25)
CAMERA = Camera(focal_length_m=8.2e-3, pixel_pitch_m=4.8e-3 / 648, n_pixels=648, principal_point_px=323.0)


def reverse_views() -> Survey:
    """Observations 1 to 25: every second view file, with columns 0-5 of the nearest covariance."""
    files = sorted(FOLDER.glob("labelled_points/*.csv"))[1::2]
    return _survey(files)


def forward_views() -> Survey:
    """The other 25 view files, numbered from 1."""
    return _survey(sorted(FOLDER.glob("labelled_points/*.csv"))[0::2])


def _survey(files: list[Path]) -> Survey:
    navigation = np.loadtxt(FOLDER / "nav_covs.csv", delimiter=",")
    shape = (len(files), 15)
    time, u = np.zeros(shape, dtype=np.int64), np.full(shape, np.nan)
    position, euler = np.full((*shape, 3), np.nan), np.full((*shape, 3), np.nan)
    covariance, gap = np.full((*shape, 6, 6), np.nan), np.full(shape, np.nan)
    for row, file in enumerate(files):
        for line in np.loadtxt(file, delimiter=",", ndmin=2):
            point = int(line[1])
            nearest = np.argmin(np.abs(navigation[:, 0] - line[0]))
            time[row, point], u[row, point] = int(line[0]), line[2]
            position[row, point], euler[row, point] = line[3:6], line[6:9]
            covariance[row, point] = navigation[nearest, 1:].reshape(12, 12)[:6, :6]
            gap[row, point] = abs(navigation[nearest, 0] - line[0]) * 1e-6
    origin = np.round(np.nanmean(position, axis=(0, 1)))
    return Survey(
        number=np.arange(1, len(files) + 1),
        time_us=time,
        u_px=u,
        position_m=position - origin,
        euler_rad=euler,
        covariance=covariance,
        nav_gap_s=gap,
        origin_m=origin,
    )
