"""What the reader of an exported file may choose: names of the two frames, and the axes of the body."""

import re
from dataclasses import dataclass
from typing import Final, Literal, get_args

from linepose.errors import InputError

BodyAxes = Literal["frd", "flu"]  # as in linepose.geometry.pose_with_covariance, which takes scipy


AXES_IN_WORDS: Final[dict[BodyAxes, str]] = {
    "frd": "x forward, y right, z down",
    "flu": "x forward, y left, z up (ROS REP 103)",
}
_FRAME_NAME: Final = re.compile(r"[A-Za-z0-9_]([A-Za-z0-9_/.-]*[A-Za-z0-9_])?")


def export_options(parent_frame: str, child_frame: str, body_axes: str, scan: str = "") -> "ExportOptions":
    """The options that words of a command line give; no body axes for those of the format, no scan for the only one."""
    axes: dict[str, BodyAxes | None] = {"": None, "frd": "frd", "flu": "flu"}
    if body_axes not in axes:
        raise InputError("body axes", repr(body_axes), "frd or flu", "correct it")
    return ExportOptions(parent_frame, child_frame, axes[body_axes], scan or None)


@dataclass(frozen=True)
class ExportOptions:
    """Names of the body's and the camera's frame, and the body's axes; none for what the format is used with.

    `scan` names the scan of a format that holds scans, without its ending; none for the only one, or for all
    in a format that can hold them.

    Raises InputError for a name that ROS would not take, for two equal names, and for unknown axes.
    """

    parent_frame: str = "base_link"
    child_frame: str = "line_camera_optical"
    body_axes: BodyAxes | None = None
    scan: str | None = None

    def __post_init__(self) -> None:
        for key, name in (("parent frame", self.parent_frame), ("child frame", self.child_frame)):
            if not _FRAME_NAME.fullmatch(name) or "--" in name:
                raise InputError(key, repr(name), "letters, digits, _ / . - in between", "choose another name")
        if self.parent_frame == self.child_frame:
            raise InputError("child frame", repr(self.child_frame), "not the parent's name", "choose another name")
        if self.body_axes is not None and self.body_axes not in get_args(BodyAxes):
            raise InputError("body axes", repr(self.body_axes), "frd or flu", "correct it")
