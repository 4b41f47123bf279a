"""A made-up strip: a body that drives over the ground, and a camera that looks down from it."""

import numpy as np

from linepose.adjustment.levels import Levels
from linepose.geometry.camera import Camera
from linepose.geometry.camera_sigmas import CameraSigmas
from linepose.output.map.frame import SurveyMap
from linepose.output.map.ground import flat_ground
from linepose.output.map.places import Navigation, ScanOnMap
from linepose.output.map.sources import MountedCamera
from linepose.survey.navigation import NavigationCovariances
from linepose.survey.navigation_log import NavigationLog, interpolated_pose

CAMERA = Camera(
    focal_length_m=8e-3,
    pixel_pitch_m=8e-5,
    n_pixels=60,
    principal_point_px=29.0,
    k1=0.02,
    k2=-0.01,
    sigmas=CameraSigmas(principal_point_px=1.0, focal_length_m=2e-5, k1=0.01, k2=0.005),
)
POSE = np.array([0.2, -0.1, -0.8, -0.05, 0.06, 1.5])
_SPREAD = np.random.default_rng(1).normal(size=(6, 6)) * np.array([0.01, 0.01, 0.02, 2e-3, 2e-3, 2e-3])[:, None]
POSE_COVARIANCE = _SPREAD @ _SPREAD.T
_BODY = np.random.default_rng(2).normal(size=(6, 6)) * np.array([0.008, 0.01, 0.02, 1e-3, 1e-3, 3e-3])[:, None]
BODY_COVARIANCE = _BODY @ _BODY.T
LEVELS = Levels(0.5, 0.3, 0.4, 0.6, 0.5, 60.0, 1.4)
ORIGIN = np.array([6_248_000.0, 332_960.0, -42.0])
START_US = 1_700_000_000_000_000


def scan(n_lines=40, ground=None, levels=None, correction=None, camera=CAMERA, height_m=3.0):
    """The strip, ten lines a second at 0.3 m/s, over a flat ground at 42 m."""
    seconds = np.arange(0.0, n_lines / 10 + 1.0, 0.05)
    position = ORIGIN + np.stack([0.3 * seconds, 0.1 * seconds, np.full_like(seconds, -height_m)], axis=-1)
    euler = np.stack([0.03 * np.sin(seconds), 0.02 * np.cos(seconds), np.full_like(seconds, 0.4)], axis=-1)
    time_us = START_US + np.rint(seconds * 1e6).astype(np.int64)
    reported = NavigationCovariances(time_us[::20], np.broadcast_to(BODY_COVARIANCE, (len(time_us[::20]), 6, 6)))
    navigation = Navigation(NavigationLog(time_us, position, euler), interpolated_pose, reported, 0.1, 1.0)
    return ScanOnMap(
        "strip",
        START_US + np.arange(n_lines) * 100_000 + 12_345,
        MountedCamera(camera, POSE, POSE_COVARIANCE, levels),
        navigation,
        ground or flat_ground(42.0, 0.03),
        SurveyMap(None),
        np.zeros(6) if correction is None else correction,
    )
