"""How well a camera is known."""

from typing import Annotated, Final, Self

from pydantic import AfterValidator, Field, NonNegativeFloat, PositiveFloat, model_validator

from linepose.geometry.lens import LARGEST_COEFFICIENT
from linepose.settings import Settings, SettingsError

ALWAYS_ESTIMATED: Final = ("principal_point_px", "focal_length_m")  # by the adjustment
LARGEST_FOCAL_SIGMA_M: Final = 1e3
_SMALLEST: Final = 1e-15  # whose weight can still be computed with


def _can_be_weighed(sigma: float) -> float:
    if 0 < sigma < _SMALLEST:
        raise ValueError(f"0, or {_SMALLEST:g} and more")
    return sigma


_Sigma = Annotated[NonNegativeFloat, AfterValidator(_can_be_weighed)]
_OfCoefficient = Annotated[_Sigma, Field(le=LARGEST_COEFFICIENT)]


class CameraSigmas(Settings):
    """One standard deviation of each camera quantity; units in the names, coefficients of the lens have none.

    The adjustment estimates the principal point, the focal length, and each coefficient whose sigma is not zero.

    Examples
    --------
    >>> import linepose
    >>> linepose.CameraSigmas(u_px=0.3).focal_length_m
    0.0001
    """

    u_px: PositiveFloat = Field(0.5, ge=1e-6, le=1e6, description="Of a point's position along the scan line (px).")
    v_px: PositiveFloat = Field(0.5, ge=1e-6, le=1e6, description="Of a point's position across the scan line (px).")
    principal_point_px: _Sigma = Field(2.0, le=1e6, description="Of the principal point (px).")
    focal_length_m: _Sigma = Field(
        1e-4,
        le=LARGEST_FOCAL_SIGMA_M,
        description="Of the focal length (m); 1 % of it where the camera is told by field_of_view_deg or view_angles.",
    )
    field_of_view_deg: PositiveFloat | None = Field(
        None, ge=1e-6, lt=180, description="In place of focal_length_m: of the field of view (deg)."
    )
    k1: _OfCoefficient = Field(0.0, description="Of the first radial distortion coefficient (no unit).")
    k2: _OfCoefficient = Field(0.0, description="Of the second radial distortion coefficient (no unit).")
    k3: _OfCoefficient = Field(0.0, description="Of the third radial distortion coefficient (no unit).")
    p2: _OfCoefficient = Field(0.0, description="Of the tangential distortion coefficient (no unit).")
    tilt: _OfCoefficient = Field(0.0, description="Of the line's tilt (no unit).")
    smile: _OfCoefficient = Field(0.0, description="Of the line's smile (no unit).")

    @model_validator(mode="after")
    def _has_one_of_the_scale(self) -> Self:
        if self.field_of_view_deg is not None and "focal_length_m" in self.model_fields_set:
            raise told_twice("focal_length_m", "field_of_view_deg")
        return self


def fault_of_certain(sigmas: CameraSigmas) -> SettingsError | None:
    """The fault of sigmas of 0 of what the adjustment always estimates, by their keys in a camera; None of none."""
    certain = [f"camera.sigmas.{name}" for name in ALWAYS_ESTIMATED if getattr(sigmas, name) == 0]
    if not certain:
        return None
    it, known = ("them", "they are") if len(certain) > 1 else ("it", "it is")
    expected, remedy = f"above 0, since the adjustment estimates {it}", f"give how well {known} known"
    return SettingsError("0", expected, remedy, " and ".join(certain))


def told_twice(first: str, second: str) -> SettingsError:
    """The fault of two keys that tell the same."""
    return SettingsError(f"{first} and {second}", "one of them", f"leave out {first} or {second}")
