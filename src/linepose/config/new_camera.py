"""The camera's section of a new platform's file: only the keys that go with what its data sheet tells."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import atan, degrees, sin
from pathlib import Path
from typing import Any, Final

from linepose.config.file_text import descriptions, number, quoted
from linepose.config.view_angles import read_view_angles
from linepose.errors import InputError
from linepose.geometry.camera import Camera
from linepose.geometry.camera_sigmas import CameraSigmas
from linepose.settings import validated
from linepose.tables import atomic_write

_OF_LENS: Final = ("k1", "k2")
_OF_POINTS: Final = ("u_px", "v_px", "principal_point_px")


@dataclass(frozen=True)
class NewCamera:
    """What a data sheet tells: focal length and pixel pitch, the field of view, or a file of view angles.

    `view_angles` is the file that is read, `table_name` what its copy beside the platform's file is called.
    """

    n_pixels: int
    focal_length_m: float | None = None
    pixel_pitch_m: float | None = None
    field_of_view_deg: float | None = None
    view_angles: Path | None = None
    table_name: str = ""
    principal_point_px: float | None = None


def camera_lines(new: NewCamera, place: str) -> list[str]:
    """The section's rows; raises InputError, of `place`, for a camera that there is not."""
    about, default = descriptions(Camera), CameraSigmas()
    of_sigmas = descriptions(CameraSigmas)
    rows = _scale(new, place) | {"n_pixels": f"{new.n_pixels} # {about['n_pixels']}"}
    sigmas = {key: f"{number(getattr(default, key))} # {of_sigmas[key]}" for key in _OF_POINTS}
    if new.focal_length_m is None:
        sigmas["field_of_view_deg"] = f"{number(_sigma_of_field_deg(new))} # Of the field of view (deg)"
    else:
        sigmas["focal_length_m"] = f"{number(default.focal_length_m)} # Of the focal length (m)"
    if new.view_angles is None:
        rows["principal_point_px"] = f"{number(_principal_point_px(new))} # Where the optical axis meets the line (px)"
        rows |= {key: f"0.0 # {about[key]}" for key in _OF_LENS}
        sigmas |= {key: f"{number(getattr(default, key))} # {of_sigmas[key]}" for key in _OF_LENS}
    return [
        "camera: # from the data sheet, better from a calibration of the lens",
        *(f"  {key}: {row}" for key, row in rows.items()),
        f"  sigmas: # {about['sigmas']}",
        *(f"    {key}: {row}" for key, row in sigmas.items()),
    ]


def camera_values(new: NewCamera) -> dict[str, Any]:
    """The values of a camera that is told by angles, without its sigmas."""
    if new.view_angles is not None:
        table = read_view_angles(new.view_angles, new.n_pixels, "--view-angles", "--pixels")
        return {"n_pixels": new.n_pixels, "view_angles": table}
    principal_point_px = _principal_point_px(new)
    return {
        "n_pixels": new.n_pixels,
        "field_of_view_deg": new.field_of_view_deg,
        "principal_point_px": principal_point_px,
    }


def copy_table(new: NewCamera, folder: Path, overwrite: bool) -> None:
    """Put the file of view angles beside the platform's; raises InputError where another one is there already."""
    if new.view_angles is None:
        return
    path, content = folder / new.table_name, new.view_angles.read_bytes()
    if path.exists() and path.read_bytes() == content:
        return
    if path.exists() and not overwrite:
        raise InputError(str(path), "another table of this name", "none", "move it away, or give --force")
    with atomic_write(path) as temporary:
        temporary.write_bytes(content)


def _scale(new: NewCamera, place: str) -> dict[str, str]:
    if new.view_angles is not None:
        return {"view_angles": f"{quoted(new.table_name)} # View angle of each pixel, a file beside this one"}
    if new.field_of_view_deg is not None:
        return {"field_of_view_deg": f"{number(new.field_of_view_deg)} # Of the whole line, without distortion (deg)"}
    if new.focal_length_m is None or new.pixel_pitch_m is None:
        expected = "focal_length_m and pixel_pitch_m, field_of_view_deg, or view_angles"
        raise InputError(f"{place}: camera", "nothing that tells how far apart pixels look", expected, "give one")
    about: Mapping[str, str] = descriptions(Camera)
    return {
        "focal_length_m": f"{number(new.focal_length_m)} # {about['focal_length_m']}",
        "pixel_pitch_m": f"{number(new.pixel_pitch_m)} # {about['pixel_pitch_m']}",
    }


def _principal_point_px(new: NewCamera) -> float:
    return (new.n_pixels - 1) / 2 if new.principal_point_px is None else new.principal_point_px


def _sigma_of_field_deg(new: NewCamera) -> float:
    """Sigma of the field of view (deg), to two digits, of a camera that is told by angles alone."""
    camera = validated(Camera, camera_values(new), "options")
    field_rad = 2 * atan(camera.n_pixels / 2 / camera.focal_length_px)
    return float(f"{degrees(sin(field_rad) * camera.sigmas.focal_length_m / camera.focal_length_m):.2g}")
