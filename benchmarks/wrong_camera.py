"""How often the check of the camera finds a wrong focal length, and how often a right one; a Markdown table.

`python benchmarks/wrong_camera.py [SURVEYS]`. Each survey (default 100 a row) is drawn with a principal point and a
focal length about those of the platform's file, by the sigmas that the file states, or with a focal length off by so
much, and adjusted. These are the platform's (1.2 and 1.6 % of the focal length), or a hundredth of them. Told is
what the verdict tells: of all intrinsics the one that lies farthest off.
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
from linepose.pipeline.adjusted_intrinsics import farthest
from linepose.pipeline.adjusted_tables import adjusted_intrinsics
from linepose.pipeline.checks import CAMERA_SIGMAS
from linepose.simulation.drawn_camera import drawn_camera
from linepose.simulation.noisy_survey import draw_survey
from linepose.simulation.survey import without_faults

ROWS = ((0.0, 1.0), (0.05, 1.0), (-0.1, 1.0), (0.0, 0.01), (0.05, 0.01))  # focal length off; sigmas stated


@dataclass(frozen=True)
class Outcome:
    """How many sigmas the camera lies from the file's, and the position's largest error in stated sigmas."""

    camera_sigmas: float
    position_sigmas: float


def outcome(platform: Platform, off: float, stated: float, seed: int) -> Outcome:
    """Of one survey, the camera's sigmas in the file `stated` times the platform's."""
    assert platform.simulation is not None
    random, camera, drive = np.random.default_rng(seed), platform.intrinsics(), without_faults(platform.simulation)
    sigmas = {name: stated * getattr(camera.sigmas, name) for name in ALWAYS_ESTIMATED}
    camera = camera.replaced(sigmas=camera.sigmas.replaced(**sigmas))
    true_camera = drawn_camera(camera, 1.0, random)
    if off:
        true_camera = true_camera.replaced(focal_length_m=(1 + off) * camera.focal_length_m)
    true_pose = np.array(drive.true_pose)
    hand = moved(true_pose, np.linalg.cholesky(default_hand_covariance()) @ random.standard_normal(6))
    survey, _ = draw_survey(true_camera, drive, LEVELS, random)
    found = adjust(survey, camera, hand, settings=AdjustmentSettings(**dict(QUICK)))
    _, sigmas_off = farthest(adjusted_intrinsics(found, camera))
    error = np.abs(found.pose - true_pose)[:3] / found.sigma[:3]
    return Outcome(sigmas_off or 0.0, float(error.max()))


def main(count: int) -> None:
    """Print the table."""
    print("| platform | focal length off | sigmas stated | told | camera off | position off (both median, in sigmas) |")
    print("| --- | --- | --- | --- | --- | --- |")
    for name in ("ladybird-sim", "shrimp-sim"):
        platform = load_platform(Path(__file__).parents[1] / "config" / "platforms", name)
        for off, stated in ROWS:
            found = [outcome(platform, off, stated, seed) for seed in range(count)]
            sigmas = np.array([one.camera_sigmas for one in found])
            position = np.median([one.position_sigmas for one in found])
            told, median = np.mean(sigmas > CAMERA_SIGMAS), np.median(sigmas)
            what = f"{100 * off:.0f} %" if off else "as its sigma says"
            print(f"| {name} | {what} | {stated:g} | {100 * told:.1f} % | {median:.1f} | {position:.1f} |", flush=True)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 100)
