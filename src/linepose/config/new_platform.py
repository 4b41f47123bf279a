"""A new platform's file, written for a person to read on: every key with its unit, values from data sheet and tape."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Final, Literal, get_args, get_origin

import yaml

from linepose.config.file_text import descriptions, number, numbers, quoted
from linepose.config.names import check_name
from linepose.config.new_camera import NewCamera, camera_lines, camera_values, copy_table
from linepose.config.platform import NavigationSection, Platform
from linepose.config.target_file import target_text
from linepose.errors import InputError
from linepose.estimation.noise_models import DEFAULT
from linepose.inputs.navigation.format import NavigationFormatSection
from linepose.inputs.navigation.registry import FORMATS
from linepose.inputs.source import LabelledViewsSection, ScansSection
from linepose.settings import Settings, validated
from linepose.survey.hand_measured import HandMeasured
from linepose.survey.targets.base import TargetSection
from linepose.tables import atomic_write

Triple = tuple[float, float, float]


@dataclass(frozen=True)
class NewPlatform:
    """What a person knows of a new platform; units in the names, as in the platform file.

    The camera is told by focal length and pixel pitch, by its field of view, or by a file of view angles, which is
    copied beside the platform's. `navigation` is a file (CSV, Parquet) or, with `navigation_format`, a log in that
    format; for scans only. `navigation_keys` are what is known of the log's own keys. `target` is what the scans show.
    """

    name: str
    focal_length_m: float | None
    pixel_pitch_m: float | None
    n_pixels: int
    position_m: Triple
    euler_deg: Triple
    principal_point_px: float | None = None
    description: str = ""
    sigma_position_m: float = HandMeasured.model_fields["sigma_position_m"].default
    sigma_rotation_deg: float = HandMeasured.model_fields["sigma_rotation_deg"].default
    source: Literal["labelled_views", "scans"] = "labelled_views"
    dataset: str = ""
    navigation_format: str = ""
    navigation: str = ""
    navigation_keys: Mapping[str, Any] = field(default_factory=dict)
    target: TargetSection | None = None
    field_of_view_deg: float | None = None
    view_angles: Path | None = None

    @property
    def camera(self) -> NewCamera:
        """What is known of the camera."""
        return NewCamera(
            self.n_pixels,
            self.focal_length_m,
            self.pixel_pitch_m,
            self.field_of_view_deg,
            self.view_angles,
            f"{self.name}-view-angles.csv",
            self.principal_point_px,
        )


def platform_text(new: NewPlatform) -> str:
    """The platform file as YAML, each key commented; raises InputError for values that no platform has."""
    text = "\n".join(
        [
            *_head(new),
            *camera_lines(new.camera, f"{new.name}.yaml"),
            "",
            *_hand(new),
            "",
            *_noise_model(),
            "",
            *_navigation(new),
            "",
            *_source(new),
            "",
            *_target(new),
            *_experiments(),
            "",
        ]
    )
    values = yaml.safe_load(text)
    if new.view_angles is not None:
        values["camera"] |= camera_values(new.camera)
    validated(Platform, values, f"{new.name}.yaml")
    return text


def write_platform(folder: Path, new: NewPlatform, overwrite: bool = False) -> Path:
    """Write config/platforms/NAME.yaml, whole or not at all; raises InputError where it is there already."""
    path = folder / f"{check_name(new.name)}.yaml"
    if path.exists() and not overwrite:
        raise InputError(str(path), "a platform of this name", "a new name", "choose another, or give --force")
    text = platform_text(new)
    copy_table(new.camera, folder, overwrite)
    with atomic_write(path) as temporary:
        temporary.write_text(text, encoding="utf-8")
    return path


def files_of_source(source: LabelledViewsSection | ScansSection) -> list[str]:
    """The files, or patterns of files, that a source names."""
    if isinstance(source, LabelledViewsSection):
        return [source.views, source.covariances]
    navigation = source.navigation
    named = [source.scans, source.labels if source.points == "labels" else None]
    named += [navigation if isinstance(navigation, str) else navigation.file, source.covariances]
    return [name for name in named if name is not None]


def _head(new: NewPlatform) -> list[str]:
    return [
        f"# {new.name}. Every key, its unit and default: docs/configuration.md",
        f"# After a change of this file: linepose check {new.name}",
        "",
        f"description: {quoted(new.description or new.name)}",
        "",
    ]


def _hand(new: NewPlatform) -> list[str]:
    about = descriptions(HandMeasured)
    return [
        "hand_measured: # the start; body x forward, y right, z down; camera x along the scan line, z the optical axis",
        f"  position_m: {numbers(new.position_m)} # {about['position_m']}",
        f"  euler_deg: {numbers(new.euler_deg)} # {about['euler_deg']}",
        f"  sigma_position_m: {number(new.sigma_position_m)} # {about['sigma_position_m']}",
        f"  sigma_rotation_deg: {number(new.sigma_rotation_deg)} # {about['sigma_rotation_deg']}",
    ]


def _noise_model() -> list[str]:
    return [f"noise_model: {DEFAULT.name} # {DEFAULT.meaning}; docs/adjustment.md"]


def _navigation(new: NewPlatform) -> list[str]:
    about, default = descriptions(NavigationSection), NavigationSection()
    lines = [
        "navigation:",
        f"  covariance_columns: {list(default.covariance_columns)} # {about['covariance_columns']}",
        f"  maximum_gap_s: {number(default.maximum_gap_s)} # {about['maximum_gap_s']}",
    ]
    if new.source == "scans":
        lines += [
            f"  association: interpolate # {about['association']}",
            f"  maximum_pose_gap_s: {number(default.maximum_pose_gap_s)} # {about['maximum_pose_gap_s']}",
        ]
    return lines


def _source(new: NewPlatform) -> list[str]:
    lines = [
        "source:",
        f"  kind: {new.source}",
        f"  dataset: {quoted(new.dataset or new.name)} # folder below one of data_folders (config.yaml)",
    ]
    if new.source == "labelled_views":
        return [
            *lines,
            "  views: labelled_points/*.csv # one file a view, no heading, sorted by name; rows of",
            "  # time (us), point, u (px), north, east, down (m), roll, pitch, yaw (rad)",
            "  covariances: nav_covs.csv # rows of time (us) and the row-major 12x12 covariance",
        ]
    lines += [
        "  scans: scans/*.hdr # one a view, sorted by name: ENVI (.hdr), .png, .tif, with NAME-times.csv",
        *_points(new),
    ]
    if not new.navigation_format:
        log = new.navigation or "navigation.csv"
        lines += [
            "  # columns time_us (microseconds since 1970), north_m, east_m, down_m, roll_rad, pitch_rad, yaw_rad;",
            "  # a log with other columns or units: linepose new --navigation-format table, or docs/formats.md",
            f"  navigation: {quoted(log)}",
        ]
    else:
        lines += [
            "  navigation: # what each key means: docs/formats.md",
            f"    format: {new.navigation_format}",
            f"    file: {quoted(new.navigation or 'navigation.*')} # below the data set's folder",
            *_format_keys(FORMATS.member(new.navigation_format).section, new.navigation_keys),
        ]
    if not _has_covariances(new):
        of_log = "; not needed where the log holds sigmas" if new.navigation_format else ""
        lines.append(f"  covariances: covariances.csv # rows of time (us) and the row-major 12x12 covariance{of_log}")
    return lines


def _points(new: NewPlatform) -> list[str]:
    labels = "labels.csv # observation, point, u_px, line: make it with linepose label"
    if new.target is None:
        told = "or detection: dots found without labels; or matching: tie points where strips overlap"
        return [f"  points: labels # {told}", f"  labels: {labels}"]
    if new.target.artwork() is None:
        return [
            "  points: labels",
            f"  labels: {labels}",
            "  refinement: none # places are taken as they were labelled",
        ]
    return [
        "  points: detection # or labels: by hand, with linepose label",
        f"  # labels: {labels}",
        "  # target_range_m: 3.0 # from the camera to the target (m), for one that is not found at once",
    ]


def _target(new: NewPlatform) -> list[str]:
    return [] if new.target is None else [*target_text(new.target).splitlines(), ""]


def _has_covariances(new: NewPlatform) -> bool:
    """Whether the log itself holds covariances, so that no file of their own is named."""
    if not new.navigation_format:
        return False
    chosen = FORMATS.member(new.navigation_format)
    if not new.navigation_keys:
        return chosen.has_covariances
    section = chosen.section(**{"format": chosen.name, "file": new.navigation, **new.navigation_keys})
    columns = getattr(section, "columns", None)
    return chosen.has_covariances or getattr(columns, "sigma_position", None) is not None


def _format_keys(section: type[NavigationFormatSection], known: Mapping[str, Any]) -> list[str]:
    """The keys of a navigation format that are known, or else all that have a default, each with what it may be."""
    lines = []
    for key, of_key in section.model_fields.items():
        if known and key not in known:
            continue
        value = known.get(key, of_key.get_default(call_default_factory=True))
        if isinstance(value, Settings):
            value = value.model_dump(mode="json", exclude_none=True)
        is_set = value not in (None, ()) and (known or not of_key.is_required())
        if is_set and key not in NavigationFormatSection.model_fields:
            about = f"{_choices(of_key.annotation)}{of_key.description or ''}".rstrip(".")
            lines.append(f"    {key}: {quoted(value)} # {about}")
    return lines


def _choices(annotation: Any) -> str:
    """The values that a key may have, where they are few: "s, ms, us, ns: "."""
    return f"{', '.join(get_args(annotation))}: " if get_origin(annotation) is Literal else ""


_FEW_SPLITS: Final = 20  # the median of their distances is then known to 8 % (of 20 of a chi with 6 degrees)


def _experiments() -> list[str]:
    return [
        "experiments: # what else is worked out from the accepted observations; null leaves one out",
        "  basin: null # how wrong the hand measurement may be: takes minutes to hours; remove this line to run it",
        "  # how far the poses of random halves of the observations lie apart, and so what the sigmas are worth:",
        "  # the stage `splits`, some seconds a split on one core; more are finer (docs/configuration.md)",
        f"  repeatability: {{n_splits: {_FEW_SPLITS}}}",
    ]
