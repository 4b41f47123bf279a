"""The focal length, and its sigma, of a camera that is told by its field of view or by a table of view angles.

What is wrong is left as it is, so that the settings tell its fault, and nothing else of what would follow from it.
"""

from collections.abc import Mapping
from typing import Any, Final

import numpy as np
from pydantic import ValidationError

from linepose.errors import InputError
from linepose.geometry.camera_sigmas import LARGEST_FOCAL_SIGMA_M, CameraSigmas, told_twice
from linepose.geometry.view_angles import ViewAngles
from linepose.settings import Settings, SettingsError

SMALLEST_FIELD_DEG: Final = 0.01
LARGEST_FIELD_DEG: Final = 179.0
_PITCH_M: Final = 1e-5  # where none is given: focal length over pitch is all that counts
_FOCAL_SHARE: Final = 0.01  # sigma of a focal length that is told by angles
_ALTERNATIVES: Final = ("focal_length_m", "field_of_view_deg", "view_angles")
_LEFT_OUT: Final = (*_ALTERNATIVES, "pixel_pitch_m", "principal_point_px")  # where they are null
_UNKNOWN: Final = {"focal_length_m": 1.0, "principal_point_px": 0.0}  # in place of what a faulty value would tell


class _Number(Settings):
    value: float


def in_metres(given: Mapping[str, Any]) -> dict[str, Any]:
    """A camera's values with the focal length in metres and its sigma; raises SettingsError where it is told twice."""
    values = {name: one for name, one in given.items() if one is not None or name not in _LEFT_OUT}
    told = [name for name in _ALTERNATIVES if name in values]
    if "field_of_view_deg" in told and len(told) > 1:
        raise told_twice(told[0], told[1])
    is_by_angles = bool(told) and "focal_length_m" not in told
    if is_by_angles:
        values = {"pixel_pitch_m": _PITCH_M} | values
        _check_sigmas(values.get("sigmas"), told[0])
        values = _by_field(values) if told == ["field_of_view_deg"] else _by_table(values)
    return values | {"sigmas": _sigmas(values, is_by_angles)} if "sigmas" in values or is_by_angles else values


def _check_sigmas(sigmas: Any, told_by: str) -> None:
    """Raise SettingsError for a sigma in metres, as a file has it, of a focal length that is none in metres."""
    given = sigmas if isinstance(sigmas, Mapping) else {}
    if given.get("focal_length_m") is not None and given.get("field_of_view_deg") is None:
        found = f"a sigma in metres of a camera that is told by {told_by}"
        remedy = f"leave it out, for {100 * _FOCAL_SHARE:g} % of the focal length, or give sigmas.field_of_view_deg"
        raise SettingsError(found, "one of its angle (deg), or none", remedy, "sigmas.focal_length_m")


def _by_field(values: dict[str, Any]) -> dict[str, Any]:
    field_deg = _number(values["field_of_view_deg"])
    if field_deg is None or not SMALLEST_FIELD_DEG <= field_deg <= LARGEST_FIELD_DEG:
        return {"focal_length_m": _UNKNOWN["focal_length_m"]} | values
    n_pixels, pitch_m = _number(values.get("n_pixels")), _number(values["pixel_pitch_m"])
    focal_m = n_pixels and pitch_m and float(n_pixels / 2 / np.tan(np.deg2rad(field_deg) / 2)) * pitch_m
    others = {name: one for name, one in values.items() if name != "field_of_view_deg"}
    return others | {"focal_length_m": focal_m or _UNKNOWN["focal_length_m"]}


def _by_table(values: dict[str, Any]) -> dict[str, Any]:
    table = values["view_angles"]
    try:
        table = table if isinstance(table, ViewAngles) else ViewAngles.model_validate(table)
    except (ValidationError, InputError):
        return _UNKNOWN | values
    pitch_m = _number(values["pixel_pitch_m"]) or 1.0
    return {"principal_point_px": table.principal_point_px, "focal_length_m": table.focal_length_px * pitch_m} | values


def _sigmas(values: Mapping[str, Any], is_by_angles: bool) -> Any:
    """The sigmas with that of the focal length; as they are where they tell it."""
    given = {} if values.get("sigmas") is None else values["sigmas"]
    if not isinstance(given, Mapping | CameraSigmas):
        return given
    sigmas = dict(given if isinstance(given, Mapping) else given.model_dump(exclude_unset=True))
    sigmas = {name: one for name, one in sigmas.items() if one is not None or name not in _ALTERNATIVES}
    focal_m, pitch_m, n_pixels = (_number(values.get(k)) for k in ("focal_length_m", "pixel_pitch_m", "n_pixels"))
    if "focal_length_m" in sigmas or not (focal_m and pitch_m and n_pixels):
        return sigmas
    if "field_of_view_deg" in sigmas:
        try:
            told = CameraSigmas.model_validate({"field_of_view_deg": sigmas["field_of_view_deg"]})
        except ValidationError:
            return sigmas
        del sigmas["field_of_view_deg"]
        field_rad = 2 * np.arctan(n_pixels / 2 * pitch_m / focal_m)
        sigma_m = focal_m * np.deg2rad(told.field_of_view_deg or np.nan) / np.sin(field_rad)
    elif is_by_angles:
        sigma_m = _FOCAL_SHARE * focal_m
    else:
        return sigmas
    return sigmas | {"focal_length_m": min(float(sigma_m), LARGEST_FOCAL_SIGMA_M)}


def _number(value: Any) -> float | None:
    """The number that settings take a value for; None of any other."""
    try:
        return _Number.model_validate({"value": value}).value
    except ValidationError:
        return None
