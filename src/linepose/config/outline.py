"""A platform's outline: a sketch for the figures, which no estimate uses."""

from pydantic import Field

from linepose.settings import Settings

Corner = tuple[float, float]


class OutlineViewSection(Settings):
    """One view of the platform in the body frame."""

    lines: list[list[Corner]] = Field([], description="Lines through points: across, down (m).")
    circles: list[tuple[float, float, float]] = Field([], description="Circles: across, down, radius (m).")


class OutlineSection(Settings):
    """The platform's outline from the side and from the front."""

    side: OutlineViewSection = Field(OutlineViewSection(), description="Across is forward.")
    front: OutlineViewSection = Field(OutlineViewSection(), description="Across is right.")
