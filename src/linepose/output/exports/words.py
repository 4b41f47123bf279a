"""The sentences that every exported pose carries, so that a file found alone explains itself."""

from linepose.output.exports.calibration import Calibration
from linepose.output.exports.options import AXES_IN_WORDS

CAMERA_AXES = "x along the scan line, y across it, z the optical axis"


def explained(calibration: Calibration) -> list[str]:
    """Lines of a comment: what the pose is of, in which axes, how sure it is, and where it comes from."""
    sigma = calibration.sigma()
    lines = [
        f"Pose of the line-scan camera of {calibration.platform}, stage {calibration.stage}, from "
        f"{calibration.n_observations} observations (linepose, noise model {calibration.noise_model}).",
        f"Body axes: {AXES_IN_WORDS[calibration.body_axes]}. Camera axes: {CAMERA_AXES}.",
        "One sigma: position "
        + ", ".join(f"{value:.4f}" for value in sigma[:3])
        + " m, rotation vector "
        + ", ".join(f"{value:.5f}" for value in sigma[3:])
        + f" rad ({calibration.covariance_from}).",
    ]
    if calibration.body_axes == "flu":
        lines.insert(
            2,
            "Converted from x forward, y right, z down by a half turn about x: y and z of the body change sign, the "
            "camera's axes stay.",
        )
    return lines
