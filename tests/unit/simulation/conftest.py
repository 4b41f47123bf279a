import copy
from dataclasses import replace
from typing import Any

import pytest

from linepose.geometry.camera import Camera
from linepose.simulation.settings import SimulationSettings, settings_from_dict

PASS = {"north_m": 1.0, "east_m": -2.7, "heading_deg": 112.0, "speed_m_s": -0.2, "duration_s": 6.0}
SECTION = {
    "seed": 1,
    "true_pose": [0.189, -0.142, -0.794, -0.822, 0.738, -1.429],
    "board": {"position_m": [0.0, 0.0, 0.0], "euler_deg": [0.0, 0.0, -159.0]},
    "ground": {
        "body_height_m": 1.0,
        "waves": [{"amplitude_m": 0.04, "wavelength_m": 15.0, "direction_deg": 30.0, "phase_deg": 20.0}],
    },
    "passes": [
        PASS,
        PASS | {"speed_m_s": 0.1, "duration_s": 12.0, "channel_roll_deg": 4.0},
        PASS | {"speed_m_s": -0.2, "turn_rate_deg_s": 2.0},
    ],
    "navigation_error": {},
    "reported_sigma": {"position_m": [0.01, 0.013, 0.011], "euler_deg": [0.24, 0.26, 0.11]},
    "image": {"ifov_rad": 1.88e-3},
    "extraction": {"sigma_u_px": 0.0, "sigma_line": 0.0},
}


@pytest.fixture
def section() -> dict[str, Any]:
    """What a platform file's `simulation` section holds."""
    return copy.deepcopy(SECTION)


@pytest.fixture
def camera() -> Camera:
    return Camera(focal_length_m=8.2e-3, pixel_pitch_m=4.8e-3 / 648, n_pixels=648, principal_point_px=323.0)


@pytest.fixture
def settings() -> SimulationSettings:
    """Three passes without any noise or fault: straight in reverse, slow in a channel, turning."""
    return settings_from_dict(SECTION)


@pytest.fixture
def spot_settings(settings: SimulationSettings) -> SimulationSettings:
    """One rotation on the spot."""
    turning = replace(settings.passes[0], speed_m_s=0.0, turn_rate_rad_s=0.05)
    return replace(settings, passes=(turning,))
