"""The navigation formats by name: our own, and those that other packages bring (docs/formats.md)."""

from typing import Final

from linepose.config.navigation_formats import NavigationFormat, plugin_format
from linepose.inputs.navigation import novatel, resonon, rosbag, sbet, table

OWN: Final = {one.name: one for one in (table.FORMAT, novatel.FORMAT, sbet.FORMAT, rosbag.FORMAT, resonon.FORMAT)}


def navigation_format(name: str) -> NavigationFormat:
    """The format of this name; raises InputError naming the nearest one where there is none."""
    return OWN[name] if name in OWN else plugin_format(name)
