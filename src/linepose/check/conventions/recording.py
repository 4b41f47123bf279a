"""What the doctor looks at: the observations, the camera and the hand-measured pose, and how to change them."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from linepose.arrays import Floats
from linepose.geometry import rotations
from linepose.geometry.camera import Camera
from linepose.survey.navigation_corrections import CORRECTIONS
from linepose.survey.observations import Survey


@dataclass(frozen=True)
class Recording:
    """A survey, the camera that made it, and the camera's hand-measured pose (6,) with a rotation vector."""

    survey: Survey
    camera: Camera
    pose: Floats


Change = Callable[[Recording], Recording]


def unchanged(recording: Recording) -> Recording:
    """The recording as it was given."""
    return recording


def corrected_navigation(names: Sequence[str]) -> Change:
    """A change by navigation.corrections of these names, one after the other, of poses and covariances."""

    def change(recording: Recording) -> Recording:
        survey = recording.survey
        for name in names:
            one = CORRECTIONS[name]
            survey = replace(
                survey,
                position_m=one.of_positions(survey.position_m),
                euler_rad=one.of_angles(survey.euler_rad),
                covariance=one.of_covariances(survey.covariance),
            )
        return replace(recording, survey=survey)

    return change


def changed_pose(change: Callable[[Floats, Floats], tuple[Floats, Floats]]) -> Change:
    """A change of the hand-measured position (3,) and rotation matrix (3, 3), camera to body."""

    def changed(recording: Recording) -> Recording:
        matrix = rotations.matrix_from_rotation_vector(recording.pose[3:])
        position, turned = change(recording.pose[:3], matrix)
        return replace(recording, pose=np.concatenate([position, rotations.rotation_vector_from_matrix(turned)]))

    return changed


def flipped_scan_line(recording: Recording) -> Recording:
    """Pixels counted from the other end of the line: the camera turned half about its axis, seen in a mirror."""
    turned = changed_pose(lambda position, matrix: (position, matrix @ np.diag([-1.0, -1.0, 1.0])))(recording)
    return replace(turned, camera=recording.camera.mirrored())
