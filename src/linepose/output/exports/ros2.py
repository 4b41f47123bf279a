"""A static transform for ROS 2: parameters in YAML, and above them the one line that publishes the same.

The parameters are those of the component `tf2_ros::StaticTransformBroadcasterNode`, whose node name is random, so they
are given for any node.
"""

import shlex
from pathlib import Path
from typing import TYPE_CHECKING, Final

from linepose.output.exports.words import explained
from linepose.pipeline.exports.format import ExportFormat
from linepose.pipeline.exports.options import ExportOptions

if TYPE_CHECKING:
    from linepose.pipeline.calibration import Calibration

_AXES = ("x", "y", "z")


def write_ros2(calibration: "Calibration", options: ExportOptions, path: Path) -> None:
    """Write the parameter file, the launch line in its second comment."""
    import yaml

    from linepose.output.exports.numbers import plain

    estimate = calibration.estimate.in_axes(options.body_axes or "flu")
    translation = dict(zip(_AXES, plain(estimate.pose[:3]), strict=True))
    w, x, y, z = plain(estimate.quaternion_wxyz)
    rotation = {"x": x, "y": y, "z": z, "w": w}
    parameters = {
        "frame_id": options.parent_frame,
        "child_frame_id": options.child_frame,
        "translation": translation,
        "rotation": rotation,
    }
    comments = [*explained(calibration, estimate), launch_line(options, translation, rotation)]
    head = "".join(f"# {line}\n" for line in comments)
    body = yaml.safe_dump({"/**": {"ros__parameters": parameters}}, sort_keys=False)
    path.write_text(head + body, encoding="utf-8")


def launch_line(options: ExportOptions, translation: dict[str, float], rotation: dict[str, float]) -> str:
    """The command that publishes the transform without the file."""
    from linepose.arrays import exact_decimal

    moved = [item for axis, value in translation.items() for item in (f"--{axis}", exact_decimal(value))]
    turned = [item for axis, value in rotation.items() for item in (f"--q{axis}", exact_decimal(value))]
    frames = ["--frame-id", options.parent_frame, "--child-frame-id", options.child_frame]
    return shlex.join(["ros2", "run", "tf2_ros", "static_transform_publisher", *moved, *turned, *frames])


FORMAT: Final = ExportFormat(
    "ros2", "ROS 2 static transform: parameters and launch line", "-transform.yaml", write_ros2
)
