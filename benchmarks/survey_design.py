"""Which motions give which parameter: sigmas of the pose over layouts of a survey; a Markdown table on the terminal.

`python benchmarks/survey_design.py [SURVEYS]`. Sixteen views with the simulated Ladybird's camera, navigation and
reported covariances. Each layout is simulated SURVEYS times (default 20) and adjusted without the hand measurement as a
prior: the table has the root mean square error against the truth.
"""

import sys
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from pathlib import Path

import numpy as np

from linepose.adjustment import AdjustmentSettings, adjust
from linepose.config.platform import load_platform
from linepose.geometry.camera import Camera
from linepose.geometry.distance import pose_difference
from linepose.simulation.settings import GroundSettings, PassSettings, SimulationSettings, WaveSettings
from linepose.simulation.survey import simulate_survey, without_faults

RANGE_M = 2.9
ROLL_RAD = float(np.deg2rad(4.5))
OFFSETS_M = (-0.6, -0.2, 0.2, 0.6)
N_VIEWS = 16
HILL = (WaveSettings(1.1, 14.0, np.deg2rad(20.0)), WaveSettings(0.5, 9.0, np.deg2rad(110.0), 1.0))


def passes(bearings_deg: tuple[float, ...], roll: Callable[[int], float] = lambda _: 0.0) -> tuple[PassSettings, ...]:
    """Sixteen passes that end up in front of the board, from these sides in turn, side by side."""
    views = []
    for view in range(N_VIEWS):
        bearing = np.deg2rad(bearings_deg[view % len(bearings_deg)])
        aside = OFFSETS_M[view // len(bearings_deg) % len(OFFSETS_M)]
        away, across = np.array([np.cos(bearing), np.sin(bearing)]), np.array([-np.sin(bearing), np.cos(bearing)])
        north, east = RANGE_M * away + aside * across
        heading = bearing + np.pi - 0.5 * np.arctan2(aside, RANGE_M)
        views.append(PassSettings(north, east, heading, 8.0, speed_m_s=-0.2, channel_roll_rad=roll(view)))
    return tuple(views)


def layouts(base: SimulationSettings) -> dict[str, SimulationSettings]:
    """Each layout by what a driver would call it."""

    def half_rolled(view: int) -> float:
        return (ROLL_RAD, 0.0, -ROLL_RAD, 0.0)[(view // 4 + view) % 4]

    around = passes((0.0, 90.0, 180.0, 270.0))
    return {
        "one side, level": replace(base, passes=passes((270.0,))),
        "two opposite sides, level": replace(base, passes=passes((90.0, 270.0))),
        "four sides, level": replace(base, passes=around),
        "one side, half of it rolled 4.5°": replace(base, passes=passes((270.0,), half_rolled)),
        "four sides, half of it rolled 4.5°": replace(base, passes=passes((0.0, 90.0, 180.0, 270.0), half_rolled)),
        "four sides, on a hill": replace(base, passes=around, ground=GroundSettings(base.ground.body_height_m, HILL)),
    }


def error(camera: Camera, settings: SimulationSettings, start: np.ndarray, seed: int) -> np.ndarray:
    """Estimate less truth of one simulated survey (6,): m along the body's axes, rad about them."""
    survey, _ = simulate_survey(camera, settings, seed)
    pose = adjust(survey, camera, start, settings=AdjustmentSettings(hand_measured_prior=False, n_draws=10)).pose
    return pose_difference(pose, np.array(settings.true_pose))


def main(n_surveys: int) -> None:
    """Print the table."""
    platform = load_platform(Path(__file__).parents[1] / "config" / "platforms", "ladybird-sim")
    assert platform.simulation is not None
    camera, start = platform.intrinsics(), platform.start_pose()
    print("| layout | r_x (mm) | r_y (mm) | r_z (mm) | about forward (°) | about right (°) | about down (°) |")
    print("| --- | --- | --- | --- | --- | --- | --- |")
    with ProcessPoolExecutor() as pool:
        for name, settings in layouts(without_faults(platform.simulation)).items():
            each = [pool.submit(error, camera, settings, start, seed) for seed in range(n_surveys)]
            rms = np.sqrt(np.mean(np.square([one.result() for one in each]), axis=0))
            cells = [f"{1e3 * value:.0f}" for value in rms[:3]] + [f"{value:.2f}" for value in np.rad2deg(rms[3:])]
            print(f"| {name} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 20)
