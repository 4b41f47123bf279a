"""Where a survey lies on the Earth."""

from pydantic import Field, model_validator

from linepose.settings import Settings, SettingsError


class MapFrameSection(Settings):
    """Where on the Earth the survey's north, east and down are; for exports of mapped points only."""

    crs: str | None = Field(
        None,
        description="Projected reference system, in metres, whose northing and easting the positions are, such as "
        "EPSG:32756 (UTM zone 56 south, WGS84).",
    )
    origin: tuple[float, float, float] | None = Field(
        None,
        description="Or, of local positions, their origin: latitude, longitude (deg), ellipsoidal height (m), WGS84.",
    )

    @model_validator(mode="after")
    def _one_of_two(self) -> "MapFrameSection":
        if (self.crs is None) == (self.origin is None):
            found = "neither crs nor origin" if self.crs is None else "crs and origin"
            raise SettingsError(found, "one of them", "give one alone")
        return self
