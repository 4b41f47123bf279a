"""A fixed joint in URDF, in a robot of two links that loads on its own.

URDF's rpy turns about the parent's fixed axes x, y, z in this order, `R = Rz(yaw) Ry(pitch) Rx(roll)`: the same three
numbers as zyx intrinsic.
"""

import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Final

from linepose.output.exports.words import explained
from linepose.pipeline.exports.format import ExportFormat
from linepose.pipeline.exports.options import ExportOptions

if TYPE_CHECKING:
    from linepose.pipeline.calibration import Calibration


def write_urdf(calibration: "Calibration", options: ExportOptions, path: Path) -> None:
    """Write the joint from the body's link to the camera's, for `<xacro:include>` or to be copied into a robot."""
    from xml.etree import ElementTree

    from linepose.geometry.rotations import euler_from_matrix
    from linepose.output.exports.numbers import numbers

    estimate = calibration.estimate.in_axes(options.body_axes or "flu")
    parent, child = options.parent_frame, options.child_frame
    robot = ElementTree.Element("robot", name=calibration.name)
    for line in explained(calibration, estimate):
        robot.append(ElementTree.Comment(f" {line.replace('--', '- -')} "))
    for link in (parent, child):
        ElementTree.SubElement(robot, "link", name=link)
    joint = ElementTree.SubElement(robot, "joint", name=f"{parent}_to_{child}", type="fixed")
    transform = estimate.matrix
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # at a pitch of 90 deg any roll with its yaw is the same rotation
        rpy = euler_from_matrix(transform[:3, :3])
    ElementTree.SubElement(joint, "origin", xyz=numbers(transform[:3, 3]), rpy=numbers(rpy))
    ElementTree.SubElement(joint, "parent", link=parent)
    ElementTree.SubElement(joint, "child", link=child)
    ElementTree.indent(robot)
    path.write_bytes(ElementTree.tostring(robot, encoding="utf-8", xml_declaration=True) + b"\n")


FORMAT: Final = ExportFormat("urdf", "fixed joint from the body to the camera", ".urdf", write_urdf)
