"""How often the check of the camera finds a wrong focal length, and how often a right one; a Markdown table.

`python benchmarks/wrong_camera.py [SURVEYS]`. Each survey (default 150 a row) is drawn with a principal point and a
focal length about those of the platform's file, by its sigmas (1.2 %), or a focal length off by so much, and adjusted.
"""

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from recheck import LEVELS, QUICK, moved

from linepose.adjustment import AdjustmentSettings, adjust
from linepose.adjustment.settings import default_hand_covariance
from linepose.config.platform import Platform, load_platform
from linepose.geometry.camera_sigmas import ALWAYS_ESTIMATED
from linepose.pipeline.adjusted_intrinsics import AdjustedIntrinsics
from linepose.pipeline.checks import CAMERA_SIGMAS
from linepose.simulation.drawn_camera import drawn_camera
from linepose.simulation.noisy_survey import draw_survey
from linepose.simulation.survey import without_faults

OFF = (0.0, 0.05, -0.1)  # of the focal length


@dataclass(frozen=True)
class Outcome:
    """How far the focal length lies from the file's, in sigmas, and the position's largest error in stated sigmas."""

    camera_sigmas: float
    position_sigmas: float


def outcome(platform: Platform, off: float, seed: int) -> Outcome:
    """Of one survey."""
    assert platform.simulation is not None
    random, camera, drive = np.random.default_rng(seed), platform.intrinsics(), without_faults(platform.simulation)
    true_camera = drawn_camera(camera, 1.0, random)
    if off:
        true_camera = true_camera.replaced(focal_length_m=(1 + off) * camera.focal_length_m)
    true_pose = np.array(drive.true_pose)
    hand = moved(true_pose, np.linalg.cholesky(default_hand_covariance()) @ random.standard_normal(6))
    survey, _ = draw_survey(true_camera, drive, LEVELS, random)
    found = adjust(survey, camera, hand, settings=AdjustmentSettings(**dict(QUICK)))
    estimate = np.array([found.principal_point_px, found.focal_length_m])
    known = [np.array([getattr(of, name) for name in ALWAYS_ESTIMATED]) for of in (camera, camera.sigmas)]
    told = AdjustedIntrinsics(ALWAYS_ESTIMATED, estimate, found.intrinsics_covariance[:2, :2], np.zeros((6, 2)), *known)
    error = np.abs(found.pose - true_pose)[:3] / found.sigma[:3]
    return Outcome(float(told.moved_sigmas[1]), float(error.max()))


def main(count: int) -> None:
    """Print the table."""
    print("| platform | focal length off | told | RMS of sigmas | position off (sigmas, median of the largest) |")
    print("| --- | --- | --- | --- | --- |")
    for name in ("ladybird-sim", "shrimp-sim"):
        platform = load_platform(Path(__file__).parents[1] / "config" / "platforms", name)
        for off in OFF:
            found = [outcome(platform, off, seed) for seed in range(count)]
            sigmas = np.array([one.camera_sigmas for one in found])
            position = np.median([one.position_sigmas for one in found])
            told = np.mean(np.abs(sigmas) > CAMERA_SIGMAS)
            rms = np.sqrt(np.mean(sigmas**2))
            what = f"{100 * off:.0f} %" if off else "as its sigma says"
            print(f"| {name} | {what} | {100 * told:.1f} % | {rms:.2f} | {position:.1f} |", flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 150)
