"""How tie points are matched: the `matching` section of a source of scans."""

from pydantic import Field, PositiveFloat

from linepose.settings import Settings


class MatchingSection(Settings):
    """How tie points are found in overlapping strips without any label."""

    ground_height_m: float | None = Field(
        None,
        description="Height of the ground to begin with, as the positions count heights (m), to a tenth of the range; "
        "if not given, that of points.ground, of a height model the median below the strips.",
    )
    relief_m: PositiveFloat = Field(2.0, description="How far the ground lies off level within the survey (m).")
    n_points: int = Field(300, ge=10, le=100_000, description="Tie points that are kept, alike in all parts of strips.")
    n_features: int = Field(2500, ge=100, le=100_000, description="Features of a strip that are compared.")
    ratio: PositiveFloat = Field(
        0.8, le=1, description="How much more alike the best match is than the next one, for it to count."
    )
    rounds: int = Field(2, ge=1, le=5, description="How often strips are rectified at the pose at hand and matched.")
    cell_m: PositiveFloat | None = Field(
        None, description="Cell of the rectified strips in the last round (m); what a pixel sees if not given."
    )
