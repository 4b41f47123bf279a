"""The platform file: one camera on one vehicle, what it recorded, and how its data are to be read."""

import difflib
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
import yaml
from pydantic import (
    BeforeValidator,
    Field,
    PositiveFloat,
    PositiveInt,
    TypeAdapter,
    WithJsonSchema,
    field_validator,
    model_validator,
)

from linepose.arrays import Floats
from linepose.config.experiments import ExperimentsSection
from linepose.config.map_frame import MapFrameSection
from linepose.config.outline import OutlineSection
from linepose.config.schema import Section, faults_of, validated
from linepose.config.source import LabelledViewsSection, ScansSection
from linepose.errors import InputError
from linepose.geometry.camera import Camera, CameraSigmas
from linepose.geometry.pose import rotation_vector_covariance, rotation_vector_pose
from linepose.likelihood.names import NoiseModelName
from linepose.likelihood.prior import PosePrior, pose_prior
from linepose.simulation.settings import SimulationSettings, settings_from_dict

Triple = tuple[float, float, float]
NonNegative = Annotated[float, Field(ge=0)]
AttitudeColumn = Annotated[int, Field(ge=3, le=11)]


class SigmasSection(Section):
    """One standard deviation of each camera quantity."""

    u_px: PositiveFloat = Field(0.5, description="Of a point's position along the scan line (px).")
    v_px: PositiveFloat = Field(0.5, description="Of a point's position across the scan line (px).")
    principal_point_px: NonNegative = Field(2.0, description="Of the principal point (px).")
    focal_length_m: NonNegative = Field(1e-4, description="Of the focal length (m).")
    k1: NonNegative = Field(0.0, description="Of the first radial distortion coefficient (no unit).")
    k2: NonNegative = Field(0.0, description="Of the second radial distortion coefficient (no unit).")


class CameraSection(Section):
    """Intrinsic parameters of the line-scan camera."""

    focal_length_m: PositiveFloat = Field(description="Focal length (m).")
    pixel_pitch_m: PositiveFloat = Field(description="Width of a pixel on the sensor (m).")
    n_pixels: PositiveInt = Field(description="Pixels of a scan line.")
    principal_point_px: float = Field(description="Where the optical axis meets the line (px, counted from 0).")
    k1: float = Field(0.0, description="First radial distortion coefficient (no unit).")
    k2: float = Field(0.0, description="Second radial distortion coefficient (no unit).")
    sigmas: SigmasSection = Field(SigmasSection(), description="One standard deviation of each.")

    def intrinsics(self) -> Camera:
        """The camera that geometry works with."""
        values = self.model_dump()
        return Camera(**(values | {"sigmas": CameraSigmas(**values["sigmas"])}))


class HandMeasuredSection(Section):
    """The camera's pose on the vehicle as read from a tape measure: the start of the search."""

    position_m: Triple = Field(description="Camera in the body frame: forward, right, down (m).")
    euler_deg: Triple = Field(description="Camera to body: roll, pitch, yaw, zyx intrinsic (deg).")
    sigma_position_m: PositiveFloat = Field(0.1, description="One standard deviation of each coordinate (m).")
    sigma_euler_deg: PositiveFloat = Field(2.0, description="One standard deviation of each angle (deg).")


class NavigationSection(Section):
    """How the navigation system's solution is read."""

    covariance_columns: tuple[AttitudeColumn, AttitudeColumn, AttitudeColumn] = Field(
        (3, 4, 5), description="Rows and columns of the 12x12 covariance that hold roll, pitch, yaw (counted from 0)."
    )
    maximum_gap_s: PositiveFloat = Field(
        1.0, description="Largest time between a point and the covariance used for it (s)."
    )

    maximum_pose_gap_s: PositiveFloat = Field(
        0.1, description="Largest gap in a raw log around a point's time (s); for scans only."
    )
    association: Literal["nearest", "interpolate"] = Field(
        "nearest",
        description="Pose of a point from a raw log: of the nearest time stamp, as in the paper, or interpolated; "
        "for scans only.",
    )

    @field_validator("covariance_columns")
    @classmethod
    def _are_different(cls, columns: tuple[int, int, int]) -> tuple[int, int, int]:
        if len(set(columns)) < len(columns):
            raise ValueError("three different columns")
        return columns


def _simulation(values: Any) -> Any:
    if not isinstance(values, Mapping):
        return values
    try:
        return settings_from_dict(values, "simulation")
    except InputError as error:
        if error.expected != _UNKNOWN_KEY:
            raise
        near = difflib.get_close_matches(error.place.rsplit(".", 1)[-1], _keys(SimulationSettings), n=1)
        remedy = f"did you mean {near[0]}?" if near else "remove it"
        raise InputError(error.place, "an unknown key", "a key of linepose.simulation.settings", remedy) from None


_UNKNOWN_KEY = "Unexpected keyword argument"  # pydantic's words for what a closed dataclass has no field for


def _keys(settings: type) -> list[str]:
    """Every key below these settings."""
    schema = TypeAdapter(settings).json_schema()
    return sorted({key for part in (schema, *schema["$defs"].values()) for key in part["properties"]})


# closed by its own check; the keys, with units in their names, are the fields of the settings' classes
Simulation = Annotated[SimulationSettings, BeforeValidator(_simulation), WithJsonSchema({"type": "object"})]


class Platform(Section):
    """One platform: a camera on a vehicle and what it recorded."""

    description: str = Field("", description="One line for people.")
    camera: CameraSection = Field(description="Intrinsic parameters.")
    hand_measured: HandMeasuredSection = Field(description="The pose from the tape measure.")
    navigation: NavigationSection = Field(NavigationSection(), description="The navigation system.")
    source: LabelledViewsSection | ScansSection = Field(
        description="Where the observations come from.", discriminator="kind"
    )
    simulation: Simulation | None = Field(
        None, description="A simulated survey with a known truth: keys and units in linepose.simulation.settings."
    )
    noise_model: NoiseModelName = Field(
        "published",
        description="The likelihood's model of the noise. published: every line of a view errs independently, as "
        "reported (the paper). shared: the navigation error is common to a view, its level inferred. "
        "balanced: shared, without the determinants' pull on the pose (recommended). robust: shared, with heavy tails "
        "for bad views and points.",
    )
    prior: Literal["none", "hand_measured"] = Field(
        "none",
        description="hand_measured: the hand measurement is a Gaussian prior of the pose, not only the search's start. "
        "none: the data decide alone, as in the paper.",
    )
    published: Literal["ladybird", "ladybird_attitude", "ladybird_simulated", "shrimp_simulated"] | None = Field(
        None,
        description="The published numbers that the results are held against, if any; the noise model must be the "
        "published one for that.",
    )

    map_frame: MapFrameSection | None = Field(None, description="Where the survey lies on the Earth.")
    outline: OutlineSection | None = Field(None, description="A sketch of the platform for the figures.")
    experiments: ExperimentsSection = Field(
        ExperimentsSection(), description="Experiments on the accepted observations."
    )

    @model_validator(mode="after")
    def _has_one_origin(self) -> "Platform":
        if (self.simulation is None) == (self.source.dataset is None):
            raise ValueError("either source.dataset, or a simulation with a source of kind scans")
        return self

    @model_validator(mode="after")
    def _has_a_log_for_a_clock_offset(self) -> "Platform":
        if self.experiments.clock_offset is not None and self.source.kind != "scans":
            raise ValueError(
                "no experiments.clock_offset here: labelled views hold body poses and no log; a source of kind scans "
                "has one"
            )
        return self

    def intrinsics(self) -> Camera:
        """The camera that geometry works with."""
        return self.camera.intrinsics()

    def start_pose(self) -> Floats:
        """The hand-measured pose with a rotation vector (6,)."""
        return rotation_vector_pose(self._hand_measured_euler_pose())

    def start_covariance(self) -> Floats:
        """Covariance of the hand-measured pose with a rotation vector (6, 6)."""
        hand = self.hand_measured
        sigma = np.repeat([hand.sigma_position_m, np.deg2rad(hand.sigma_euler_deg)], 3)
        return rotation_vector_covariance(self._hand_measured_euler_pose(), np.diag(sigma**2))

    def hand_measurement(self) -> PosePrior:
        """The hand-measured pose with its covariance, whether it counts as a prior or not."""
        return pose_prior(self.start_pose(), self.start_covariance())

    def pose_prior(self) -> PosePrior | None:
        """The pose's prior; None where the data decide alone."""
        return self.hand_measurement() if self.prior == "hand_measured" else None

    def _hand_measured_euler_pose(self) -> Floats:
        return np.concatenate([self.hand_measured.position_m, np.deg2rad(self.hand_measured.euler_deg)])


def load_platform(folder: Path, name: str) -> Platform:
    """The platform of config/platforms/NAME.yaml; `like: OTHER` takes all that the file does not say from OTHER's.

    Raises InputError for a file that is missing, is not YAML, or says something that no platform has.
    """
    return validated(Platform, _merged_values(folder, name, []), str(folder / f"{name}.yaml"))


def platform_faults(folder: Path, name: str) -> list[InputError]:
    """Every fault of config/platforms/NAME.yaml; none where `load_platform` would read it."""
    try:
        values = _merged_values(folder, name, [])
    except InputError as error:
        return [error]
    return faults_of(Platform, values, str(folder / f"{name}.yaml"))


def _merged_values(folder: Path, name: str, seen: list[str]) -> dict[str, Any]:
    path = folder / f"{name}.yaml"
    if name in seen:
        raise InputError(f"{path}: like", f"a circle {' -> '.join([*seen, name])}", "an end", "remove one `like`")
    values = read_yaml(path)
    parent = values.pop("like", None)
    return values if parent is None else _overlaid(_merged_values(folder, parent, [*seen, name]), values)


def _overlaid(below: dict[str, Any], above: dict[str, Any]) -> dict[str, Any]:
    merged = dict(below)
    for key, value in above.items():
        both = isinstance(value, dict) and isinstance(below.get(key), dict)
        merged[key] = _overlaid(below[key], value) if both else value
    return merged


def read_yaml(path: Path) -> dict[str, Any]:
    """A YAML file's mapping; raises InputError for a file that is missing, broken, or holds something else."""
    if not path.is_file():
        near = sorted(p.stem for p in path.parent.glob("*.yaml"))
        raise InputError(
            str(path), "no such file", f"one of {', '.join(near) or 'none'}", "create it or correct the name"
        )
    try:
        values = yaml.safe_load(path.read_bytes())
    except yaml.YAMLError as error:
        raise InputError(str(path), " ".join(str(error).split()), "YAML", "correct the file") from None
    if not isinstance(values, dict):
        raise InputError(str(path), type(values).__name__, "keys and values", "write `key: value` lines")
    return values
