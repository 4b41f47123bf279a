"""The camera as it is in truth, beside the one that it is believed to be."""

import numpy as np

from linepose.geometry.camera import Camera


def drawn_camera(camera: Camera, level: float, random: np.random.Generator) -> Camera:
    """The camera with intrinsics drawn about those believed: `level` times the camera's sigmas.

    Principal point and focal length are drawn first, then each coefficient of the lens that has a sigma.
    """
    names = ("principal_point_px", "focal_length_m", *camera.uncertain_coefficients)
    off = level * random.standard_normal(len(names))
    moved = {
        name: getattr(camera, name) + one * getattr(camera.sigmas, name) for name, one in zip(names, off, strict=True)
    }
    return camera.replaced(**moved)
