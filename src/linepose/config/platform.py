"""The platform file: one camera on one vehicle, what it recorded, and how its data are to be read."""

import difflib
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import (
    BeforeValidator,
    Field,
    PositiveFloat,
    TypeAdapter,
    WithJsonSchema,
    field_validator,
    model_validator,
)

from linepose.arrays import Floats
from linepose.config.map import MapSection
from linepose.config.map_frame import MapFrameSection
from linepose.config.names import check_name
from linepose.config.outline import OutlineSection
from linepose.config.points import PointsSection
from linepose.config.simulated_files import check_simulated_files
from linepose.config.simulated_target import check_simulated_target
from linepose.config.view_angles import with_named_table, with_view_angles
from linepose.config.yaml_file import read_yaml
from linepose.errors import InputError
from linepose.estimation.noise_models import DEFAULT, MEANINGS, NoiseModelName, noise_model
from linepose.geometry.camera import Camera
from linepose.geometry.camera_sigmas import fault_of_certain
from linepose.geometry.pose import N_PARAMETERS
from linepose.inputs.source import LabelledViewsSection, ScansSection
from linepose.settings import Settings, SettingsError, faults_of, validated
from linepose.simulation.board import target_of
from linepose.simulation.flight_section import FlightSection
from linepose.simulation.settings import SimulationSettings, settings_from_dict
from linepose.simulation.true_camera import TrueCamera
from linepose.survey.hand_measured import HandMeasured
from linepose.survey.navigation_corrections import MEANINGS as MEANINGS_OF_CORRECTIONS
from linepose.survey.navigation_corrections import CorrectionName
from linepose.survey.targets.base import GridSection
from linepose.survey.targets.registry import Target
from linepose.survey.targets.rings import RingsSection

if TYPE_CHECKING:  # what computes is imported when it is needed: configuration is read by every command
    from linepose.likelihood.prior import PosePrior

AttitudeColumn = Annotated[int, Field(ge=3, le=11)]


class NavigationSection(Settings):
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
    corrections: tuple[CorrectionName, ...] = Field(
        (),
        description="What the log has otherwise than [conventions.md](conventions.md) says and no key of its format "
        "tells, undone in this order after reading, in poses and covariances alike (also of `source.covariances`); "
        f"`linepose check` names it. {MEANINGS_OF_CORRECTIONS}.",
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


class Platform(Settings):
    """One platform: a camera on a vehicle and what it recorded."""

    description: str = Field("", description="One line for people.")
    camera: Camera = Field(description="Intrinsic parameters.")
    hand_measured: HandMeasured = Field(description="The pose from the tape measure.")
    navigation: NavigationSection = Field(NavigationSection(), description="The navigation system.")
    source: LabelledViewsSection | ScansSection = Field(
        description="Where the observations come from.", discriminator="kind"
    )
    target: Target = Field(RingsSection(), description="What the scans show: by default the paper's board.")
    simulation: Simulation | None = Field(
        None, description="A simulated survey with a known truth: keys and units in linepose.simulation.settings."
    )
    flight: FlightSection | None = Field(
        None, description="Or a simulated flight over textured ground, with a known truth."
    )
    true_camera: TrueCamera | None = Field(
        None, description="Of a simulated platform: the camera in truth, where it is another than `camera`."
    )
    noise_model: NoiseModelName = Field(DEFAULT.name, description=f"The model of the noise. {MEANINGS}")
    prior: Literal["none", "hand_measured"] = Field(
        "hand_measured",
        description="hand_measured: the hand measurement is a Gaussian prior of the pose, not only the search's start. "
        "none: the data decide alone, as in the paper.",
    )
    points: PointsSection | None = Field(None, description="What is known of points beside their measurements.")
    map_frame: MapFrameSection | None = Field(None, description="Where the survey lies on the Earth.")
    map: MapSection | None = Field(
        None, description="Scans on the map, by every run and by `linepose map`; for scans only."
    )
    outline: OutlineSection | None = Field(None, description="A sketch of the platform for the figures.")
    experiments: dict[str, Any] = Field({}, description="Experiments on the accepted observations.")

    @model_validator(mode="after")
    def _has_one_origin(self) -> "Platform":
        origins = {"source.dataset": self.source.dataset, "simulation": self.simulation, "flight": self.flight}
        if len(given := [name for name, one in origins.items() if one is not None]) != 1:
            expected = "either source.dataset, or a simulation or flight with a source of kind scans"
            if not given:
                raise SettingsError("neither source.dataset nor a simulation or flight", expected, "give one of them")
            raise SettingsError(" and ".join(given), expected, "leave out all but one")
        if isinstance(self.source, ScansSection) and given[0] in ("simulation", "flight"):
            check_simulated_files(self.source, given[0])
        return self

    @model_validator(mode="after")
    def _has_scans_to_map(self) -> "Platform":
        if self.map is not None and not isinstance(self.source, ScansSection):
            found = f"map with source.kind {self.source.kind}"
            raise SettingsError(found, "source.kind scans: labelled views have no scans to map", "leave map out")
        return self

    @model_validator(mode="after")
    def _has_ground_to_match(self) -> "Platform":
        source = self.source
        if not isinstance(source, ScansSection) or source.points != "matching":
            return self
        ground = None if self.points is None else self.points.ground
        if source.matching.ground_height_m is None and ground is None:
            found, expected = "source.points matching alone", "source.matching.ground_height_m, or points.ground"
            raise SettingsError(found, expected, "add one of them")
        return self

    @property
    def true_pose(self) -> Floats | None:
        """The true pose (6,) of a simulated platform; None of any other."""
        if self.flight is not None:
            return self.flight.true_pose
        return None if self.simulation is None else np.array(self.simulation.true_pose)

    @model_validator(mode="after")
    def _can_use_target(self) -> "Platform":
        if not (isinstance(self.target, GridSection) and self.target.known):
            return self
        if noise_model(self.noise_model).removes_outliers:
            found = f"target.known with noise_model {self.noise_model}, which has no use for it"
            raise SettingsError(found, "noise_model adjustment", "leave target.known out, or change noise_model")
        if isinstance(self.source, ScansSection) and self.source.points == "matching":
            found = "target.known with source.points matching: tie points lie on no target"
            raise SettingsError(found, "source.points detection or labels", "leave target.known out")
        return self

    @property
    def knows_points(self) -> bool:
        """Whether something is known of points beside their measurements."""
        return self.points is not None or (isinstance(self.target, GridSection) and self.target.known)

    @model_validator(mode="after")
    def _can_use_points(self) -> "Platform":
        if self.points is not None and noise_model(self.noise_model).removes_outliers:
            found = f"points with noise_model {self.noise_model}, which has no use for them"
            raise SettingsError(found, "noise_model adjustment", "leave points out, or change noise_model")
        matched = isinstance(self.source, ScansSection) and self.source.points == "matching"
        if matched and self.points is not None and self.points.control_points is not None:
            found = "points.control_points with source.points matching: tie points have no names to be known by"
            remedy = "leave points.control_points out (points.ground may stay), or label the points"
            raise SettingsError(found, "source.points labels or detection", remedy)
        return self

    @model_validator(mode="after")
    def _describes_what_is_simulated(self) -> "Platform":
        if self.simulation is not None:
            check_simulated_target(self.target, target_of(self.simulation.board))
        return self

    @model_validator(mode="after")
    def _can_be_detected(self) -> "Platform":
        detected = isinstance(self.source, ScansSection) and self.source.points == "detection"
        if detected and self.target.artwork() is None:
            found = f"source.points: detection with target.kind {self.target.kind}, which has no pattern to find"
            raise SettingsError(found, "source.points: labels", "label the points by hand, or name the target's kind")
        return self

    @model_validator(mode="after")
    def _has_a_line_as_the_model_has(self) -> "Platform":
        if not noise_model(self.noise_model).removes_outliers:
            return self
        if not self.camera.lens.is_straight:
            found = f"a line that is tilted or bent with noise_model {self.noise_model}, which takes it for straight"
            raise SettingsError(found, "noise_model adjustment", "change noise_model, or the keys of camera")
        if others := [name for name in self.camera.uncertain_coefficients if name not in ("k1", "k2")]:
            found = f"camera.sigmas of {', '.join(others)} with noise_model {self.noise_model}, which has none"
            raise SettingsError(found, "noise_model adjustment", "change noise_model, or leave them out")
        return self

    @model_validator(mode="after")
    def _has_sigmas_that_the_model_weighs(self) -> "Platform":
        if noise_model(self.noise_model).removes_outliers:
            return self
        if fault := fault_of_certain(self.camera.sigmas):
            raise fault
        return self

    @model_validator(mode="after")
    def _is_simulated_where_it_has_a_truth(self) -> "Platform":
        if self.true_camera is not None and self.simulation is None and self.flight is None:
            expected = "a simulation or a flight with true_camera"
            raise SettingsError("true_camera of a platform that is not simulated", expected, "leave true_camera out")
        return self

    def intrinsics(self) -> Camera:
        """The camera that geometry works with."""
        return self.camera

    def true_intrinsics(self) -> Camera:
        """The camera that takes a simulated platform's scans."""
        return self.camera if self.true_camera is None else self.true_camera.instead_of(self.camera)

    def start_pose(self) -> Floats:
        """The hand-measured pose with a rotation vector (6,)."""
        return self.hand_measured.pose

    def start_covariance(self) -> Floats:
        """Covariance of the hand-measured pose with a rotation vector (6, 6)."""
        return self.hand_measured.covariance

    def hand_measurement(self) -> "PosePrior":
        """The hand-measured pose with its covariance, whether it counts as a prior or not."""
        from linepose.likelihood.prior import pose_prior

        return pose_prior(self.start_pose(), self.start_covariance())

    @property
    def n_unknown(self) -> int:
        """Parameters of the pose that the data alone must tell: none where the hand measurement is a prior."""
        return 0 if self.prior == "hand_measured" else N_PARAMETERS

    def pose_prior(self) -> "PosePrior | None":
        """The pose's prior; None where the data decide alone."""
        return self.hand_measurement() if self.prior == "hand_measured" else None


def load_platform(folder: Path, name: str) -> Platform:
    """The platform of config/platforms/NAME.yaml; `like: OTHER` takes all that the file does not say from OTHER's.

    Raises InputError for a file that is missing, is not YAML, or says something that no platform has.
    """
    return validated(Platform, _whole_values(folder, name), str(folder / f"{name}.yaml"))


def platform_faults(folder: Path, name: str) -> list[InputError]:
    """Every fault of config/platforms/NAME.yaml; none where `load_platform` would read it."""
    try:
        values = _whole_values(folder, name)
    except InputError as error:
        return [error]
    return faults_of(Platform, values, str(folder / f"{name}.yaml"))


def camera_keys(folder: Path, name: str) -> frozenset[str]:
    """The keys of the camera that config/platforms/NAME.yaml, or the platform that it is like, gives.

    Raises InputError as `load_platform` does.
    """
    camera = _whole_values(folder, name)["camera"]
    return frozenset(key for key, value in camera.items() if value is not None)


def _whole_values(folder: Path, name: str) -> dict[str, Any]:
    """All that a platform's file and those that it is like say, with the numbers of the camera's table."""
    seen: list[str] = []
    values = _merged_values(folder, name, seen)
    return with_view_angles(values, str(folder / f"{name}.yaml"), len(seen) > 1)


def _merged_values(folder: Path, name: str, seen: list[str]) -> dict[str, Any]:
    check_name(name, f"{folder / seen[-1]}.yaml: like" if seen else "platform's name")
    path = folder / f"{name}.yaml"
    if name in seen:
        raise InputError(f"{path}: like", f"a circle {' -> '.join([*seen, name])}", "an end", "remove one `like`")
    if not path.is_file():
        raise _no_such_platform(path, seen)
    seen.append(name)
    values = with_named_table(read_yaml(path), path)
    parent = values.pop("like", None)
    return values if parent is None else _overlaid(_merged_values(folder, parent, seen), values)


def _no_such_platform(path: Path, named_by: list[str]) -> InputError:
    known = sorted(file.stem for file in path.parent.glob("*.yaml"))
    near = difflib.get_close_matches(path.stem, known, n=1)
    remedy = f"did you mean {near[0]}? If not, " if near else "correct the name, or "
    remedy += f"write it with `linepose new {path.stem}`"
    if named_by:
        remedy = f"correct `like` in {named_by[-1]}.yaml"
    return InputError(str(path), "no such platform", f"one of {', '.join(known) or 'none'}", remedy)


def _overlaid(below: dict[str, Any], above: dict[str, Any]) -> dict[str, Any]:
    merged = dict(below)
    for key, value in above.items():
        both = isinstance(value, dict) and isinstance(below.get(key), dict)
        merged[key] = _overlaid(below[key], value) if both else value
    return merged
