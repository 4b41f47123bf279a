"""Whether an origin that the platform's file gives is that of the log's positions."""

from linepose.arrays import Floats
from linepose.check.finding import Finding, warning
from linepose.config.map_frame import MapFrameSection
from linepose.errors import InputError
from linepose.inputs.local_frame import check_local


def origin_findings(section: MapFrameSection | None, position_m: Floats) -> list[Finding]:
    """A warning where positions (K, 3) of a log lie too far from `map_frame.origin` for local coordinates (m)."""
    if section is None or section.origin is None:
        return []
    try:
        check_local(position_m, "map_frame.origin", "map_frame.crs")
    except InputError as fault:
        return [warning("map frame", f"{fault.place}: {fault.found}, expected {fault.expected}", fault.remedy)]
    return []
