"""What to write in the platform file against a mistake: keys and values, which of them depends on the source."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from linepose.arrays import Floats
from linepose.check.conventions.mistakes import Mistake
from linepose.check.conventions.recording import Recording
from linepose.config.platform import Platform
from linepose.geometry.pose import euler_pose
from linepose.inputs.navigation.format import NavigationFormatSection
from linepose.inputs.navigation.registry import FORMATS
from linepose.inputs.source import ScansSection
from linepose.settings import validated
from linepose.survey.navigation_corrections import with_correction

_ANGLE_DECIMALS: Final = 4
_POSITION_DECIMALS: Final = 6


@dataclass(frozen=True)
class Remedy:
    """Keys of the platform file, their parts apart by dots, and the values to write there."""

    values: Mapping[str, Any]

    def in_words(self) -> str:
        """An imperative that can be followed to the letter: "set KEY: VALUE and KEY: VALUE"."""
        return "set " + " and ".join(f"{key}: {_yaml(value)}" for key, value in self.values.items())

    def applied(self, platform: Platform) -> Platform:
        """The platform with these values; raises InputError where it cannot have them."""
        values = platform.model_dump(mode="json")
        for key, value in self.values.items():
            *sections, last = key.split(".")
            below = values
            for name in sections:
                below = below[name]
            below[last] = value
        return validated(Platform, values, "platform file")


def remedies(mistake: Mistake, platform: Platform, recording: Recording) -> tuple[Remedy, ...]:
    """The ways to mend a mistake, the one that says most about the source first; `recording` is as given."""
    if mistake.clock_shift_s:
        return _of_clock(mistake, platform)
    if mistake.corrections:
        return (*_of_format(mistake, platform), _of_log(mistake, platform))
    return (_of_hand(mistake.undo(recording), recording, platform),)


def _of_clock(mistake: Mistake, platform: Platform) -> tuple[Remedy, ...]:
    source = platform.source
    if not isinstance(source, ScansSection):
        return ()
    return (Remedy({"source.time_offset_s": source.time_offset_s + mistake.clock_shift_s}),)


def _of_format(mistake: Mistake, platform: Platform) -> tuple[Remedy, ...]:
    """What the keys of the log's own format say of it."""
    source = platform.source
    section = source.navigation if isinstance(source, ScansSection) else None
    if not isinstance(section, NavigationFormatSection) or platform.navigation.corrections:
        return ()  # the keys of the format are of what is read before it is corrected
    ways = FORMATS.member(section.format).keys_against(section, mistake.corrections)
    return tuple(Remedy({f"source.navigation.{key}": value for key, value in way.items()}) for way in ways)


def _of_log(mistake: Mistake, platform: Platform) -> Remedy:
    corrections = with_correction(platform.navigation.corrections, mistake.corrections)
    return Remedy({"navigation.corrections": list(corrections)})


def _of_hand(undone: Recording, given: Recording, platform: Platform) -> Remedy:
    values: dict[str, Any] = {}
    position, euler_deg = _rounded(undone.pose)
    if not np.allclose(position, platform.hand_measured.position_m, atol=1e-6):
        values["hand_measured.position_m"] = position
    if not np.allclose(undone.pose[3:], given.pose[3:], atol=1e-6):
        values["hand_measured.euler_deg"] = euler_deg
    if undone.camera.view_angles != given.camera.view_angles:
        values["camera.view_angles"] = "the table with pixels counted from the other end and the signs of angles turned"
    elif undone.camera.principal_point_px != given.camera.principal_point_px:
        values["camera.principal_point_px"] = undone.camera.principal_point_px
    for name in ("p2", "smile"):
        if getattr(undone.camera, name) != getattr(given.camera, name):
            values[f"camera.{name}"] = getattr(undone.camera, name)
    return Remedy(values)


def _rounded(pose: Floats) -> tuple[list[float], list[float]]:
    """Position (m) and roll, pitch, yaw (deg) of a pose (6,) with a rotation vector, as a person writes them."""
    six = euler_pose(pose)
    position = np.round(six[:3], _POSITION_DECIMALS) + 0.0
    return position.tolist(), (np.round(np.degrees(six[3:]), _ANGLE_DECIMALS) + 0.0).tolist()


def _yaml(value: Any) -> str:
    """A value on one line of YAML."""
    if isinstance(value, list):
        return f"[{', '.join(_yaml(one) for one in value)}]"
    return value if isinstance(value, str) and value.isidentifier() else json.dumps(value)
