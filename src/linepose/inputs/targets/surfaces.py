"""Planes that a target may lie in, before its place is known: facing the camera, lying flat, or standing upright.

A wrong distance or tilt stretches the map of a scan more in one direction than in the other, which detectors bear
within limits. So a few distances of each kind of plane are enough, whatever the target's true plane is.
"""

from collections.abc import Iterator
from typing import Final

import numpy as np

from linepose.arrays import Floats
from linepose.geometry.camera import Camera, normalised_from_pixel
from linepose.inputs.rectified.rectify import LinePoses
from linepose.inputs.rectified.surface import Surface
from linepose.survey.targets.base import GridSection

_STEP: Final = 1.4  # from one distance to the next
_MOST_DISTANCES: Final = 16
_LEAST_VIEW: Final = 0.25  # sine of the angle at which a plane must be looked at
_ALIKE: Final = 0.94  # cosine of the angle between planes that do for each other
_DOWN: Final = np.array([0.0, 0.0, 1.0])


def distances_m(target: GridSection, camera: Camera) -> Floats:
    """Distances (n,) at which a target can be found: from where it fills the scan line to where its details vanish."""
    artwork = target.artwork()
    assert artwork is not None
    ends = normalised_from_pixel(camera, [0.0, camera.n_pixels - 1.0])
    nearest = min(artwork.width_m, artwork.height_m) / float(ends[1] - ends[0])
    steps = np.log(max(farthest_m(target, camera) / nearest, 1.0)) / np.log(_STEP)
    return nearest * np.power(_STEP, np.arange(min(int(np.ceil(steps)) + 1, _MOST_DISTANCES)))


def farthest_m(target: GridSection, camera: Camera) -> float:
    """From where the smallest detail of a target just takes as many pixels as it must."""
    return min(detail.size_m / detail.n_pixels for detail in target.details()) * camera.focal_length_px


def candidate_surfaces(poses: LinePoses, distance_m: Floats) -> Iterator[tuple[tuple[int, int], Surface]]:
    """Planes at distances (n,) along the mean optical axis, each with its number: kind of plane, and distance."""
    axis, right = (_unit(poses.matrix[:, :, column].mean(axis=0)) for column in (2, 0))
    centre = poses.centre_m.mean(axis=0)
    level = axis - (axis @ _DOWN) * _DOWN
    aways = [axis, _DOWN, _unit(level) if np.linalg.norm(level) > _LEAST_VIEW else axis]
    for kind, away in enumerate(aways):
        if kind and not _LEAST_VIEW < away @ axis < _ALIKE:
            continue
        for number, one in enumerate(distance_m):
            yield (kind, number), plane(centre + one * axis, away, right)


def ground_at(poses: LinePoses, distance_m: float) -> Surface:
    """Level ground at this distance along the mean optical axis; the plane that faces a camera which looks level."""
    planes = {kind: one for (kind, _), one in candidate_surfaces(poses, np.array([distance_m]))}
    return planes.get(1, planes[0])


def plane(origin_m: Floats, away: Floats, right: Floats) -> Surface:
    """The plane through a point that is seen along `away`, with its first axis as near to `right` as it can be."""
    along = right - (right @ away) * away
    if np.linalg.norm(along) < _LEAST_VIEW:
        along = np.cross(away, right)
    along = _unit(along)
    return Surface(origin_m, np.stack([along, np.cross(away, along)]))


def _unit(vector: Floats) -> Floats:
    return np.asarray(vector / np.linalg.norm(vector))
