"""The camera that a simulated platform has in truth, where it is another than the one that it is believed to have."""

from pydantic import Field, PositiveFloat

from linepose.geometry.camera import Camera
from linepose.settings import Settings


class TrueCamera(Settings):
    """Intrinsics of a simulated camera that differ from `camera`, which is what it is believed to be."""

    focal_length_m: PositiveFloat | None = Field(None, description="Focal length (m).")
    principal_point_px: float | None = Field(None, description="Principal point (px).")
    k1: float | None = Field(None, description="First radial distortion coefficient (no unit).")
    k2: float | None = Field(None, description="Second radial distortion coefficient (no unit).")
    k3: float | None = Field(None, description="Third radial distortion coefficient (no unit).")
    p2: float | None = Field(None, description="Tangential distortion coefficient (no unit).")
    tilt: float | None = Field(None, description="Slope of the line (no unit).")
    smile: float | None = Field(None, description="Bend of the line (no unit).")

    def instead_of(self, believed: Camera) -> Camera:
        """The camera that takes the scans, all else as it is believed to be."""
        return believed.replaced(**self.model_dump(exclude_none=True))
