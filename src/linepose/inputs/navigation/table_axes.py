"""Which keys of the format `table` say of its axes and units what corrections would undo."""

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from linepose.inputs.navigation.table import TableSection

_OTHER = {"ned": "enu", "enu": "ned"}


def keys_against(section: "TableSection", corrections: Sequence[str]) -> list[dict[str, Any]]:
    """The one way in which the keys of a table say all that these corrections undo; none where they cannot."""
    way: dict[str, Any] = {}
    for name in corrections:
        found = _against(section, name)
        if found is None:
            return []
        way |= found
    return [way]


def _against(section: "TableSection", name: str) -> dict[str, Any] | None:
    of_attitude = section if section.attitude_log is None else section.attitude_log
    above = "" if section.attitude_log is None else "attitude_log."
    attitude = list(of_attitude.columns.attitude)
    if name == "attitude_axes":
        return {f"{above}attitude_axes": _OTHER[of_attitude.attitude_axes]}
    if name == "roll_pitch_swapped" and len(attitude) == 3:
        return {f"{above}columns.attitude": [attitude[1], attitude[0], attitude[2]]}
    if name in {"degrees", "radians_twice"}:
        unit = "degrees" if name == "degrees" else "radians"
        return None if of_attitude.angle_unit == unit else {f"{above}angle_unit": unit}
    if name == "positions_enu" and section.coordinates in _OTHER:
        return {"coordinates": _OTHER[section.coordinates]}
    if name == "north_east_swapped":
        first, second, third = section.columns.position
        return {"columns.position": [second, first, third]}
    return None
