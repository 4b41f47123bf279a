"""The made-up platform's file, and the sizes and true numbers that its results are made of."""

import numpy as np

from linepose.config.platform import Platform

OPTIMUM = np.array([0.19, -0.14, -0.79, -0.82, 0.74, -1.43])
SIGMA = np.array([0.03, 0.05, 0.06, 0.016, 0.018, 0.009])
ORIGIN = np.array([6248000.0, 332960.0, -42.0])
N_OBSERVATIONS, ACCEPTED, REMOVED = 6, [1, 2, 3, 4], [6, 5]
POINTS = np.array([[-0.2, -0.3, 0.0], [-0.2, 0.3, 0.0], [0.2, -0.3, 0.0], [0.2, 0.3, 0.0]])
N_STEPS, N_WALKERS = 20, 16
PLATFORM = {
    "description": "A made-up platform",
    "noise_model": "published",
    "prior": "none",
    "camera": {"focal_length_m": 8.2e-3, "pixel_pitch_m": 7.4e-6, "n_pixels": 648, "principal_point_px": 323.0},
    "hand_measured": {"position_m": [0.2, 0.0, -0.8], "euler_deg": [-56.0, 0.0, -90.0]},
    "source": {"kind": "labelled_views", "dataset": "made_up"},
    "experiments": {"adjustment_beside": {"platforms": ["other"]}},
    "outline": {
        "side": {"lines": [[[-1.0, 0.5], [1.0, 0.5], [0.0, -0.7], [-1.0, 0.5]]], "circles": [[0.5, 0.7, 0.2]]},
        "front": {"lines": [[[-0.7, 0.5], [0.7, 0.5]]]},
    },
}


def platform(**changes) -> Platform:
    """The made-up platform, with keys of its file changed."""
    return Platform.model_validate(PLATFORM | changes)
