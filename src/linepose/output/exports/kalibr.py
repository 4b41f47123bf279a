"""A camchain in the YAML that Kalibr writes and visual-inertial software reads.

`T_cam_imu` takes body coordinates to camera coordinates, `x_cam = T_cam_imu x_body`: the inverse of linepose's pose.
The line is an image of one row: the pinhole's fv and pv belong to a row of no height, and radtan's k1 and k2 act along
the line as linepose's do.
"""

from pathlib import Path
from typing import TYPE_CHECKING, Final

from linepose.output.exports.brown import brown
from linepose.output.exports.words import explained
from linepose.pipeline.exports.format import ExportFormat
from linepose.pipeline.exports.options import ExportOptions

if TYPE_CHECKING:
    from linepose.pipeline.calibration import Calibration


def write_kalibr(calibration: "Calibration", options: ExportOptions, path: Path) -> None:
    """Write `cam0`: the transform, the intrinsics, and no time shift: the pose rests on the clocks as they are.

    Raises InputError for a lens that these coefficients cannot state.
    """
    import yaml

    from linepose.output.exports.numbers import plain

    camera = calibration.own_camera
    estimate = calibration.estimate.in_axes(options.body_axes or "frd")
    optics = brown(camera, calibration.name, has_k3=False)
    chain = {
        "cam0": {
            "camera_model": "pinhole",
            "intrinsics": plain([optics.focal_px, optics.focal_px, optics.centre_px, 0.0]),
            "distortion_model": "radtan",
            "distortion_coeffs": plain([optics.k1, optics.k2, optics.p1, optics.p2]),
            "resolution": [camera.n_pixels, 1],
            "rostopic": "/line_camera/image_raw",
            "timeshift_cam_imu": 0.0,
            "T_cam_imu": [plain(row) for row in estimate.inverse_matrix],
        }
    }
    comments = [
        *explained(calibration, estimate),
        "T_cam_imu takes body coordinates to camera coordinates: x_cam = T_cam_imu x_body.",
    ]
    head = "".join(f"# {line}\n" for line in comments)
    path.write_text(head + yaml.safe_dump(chain, sort_keys=False, width=200, default_flow_style=None), encoding="utf-8")


FORMAT: Final = ExportFormat("kalibr", "camchain as Kalibr writes it", "-camchain.yaml", write_kalibr)
