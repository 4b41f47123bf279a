"""Arguments of massipipe's FlatTerrainOrthorectifier, as YAML: fan of rays, rotation from camera to IMU, altitude.

massipipe turns about x, y, z, each fixed, `R = Rz(yaw) Ry(pitch) Rx(roll)`, both camera to IMU and IMU to north, east,
down, with linepose's body axes. Its pixel j of n looks along `(0, -t, 1)` in its camera's axes, with t at equal steps
from `-tan(fov/2)` to `tan(fov/2)`: its y is minus our x. It has no lever arm, but a correction of the altitude.
"""

import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Final

from linepose.errors import InputError
from linepose.output.exports.brown import all_rays
from linepose.output.exports.words import explained
from linepose.pipeline.exports.format import ExportFormat
from linepose.pipeline.exports.options import ExportOptions

if TYPE_CHECKING:
    from linepose.arrays import Floats
    from linepose.geometry.camera import Camera
    from linepose.pipeline.calibration import Calibration

_FARTHEST_PX: Final = 0.5  # by which its resampling to the nearest pixel moves each pixel anyhow
_TILT_DEG: Final = 10.0  # of a vehicle, at which the error of a missing lever arm is told
_AS_OURS: Final = ((0.0, -1.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0))  # massipipe's camera axes in ours


def write_massipipe(calibration: "Calibration", options: ExportOptions, path: Path) -> None:
    """Write the arguments; raises InputError for body axes, or a lens, that massipipe cannot have."""
    import numpy as np
    import yaml

    from linepose.geometry.rotations import euler_from_matrix

    if options.body_axes == "flu":
        raise InputError("body axes", "flu", "frd, which massipipe reads", "leave --body-axes out")
    estimate = calibration.estimate.in_axes("frd")
    camera = calibration.own_camera
    fov_rad, turn, off_px = centred_fan(camera, calibration.name)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # at a pitch of 90 deg any roll with its yaw is the same rotation
        euler = euler_from_matrix(estimate.matrix[:3, :3] @ turn)
    forward, right, down = map(float, estimate.pose[:3])
    tilted_m = tilted_off_m(camera, estimate.matrix, calibration.name)
    arguments = {
        "camera_cross_track_fov": fov_rad,
        "camera_cross_track_n_pixels": camera.n_pixels,
        "euler_imu_from_camera": (np.asarray(euler) + 0.0).tolist(),
        "camera_altitude_correction": -down + 0.0,
        "imu_roll_direction_is_right_wing_down": False,
        "image_columns_increase_with_positive_y": True,
    }
    comments = [
        *explained(calibration, estimate),
        "Arguments of massipipe.FlatTerrainOrthorectifier (rad, m), as its release 0.3.2 uses them.",
        f"Its pixels at equal steps about the middle look within {off_px:.2f} px of where ours do.",
        f"It has no lever arm: places are {np.hypot(forward, right):.3f} m off ({forward:.4f} m forward, {right:.4f} m "
        f"right) where the vehicle is level, and up to {tilted_m:.3f} m at a roll or pitch of {_TILT_DEG:g} deg, "
        "unless it is given the camera's positions.",
        "Roll is right wing up in the .lcf files that massipipe reads; true for a log whose roll is right wing down.",
    ]
    head = "".join(f"# {said}\n" for said in comments)
    path.write_text(head + yaml.safe_dump(arguments, sort_keys=False, default_flow_style=None), encoding="utf-8")


def tilted_off_m(camera: "Camera", mounting: "Floats", place: str) -> float:
    """How far off (m) the worst place of a line is without a lever arm but its height, of roll or pitch by `_TILT_DEG`.

    mounting (4, 4): from the camera to the body, forward, right, down. The arm turns with the body: the camera stands
    beside the place that is taken for its own, and at another height, which counts as much as a ray looks aside. Rays
    that look up have no place; raises InputError for a camera with a pixel that has no ray.
    """
    import numpy as np

    from linepose.geometry.rotations import matrix_from_euler

    arm, looks = mounting[:3, 3], all_rays(camera, place) @ mounting[:3, :3].T
    worst = 0.0
    for roll, pitch in ((1, 0), (-1, 0), (0, 1), (0, -1)):
        body = matrix_from_euler(np.deg2rad([roll * _TILT_DEG, pitch * _TILT_DEG, 0.0]))
        shift, ray = body @ arm, looks @ body.T
        ray = ray[ray[:, 2] > 0]
        places = shift[:2] + ray[:, :2] / ray[:, 2:] * (arm[2] - shift[2])
        worst = max(worst, float(np.linalg.norm(places, axis=1).max(initial=np.hypot(*shift[:2]))))
    return worst


def centred_fan(camera: "Camera", place: str) -> tuple[float, "Floats", float]:
    """Field of view (rad) and matrix (3, 3) from massipipe's camera axes to ours, and the worst ray's error (px).

    Nearest to the rays of all pixels: a line that is tilted, or off the middle by little, is a fan that is turned.
    Raises InputError, naming `place`, where a ray is off by more than half a pixel.
    """
    import numpy as np
    from scipy.optimize import least_squares

    from linepose.geometry.rotations import matrix_from_rotation_vector

    ray, step = all_rays(camera, place), np.linspace(-1.0, 1.0, camera.n_pixels)
    seen = ray[:, :2] / ray[:, 2:]

    def turn(rotation: "Floats") -> "Floats":
        return np.asarray(matrix_from_rotation_vector(rotation) @ np.array(_AS_OURS))

    def off_px(values: "Floats") -> "Floats":
        fan = np.stack([0 * step, -values[3] * step, 0 * step + 1], axis=1) @ turn(values[:3]).T
        return np.asarray(((fan[:, :2] / fan[:, 2:] - seen) * camera.focal_length_px).ravel())

    start = np.array([0.0, 0.0, 0.0, np.ptp(seen[:, 0]) / 2])
    solved = start if np.abs(off_px(start)).max() < 1e-9 else least_squares(off_px, start, xtol=1e-15, ftol=1e-15).x
    worst_px = float(np.abs(off_px(solved)).max())
    if worst_px > _FARTHEST_PX:
        raise InputError(
            f"camera of {place}",
            f"rays that a fan at equal steps about its middle misses by {worst_px:.2f} px",
            f"{_FARTHEST_PX} px or less for massipipe",
            "export another format, such as json",
        )
    return float(2 * np.arctan(solved[3])), turn(solved[:3]), worst_px


FORMAT: Final = ExportFormat(
    "massipipe", "arguments of massipipe's orthorectifier for flat ground", "-massipipe.yaml", write_massipipe
)
