"""What is known of the points: the `points` section of a platform file."""

from typing import Final, Self

from pydantic import Field, model_validator

from linepose.settings import Settings, SettingsError

SMALLEST_SIGMA_M: Final = 1e-6
LARGEST_SIGMA_M: Final = 1e4


class GroundSection(Settings):
    """The ground on which tie points lie: one height, or a height model."""

    height_m: float | None = Field(None, description="Height of the ground, as the positions count heights (m).")
    dem: str | None = Field(
        None, description="Or a height model (GeoTIFF or what else rasterio reads), in the folder of the records."
    )
    sigma_m: float = Field(
        ge=SMALLEST_SIGMA_M,
        le=LARGEST_SIGMA_M,
        description="How far points lie off it, each for itself, as one sigma (m).",
    )
    shift_sigma_m: float | None = Field(
        None,
        ge=SMALLEST_SIGMA_M,
        le=LARGEST_SIGMA_M,
        description="How far it may lie too high or too low as a whole, as one sigma (m): estimated with the pose. "
        "Without it the heights are taken to err independently, which no height model does.",
    )
    height_offset_m: float = Field(
        0.0,
        description="Added to its heights to get those of the positions (m): the geoid's height where the model's "
        "count from sea level and the positions' from the ellipsoid.",
    )

    @model_validator(mode="after")
    def _one_of_two(self) -> Self:
        if (self.height_m is None) == (self.dem is None):
            found = "neither height_m nor dem" if self.height_m is None else "height_m and dem"
            raise SettingsError(found, "one of them", "give one alone")
        return self


class PointsSection(Settings):
    """What is known of points beside their measurements."""

    control_points: str | None = Field(
        None, description="CSV table of control points: id, coordinates, sigmas; in the folder of the records."
    )
    crs: str | None = Field(
        None,
        description="Reference system of the control points, such as EPSG:32756; the survey's own north, east, down "
        "if null.",
    )
    height_offset_m: float = Field(
        0.0, description="Added to the control points' heights to get those of the positions (m)."
    )
    ground: GroundSection | None = Field(None, description="The ground on which all other points lie.")

    @property
    def is_on_the_earth(self) -> bool:
        """Whether some of it is told in a reference system, so that the survey's place on the Earth is needed."""
        return self.crs is not None or (self.ground is not None and self.ground.dem is not None)
