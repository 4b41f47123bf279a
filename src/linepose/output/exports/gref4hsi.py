"""The calibration file that gref4hsi reads: an XML of boresight, lever arm and line camera.

gref4hsi turns about z, y, x in this order, `R = Rz(rz) Ry(ry) Rx(rx)`, camera to body, with linepose's body axes. Its
pixels have their centres at 0.5, 1.5, ..., so cx counts from the first pixel's edge. Its distortion is a polynomial of
the distance d from cx in pixels, `x = (d - k3 d^2 - k2 d^3 - k1 d^5) / f`.
"""

import re
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Final

from linepose.errors import InputError
from linepose.output.exports.brown import FARTHEST_PX, require_straight
from linepose.output.exports.words import explained
from linepose.pipeline.exports.format import ExportFormat
from linepose.pipeline.exports.options import ExportOptions

if TYPE_CHECKING:
    from linepose.geometry.camera import Camera
    from linepose.pipeline.calibration import Calibration

EDGE_TO_CENTRE_PX: Final = 0.5


def write_gref4hsi(calibration: "Calibration", options: ExportOptions, path: Path) -> None:
    """Write the file; raises InputError for body axes, or a distortion, that gref4hsi cannot have."""
    from xml.etree import ElementTree

    from linepose.arrays import exact_decimal
    from linepose.geometry.rotations import euler_from_matrix

    if options.body_axes == "flu":
        raise InputError("body axes", "flu", "frd, which gref4hsi reads", "leave --body-axes out")
    estimate = calibration.estimate.in_axes("frd")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # at a pitch of 90 deg any roll with its yaw is the same rotation
        turn = euler_from_matrix(estimate.matrix[:3, :3])
    values = {
        **dict(zip(("rx", "ry", "rz"), map(float, turn), strict=True)),
        **dict(zip(("tx", "ty", "tz"), map(float, estimate.pose[:3]), strict=True)),
        **line_camera(calibration.own_camera, calibration.name),
    }
    root = ElementTree.Element("calibration")
    for said in explained(calibration, estimate):
        root.append(ElementTree.Comment(f" {re.sub('-(?=-)', '- ', said)} "))
    for name, value in values.items():
        ElementTree.SubElement(root, name).text = exact_decimal(value + 0.0)
    ElementTree.SubElement(root, "width").text = str(calibration.own_camera.n_pixels)
    ElementTree.indent(root)
    path.write_bytes(ElementTree.tostring(root, encoding="utf-8", xml_declaration=True) + b"\n")


def line_camera(camera: "Camera", place: str) -> dict[str, float]:
    """Values of f and cx (px), k1 (px^-4), k2 (px^-2), k3 (px^-1), nearest to the rays of all pixels.

    Raises InputError, naming `place`, where a ray is off by more than `FARTHEST_PX`.
    """
    import numpy as np

    from linepose.geometry.camera import normalised_from_pixel

    require_straight(camera, place, "gref4hsi")
    pixels = np.arange(camera.n_pixels)
    x, focal = normalised_from_pixel(camera, pixels), camera.focal_length_px
    cx = camera.principal_point_px + EDGE_TO_CENTRE_PX
    distance = pixels - camera.principal_point_px
    if np.allclose(x, distance / focal, rtol=0, atol=1e-12):
        return {"f": focal, "cx": cx, "k1": 0.0, "k2": 0.0, "k3": 0.0}
    scale = float(np.abs(distance).max())
    columns = np.stack([(distance / scale) ** power for power in (1, 2, 3, 5)], axis=1)
    solved = np.linalg.lstsq(columns, x, rcond=None)[0]
    off_px = float(np.abs(columns @ solved - x).max() * focal)
    if off_px > FARTHEST_PX:
        raise InputError(
            f"camera of {place}",
            f"a distortion that gref4hsi's k1, k2, k3 miss by {off_px:.2f} px",
            f"{FARTHEST_PX} px or less",
            "export another format, such as json",
        )
    by_pixel = solved / scale ** np.array([1, 2, 3, 5])
    f = 1.0 / by_pixel[0]
    k3, k2, k1 = -by_pixel[1:] * f
    return {"f": float(f), "cx": cx, "k1": float(k1), "k2": float(k2), "k3": float(k3)}


FORMAT: Final = ExportFormat("gref4hsi", "calibration file of gref4hsi", "-gref4hsi.xml", write_gref4hsi)
