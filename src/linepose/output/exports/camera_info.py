"""Intrinsics for ROS: the YAML that camera_info_manager reads and publishes as sensor_msgs/CameraInfo.

A line is an image of one row whose v is 0. Pixel centres are at whole numbers from 0 in both. `plumb_bob` distorts an
ideal x as linepose does; a smile is its p1.
"""

from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from linepose.output.exports.brown import brown
from linepose.output.exports.words import explained
from linepose.pipeline.exports.format import ExportFormat
from linepose.pipeline.exports.options import ExportOptions

if TYPE_CHECKING:
    from linepose.pipeline.calibration import Calibration


def write_camera_info(calibration: "Calibration", options: ExportOptions, path: Path) -> None:
    """Write camera matrix, distortion, no rectification and the projection; the pose stands in the comments alone.

    Raises InputError for a lens that these coefficients cannot state.
    """
    import yaml

    camera = calibration.own_camera
    estimate = calibration.estimate.in_axes(options.body_axes or "flu")
    optics = brown(camera, calibration.name, has_k3=True)
    focal, centre = optics.focal_px, optics.centre_px
    info = {
        "image_width": camera.n_pixels,
        "image_height": 1,
        "camera_name": options.child_frame.replace("/", "_"),
        "camera_matrix": _matrix(3, [focal, 0.0, centre, 0.0, focal, 0.0, 0.0, 0.0, 1.0]),
        "distortion_model": "plumb_bob",
        "distortion_coefficients": _matrix(1, [optics.k1, optics.k2, optics.p1, optics.p2, optics.k3]),
        "rectification_matrix": _matrix(3, [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]),
        "projection_matrix": _matrix(3, [focal, 0.0, centre, 0.0, 0.0, focal, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]),
    }
    comments = [*explained(calibration, estimate), "The pose itself is in the export ros2, not here."]
    head = "".join(f"# {said}\n" for said in comments)
    path.write_text(head + yaml.safe_dump(info, sort_keys=False, width=200, default_flow_style=None), encoding="utf-8")


def _matrix(rows: int, values: list[float]) -> dict[str, Any]:
    return {"rows": rows, "cols": len(values) // rows, "data": values}


FORMAT: Final = ExportFormat("camera_info", "intrinsics for ROS camera_info", "-camera-info.yaml", write_camera_info)
