"""How often a recheck raises a false alarm, and how often it finds a planted move; a Markdown table on the terminal.

`python benchmarks/recheck.py [RECHECKS] [PROCESSES]`. Each recheck (default 200, in 2 processes) draws a camera, a hand
measurement, a survey of the simulated Ladybird's passes for the calibration, and six new passes another day, with the
camera where it was. As many again have it moved along or about one axis, by the least move that rechecks said (in the
median) they find with 80 %.
"""

import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from linepose.adjustment import AdjustmentSettings, adjust
from linepose.adjustment.settings import AdjustmentSection, default_hand_covariance
from linepose.arrays import Floats
from linepose.config.platform import Platform, load_platform
from linepose.estimation.pose_change import FALSE_ALARMS, GROUPS, WHOLE, PoseChange
from linepose.estimation.recheck import recheck
from linepose.geometry.pose import TURN_WORDS
from linepose.simulation.drawn_camera import drawn_camera
from linepose.simulation.noise_levels import NoiseLevels
from linepose.simulation.noisy_survey import draw_survey
from linepose.simulation.settings import SimulationSettings
from linepose.simulation.survey import without_faults

CALIBRATED = tuple(range(7)) + tuple(range(13, 25))  # passes of the drive
NEW = (0, 2, 4, 13, 15, 17)
LEVELS = NoiseLevels(platform_error=True, intrinsics_level=0.0)  # the intrinsics are drawn once for both
QUICK = AdjustmentSection(n_draws=20, n_samples=10)
MOVES = ("forward", "right", "down", *TURN_WORDS.values())


@dataclass(frozen=True)
class Outcome:
    """p-values by group, and the least moves (6,) that would have been found with 80 %."""

    p_values: dict[str, float]
    least_seen: Floats


def moved(pose: Floats, move: Floats) -> Floats:
    """A pose (6,) after a move (6,) of position (m) and turn about body axes (rad)."""
    turned = Rotation.from_rotvec(move[3:]) * Rotation.from_rotvec(pose[3:])
    return np.concatenate([pose[:3] + move[:3], turned.as_rotvec()])


def simulated(platform: Platform, move: Floats, seed: int, section: AdjustmentSection = QUICK) -> PoseChange:
    """The change that one recheck finds where the camera made a move (6,) after the calibration."""
    assert platform.simulation is not None
    random, camera, drive = np.random.default_rng(seed), platform.intrinsics(), without_faults(platform.simulation)
    true_camera = drawn_camera(camera, 1.0, random)
    true_pose = np.array(drive.true_pose)
    hand = moved(true_pose, np.linalg.cholesky(default_hand_covariance()) @ random.standard_normal(6))
    survey, _ = draw_survey(true_camera, with_passes(drive, CALIBRATED), LEVELS, random)
    calibrated = adjust(survey, camera, hand, settings=AdjustmentSettings(**dict(section)))
    later = replace(with_passes(drive, NEW), true_pose=tuple(moved(true_pose, move).tolist()))
    views, _ = draw_survey(true_camera, later, LEVELS, random)
    return recheck(calibrated, views, camera, section, seed=seed).change


def with_passes(drive: SimulationSettings, passes: tuple[int, ...]) -> SimulationSettings:
    """The drive with these of its passes."""
    return replace(drive, passes=tuple(drive.passes[number] for number in passes))


def outcome(move: Floats, seed: int) -> Outcome:
    """One simulated recheck."""
    platform = load_platform(Path(__file__).parents[1] / "config" / "platforms", "ladybird-sim")
    change = simulated(platform, move, seed)
    return Outcome({group: change.test(group).p_value for group in GROUPS}, change.least_seen())


def told(outcomes: list[Outcome], group: str) -> str:
    """The share of rechecks in which a group was told to have moved, with its standard error, in per cent."""
    found = float(np.mean([one.p_values[group] < FALSE_ALARMS for one in outcomes]))
    return f"{100 * found:.1f} ± {100 * np.sqrt(found * (1 - found) / len(outcomes)):.1f} %"


def rows(count: int, pool: ProcessPoolExecutor) -> Iterator[tuple[str, str, str]]:
    """What was planted, and how often the test of all six, and of the move's own group, told a move."""
    still = list(pool.map(outcome, [np.zeros(6)] * count, range(count)))
    yield (
        "nothing",
        told(still, WHOLE),
        ", ".join(f"{group} {told(still, group)}" for group in GROUPS if group != WHOLE),
    )
    least = np.median([one.least_seen for one in still], axis=0)
    axes = np.arange(count) % len(MOVES)
    made = list(pool.map(outcome, np.diag(least)[axes], range(count, 2 * count)))
    for axis, name in enumerate(MOVES):
        of_axis = [one for one, planted in zip(made, axes, strict=True) if planted == axis]
        group = "lever arm" if axis < 3 else "boresight"
        size = f"{1e3 * least[axis]:.0f} mm" if axis < 3 else f"{np.degrees(least[axis]):.2f}°"
        yield f"{name} {size}", told(of_axis, WHOLE), f"{group} {told(of_axis, group)}"
    yield "one of these", told(made, WHOLE), ""


def main(count: int, processes: int) -> None:
    """Print the table."""
    print("| planted | told to have moved, by all six | by the group alone |\n| --- | --- | --- |")
    with ProcessPoolExecutor(processes) as pool:
        for row in rows(count, pool):
            print(f"| {' | '.join(row)} |", flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 200, int(sys.argv[2]) if len(sys.argv) > 2 else 2)
