"""What the options of `linepose new`, or answers, tell of a camera: one of three ways."""

from dataclasses import dataclass, replace
from pathlib import Path

from linepose.cli.answers import given, positive


@dataclass(frozen=True)
class ToldCamera:
    """Focal length with pixel pitch, the field of view, or a file of view angles; None where not told yet."""

    focal_length_mm: float | None = None
    pixel_pitch_um: float | None = None
    field_of_view_deg: float | None = None
    view_angles: Path | None = None

    def numbers(self) -> tuple[float | None, ...]:
        """Those that are numbers."""
        return self.focal_length_mm, self.pixel_pitch_um, self.field_of_view_deg

    def is_by_angles(self) -> bool:
        """Whether angles tell it."""
        return self.field_of_view_deg is not None or self.view_angles is not None

    def is_whole(self) -> bool:
        """Whether nothing is to be asked."""
        return self.is_by_angles() or None not in (self.focal_length_mm, self.pixel_pitch_um)

    @property
    def focal_length_m(self) -> float | None:
        """The focal length in metres."""
        return None if self.focal_length_mm is None else _scaled(self.focal_length_mm, 3)

    @property
    def pixel_pitch_m(self) -> float | None:
        """The pixel pitch in metres."""
        return None if self.pixel_pitch_um is None else _scaled(self.pixel_pitch_um, 6)


def check_one_way(camera: ToldCamera, principal_point_px: float | None) -> None:
    """Raise InputError for options that do not go together."""
    from linepose.errors import InputError

    ways = {
        "--focal-length-mm": camera.focal_length_mm,
        "--field-of-view-deg": camera.field_of_view_deg,
        "--view-angles": camera.view_angles,
    }
    told = [name for name, value in ways.items() if value is not None]
    if len(told) > 1:
        raise InputError("options", " with ".join(told), "one of them", "leave out what the data sheet does not give")
    if camera.is_by_angles() and camera.pixel_pitch_um is not None:
        raise InputError("options", f"--pixel-pitch-um with {told[0]}", "angles alone", "leave out --pixel-pitch-um")
    if camera.view_angles is not None and not camera.view_angles.exists():
        raise InputError(str(camera.view_angles), "no such file", "a CSV of view angles", "correct --view-angles")
    if camera.view_angles is not None and principal_point_px is not None:
        found = "--principal-point-px with --view-angles"
        raise InputError("options", found, "the table alone, which tells it", "leave out --principal-point-px")


def asked_camera(camera: ToldCamera) -> ToldCamera:
    """The camera with answers in place of what the options leave out."""
    if camera.focal_length_mm is None and not camera.is_by_angles():
        options = "--focal-length-mm, --field-of-view-deg or --view-angles"
        if camera.pixel_pitch_um is None:
            ask = "Focal length (mm); or the field of view, as in 38 deg; or a CSV of the pixels' view angles"
            camera = given(None, options, ask, _camera)
        else:
            camera = replace(camera, focal_length_mm=given(None, "--focal-length-mm", "Focal length (mm)", positive))
    if camera.is_whole():
        return camera
    return replace(
        camera, pixel_pitch_um=given(camera.pixel_pitch_um, "--pixel-pitch-um", "Pixel pitch (um)", positive)
    )


def _camera(text: str) -> ToldCamera:
    text = text.strip()
    number = text.removesuffix("deg").removesuffix("°")
    if number != text:
        return ToldCamera(field_of_view_deg=positive(number))
    if text and Path(text).is_file():
        return ToldCamera(view_angles=Path(text))
    try:
        return ToldCamera(focal_length_mm=positive(text.removesuffix("mm")))
    except ValueError:
        raise ValueError("expected a number (mm), an angle with deg, or a file that is there") from None


def _scaled(value: float, power: int) -> float:
    """The value over ten to this power, with no digit that the person did not give."""
    return float(f"{value:.15g}e-{power}")
