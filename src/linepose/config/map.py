"""How scans are put on the map: the ground they show."""

from typing import Final, Literal

from pydantic import Field, NonNegativeFloat, PositiveFloat, PositiveInt, field_validator, model_validator

from linepose.settings import Settings, SettingsError

MAP_RESULTS: Final = ("map_budget", "map_scans", "strip_patches", "strip_fit")
"""Names of the tables that the workflow makes of the maps of a platform's scans."""


class GeotiffSection(Settings):
    """A cloud-optimised GeoTIFF of each scan on the map."""

    bands: list[PositiveInt] | Literal["all"] = Field(
        description="Bands of the scan, counted from 1, or `all`; a picture has one, the mean of its channels."
    )
    resampling: Literal["nearest", "bilinear"] = Field(
        "nearest",
        description="Of a cell: the value of the nearest pixel, or linear between the four around its centre.",
    )
    compression: Literal["none", "deflate", "zstd"] = Field("none", description="Of the file, without loss.")

    @field_validator("bands")
    @classmethod
    def _has_bands(cls, bands: list[int] | Literal["all"]) -> list[int] | Literal["all"]:
        if bands != "all" and (not bands or len(set(bands)) < len(bands)):
            raise ValueError("each band once, or `all`")
        return bands


class MapSection(Settings):
    """Scans on the map: the ground that they show."""

    ground: Literal["points", "height", "dem"] = Field(
        "points",
        description="What the rays meet: a plane through the estimated points, a flat ground of `height_m`, or the "
        "elevation model `dem`.",
    )
    height_m: float | None = Field(None, description="Height of a flat ground (m): minus its down coordinate.")
    dem: str | None = Field(
        None,
        description="Elevation model: path of a GeoTIFF below the data's folder, in the survey's projected system (or, "
        "of a survey in local coordinates, without a system: east, north), heights in metres.",
    )
    height_offset_m: float = Field(
        0.0,
        description="Added to the heights of `height_m` or `dem` to get those of the positions (m): the geoid's height "
        "where they count from sea level and the positions' from the ellipsoid.",
    )
    sigma_ground_m: NonNegativeFloat | None = Field(
        None,
        description="Sigma of the ground's height (m). If not given, that of the points' plane; 0.05 of a "
        "height or an elevation model.",
    )

    cell_m: PositiveFloat | None = Field(
        None,
        description="Side of a cell of the maps (m). If not given, the larger of the usual distances between "
        "neighbouring pixels and between neighbouring lines of the scan.",
    )
    geotiff: GeotiffSection | None = Field(None, description="Bands that are written as GeoTIFF; none if null.")

    @model_validator(mode="after")
    def _has_its_ground(self) -> "MapSection":
        for kind, key, value in (("height", "height_m", self.height_m), ("dem", "dem", self.dem)):
            if (self.ground == kind) != (value is not None):
                found = f"`ground: {self.ground}` {'without' if value is None else 'with'} {key}"
                remedy = f"add {key}" if value is None else f"leave {key} out, or write `ground: {kind}`"
                raise SettingsError(found, f"{key} with `ground: {kind}`, and without it none", remedy)
        if self.ground == "points" and self.height_offset_m:
            expected = "none with `ground: points`, whose heights are the positions' own"
            raise SettingsError(f"{self.height_offset_m:g}", expected, "leave it out", "height_offset_m")
        return self
