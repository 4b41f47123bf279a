"""The pose in JSON, with its covariance and the conventions in words: for code that reads all of it."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from linepose.output.exports.words import CAMERA_AXES
from linepose.pipeline.exports.format import ExportFormat
from linepose.pipeline.exports.options import AXES_IN_WORDS, ExportOptions

if TYPE_CHECKING:
    from linepose.pipeline.calibration import Calibration

VERSION: Final = 1


def write_json(calibration: "Calibration", options: ExportOptions, path: Path) -> None:
    """Write the pose as rotation vector, quaternion, Euler angles and matrix, with the rotation vector's covariance."""
    path.write_text(json.dumps(_content(calibration, options), indent=2) + "\n", encoding="utf-8")


def _content(calibration: "Calibration", options: ExportOptions) -> dict[str, Any]:
    from linepose.geometry.pose import POSE_COLUMNS
    from linepose.geometry.rotations import euler_from_rotation_vector
    from linepose.output.exports.numbers import plain

    estimate = calibration.estimate.in_axes(options.body_axes or "frd")
    pose, camera = estimate.pose, calibration.own_camera
    return {
        "format": "linepose pose",
        "version": VERSION,
        "platform": calibration.name,
        "stage": calibration.stage,
        "n_observations": calibration.n_observations,
        "noise_model": calibration.noise_model,
        "parent_frame": options.parent_frame,
        "child_frame": options.child_frame,
        "conventions": {
            "body_axes": AXES_IN_WORDS[estimate.body_axes],
            "camera_axes": CAMERA_AXES,
            "pose": "camera in the body: x_body = matrix x_camera, homogeneous",
            "rotation_vector": "angle (rad) times unit axis, camera to body",
            "euler": "roll, pitch, yaw (rad): R = Rz(yaw) Ry(pitch) Rx(roll), zyx intrinsic, xyz about fixed axes",
            "covariance": f"of the parameters in their order, m and rad; from {calibration.covariance_from}",
        },
        "camera": {
            "is_adjusted": calibration.intrinsics is not None,
            **camera.model_dump(mode="json", exclude={"sigmas"}, exclude_none=True),
        },
        "position_m": plain(pose[:3]),
        "rotation_vector_rad": plain(pose[3:]),
        "quaternion_wxyz": plain(estimate.quaternion_wxyz),
        "euler_rad": plain(euler_from_rotation_vector(pose[3:])),
        "matrix": [plain(row) for row in estimate.matrix],
        "parameters": list(POSE_COLUMNS),
        "sigma": plain(estimate.sigma),
        "covariance": [plain(row) for row in estimate.covariance],
    }


FORMAT: Final = ExportFormat("json", "pose with covariance and conventions", ".json", write_json)
