"""What a simulated survey consists of: the `simulation` section of a platform file as frozen dataclasses.

Every quantity has its unit in its name. Inside angles are radians; a platform file may give any `..._rad` field as
`..._deg`, and `..._rad_s` as `..._deg_s`. World: north, east, down (m) from the survey origin. All fields are tuples,
so settings are hashable.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
from pydantic import ConfigDict, TypeAdapter, ValidationError

from linepose.errors import InputError
from linepose.survey.targets.registry import Target

Triple = tuple[float, float, float]
Sextuple = tuple[float, float, float, float, float, float]
_ZERO: Triple = (0.0, 0.0, 0.0)
_CLOSED = ConfigDict(extra="forbid", allow_inf_nan=False)
_DEGREES = re.compile("_deg(?=_s$|$)")


@dataclass(frozen=True)
class BoardSettings:
    """Pose of the pattern in the world: its centre, and board to world (board x along the rows, z away).

    `target` is what stands there, described as in a platform's file; none is the paper's board.
    """

    __pydantic_config__: ClassVar[ConfigDict] = _CLOSED
    position_m: Triple
    euler_rad: Triple
    target: Target | None = None


@dataclass(frozen=True)
class WaveSettings:
    """One sinusoidal wave of the ground's height, running towards `direction_rad` (clockwise from north)."""

    __pydantic_config__: ClassVar[ConfigDict] = _CLOSED
    amplitude_m: float
    wavelength_m: float
    direction_rad: float
    phase_rad: float = 0.0


@dataclass(frozen=True)
class GroundSettings:
    """The ground and how high above it the body's origin rides; no waves is flat, long ones are a hill."""

    __pydantic_config__: ClassVar[ConfigDict] = _CLOSED
    body_height_m: float
    waves: tuple[WaveSettings, ...] = ()


@dataclass(frozen=True)
class PassSettings:
    """One drive past the pattern, the arc of a constant speed and turn rate, given by its middle.

    Negative speed is reverse, no turn rate is straight, no speed is a rotation on the spot. `channel_roll_rad` is the
    roll that wheels in a channel add.
    """

    __pydantic_config__: ClassVar[ConfigDict] = _CLOSED
    north_m: float
    east_m: float
    heading_rad: float
    duration_s: float
    speed_m_s: float = 0.0
    turn_rate_rad_s: float = 0.0
    channel_roll_rad: float = 0.0


@dataclass(frozen=True)
class NavigationErrorSettings:
    """The true error of the navigation solution, the sum of three independent parts for each axis, as sigmas.

    Gauss-Markov with a correlation time, white from line to line, and constant in a view of the pattern.
    """

    __pydantic_config__: ClassVar[ConfigDict] = _CLOSED
    gauss_markov_position_m: Triple = _ZERO
    gauss_markov_euler_rad: Triple = _ZERO
    correlation_time_s: float = 60.0
    white_position_m: Triple = _ZERO
    white_euler_rad: Triple = _ZERO
    view_position_m: Triple = _ZERO
    view_euler_rad: Triple = _ZERO


@dataclass(frozen=True)
class ReportedSettings:
    """The sigmas that the navigation system reports, whatever its true error is."""

    __pydantic_config__: ClassVar[ConfigDict] = _CLOSED
    position_m: Triple
    euler_rad: Triple


@dataclass(frozen=True)
class FaultSettings:
    """What is wrong with one observation.

    `swapped_points` are pairs that carry each other's id, `missing_points` are covered, `clock_offset_s` is added to
    the scan's time stamps, and the jump is added to the navigation solution from the middle of the pass to its end.
    """

    __pydantic_config__: ClassVar[ConfigDict] = _CLOSED
    observation: int
    swapped_points: tuple[tuple[int, int], ...] = ()
    missing_points: tuple[int, ...] = ()
    clock_offset_s: float = 0.0
    jump_position_m: Triple = _ZERO
    jump_euler_rad: Triple = _ZERO

    @property
    def spoils_observation(self) -> bool:
        """Whether what remains of the observation is wrong, and not only less."""
        return bool(self.swapped_points or self.clock_offset_s or any(self.jump_position_m + self.jump_euler_rad))


@dataclass(frozen=True)
class ExtractionSettings:
    """How far off pattern points are found: sigmas along the scan line and across it, and of the rough labels."""

    __pydantic_config__: ClassVar[ConfigDict] = _CLOSED
    sigma_u_px: float = 0.2
    sigma_line: float = 0.5
    label_sigma_px: float = 1.0


@dataclass(frozen=True)
class ImageSettings:
    """The scan images: timing, resolution, brightness and noise.

    `ifov_rad` is the field of view of one pixel, both ways; it may exceed the pixels' spacing. Reflectances are
    between 0 and 1, the full scale is what reflectance 1 gives in light of strength 1. The lighting gradient is the
    relative change of the light per metre along the board's x and y. Exposure is a share of the line's period, margin
    one of the time from first to last point, rendered on both sides of them. Supersampling n takes n x n rays a pixel.
    """

    __pydantic_config__: ClassVar[ConfigDict] = _CLOSED
    ifov_rad: float
    line_rate_hz: float = 133.0
    n_bands: int = 4
    n_bits: int = 12
    supersampling: int = 6
    exposure_share: float = 0.8
    margin_share: float = 0.6
    full_scale_electrons: float = 20000.0
    read_noise_electrons: float = 40.0
    dark_reflectance: float = 0.05
    bright_reflectance: float = 0.80
    ground_reflectance: float = 0.25
    ground_contrast: float = 0.5
    ground_grain_m: float = 0.03
    backdrop_distance_m: float = 0.01
    lighting_gradient_per_m: tuple[float, float] = (0.15, -0.10)


@dataclass(frozen=True)
class SimulationSettings:
    """A whole simulated survey: observation k is the k-th pass, counted from 1.

    `true_pose` is the camera's in the body (m, rotation vector in rad); `transfer_s` lies between two passes;
    `origin_m` and `start_time_us` make positions and times look like a real platform's.
    """

    __pydantic_config__: ClassVar[ConfigDict] = _CLOSED
    seed: int
    true_pose: Sextuple
    board: BoardSettings
    ground: GroundSettings
    passes: tuple[PassSettings, ...]
    navigation_error: NavigationErrorSettings
    reported_sigma: ReportedSettings
    image: ImageSettings
    extraction: ExtractionSettings = field(default_factory=ExtractionSettings)
    faults: tuple[FaultSettings, ...] = ()
    navigation_rate_hz: float = 100.0
    transfer_s: float = 20.0
    start_time_us: int = 1_466_000_000_000_000
    origin_m: Triple = (6_248_550.0, 332_965.0, -42.0)


def settings_from_dict(section: Mapping[str, Any], place: str = "simulation") -> SimulationSettings:
    """The settings that a platform file's `simulation` section describes; angles in rad or, by name, in deg.

    Raises InputError that names the key where one is unknown, missing or of the wrong kind.
    """
    try:
        settings = TypeAdapter(SimulationSettings).validate_python(_in_radians(section))
    except ValidationError as error:
        first = error.errors()[0]
        key = ".".join(str(part) for part in first["loc"])
        raise InputError(f"{place}.{key}", repr(first["input"])[:60], first["msg"], "correct this key") from error
    for fault in settings.faults:
        if not 1 <= fault.observation <= len(settings.passes):
            raise InputError(
                f"{place}.faults",
                f"observation {fault.observation}",
                f"1 to {len(settings.passes)}",
                "name one of the passes; faults that come with `like` are left out by `faults: []`",
            )
    return settings


def _in_radians(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {
            _DEGREES.sub("_rad", str(key)): _radians(item) if _DEGREES.search(str(key)) else _in_radians(item)
            for key, item in value.items()
        }
    if isinstance(value, list | tuple):
        return [_in_radians(item) for item in value]
    return value


def _radians(value: Any) -> Any:
    try:
        return np.deg2rad(value).tolist()
    except (TypeError, ValueError):
        return value  # the check of kinds names the key
