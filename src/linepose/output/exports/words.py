"""The sentences that every exported pose carries, so that a file found alone explains itself."""

from typing import TYPE_CHECKING

from linepose.pipeline.exports.options import AXES_IN_WORDS

if TYPE_CHECKING:
    from linepose.geometry.pose_with_covariance import PoseWithCovariance
    from linepose.pipeline.calibration import Calibration

CAMERA_AXES = "x along the scan line, y across it, z the optical axis"


def explained(calibration: "Calibration", estimate: "PoseWithCovariance") -> list[str]:
    """Lines of a comment: what the pose is of, in which axes, how sure it is, and where it comes from.

    `estimate` is the pose in the axes that the file has.
    """
    sigma = estimate.sigma
    lines = [
        f"Pose of the line-scan camera of {calibration.name}, stage {calibration.stage}, from "
        f"{calibration.n_observations} observations (linepose, noise model {calibration.noise_model}).",
        f"Body axes: {AXES_IN_WORDS[estimate.body_axes]}. Camera axes: {CAMERA_AXES}.",
        "One sigma: position "
        + ", ".join(f"{value:.4f}" for value in sigma[:3])
        + " m, rotation vector "
        + ", ".join(f"{value:.5f}" for value in sigma[3:])
        + f" rad ({calibration.covariance_from}).",
    ]
    if calibration.intrinsics is not None:
        camera = calibration.own_camera
        others = [f", {name} {getattr(camera, name):.6g}" for name in calibration.intrinsics.names[2:]]
        lines.append(
            f"The camera adjusted with it, without which it is another pose: principal point "
            f"{camera.principal_point_px:.3f} px from the first pixel's centre, focal length "
            f"{camera.focal_length_m * 1e3:.5f} mm{''.join(others)}."
        )
    if estimate.body_axes == "flu":
        lines.insert(
            2,
            "Converted from x forward, y right, z down by a half turn about x: y and z of the body change sign, the "
            "camera's axes stay.",
        )
    return lines
