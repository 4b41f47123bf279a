"""`linepose new NAME`: a commented platform file from options, or from answers to questions."""

import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

import typer

from linepose.cli.answers import given, positive, source_kind, triple, whole
from linepose.cli.camera_options import ToldCamera, asked_camera, check_one_way
from linepose.cli.options import HERE

if TYPE_CHECKING:
    from linepose.survey.targets.base import TargetSection

_OWN_PARQUET = "navigation.parquet"  # a log of our own, written into the platform's file where it is there


def new(
    name: Annotated[str, typer.Argument(metavar="NAME", help="Name of the platform: letters, digits, - and _.")],
    focal_length_mm: Annotated[float | None, typer.Option(help="Focal length (mm), with --pixel-pitch-um.")] = None,
    pixel_pitch_um: Annotated[float | None, typer.Option(help="Width of a pixel on the sensor (um).")] = None,
    field_of_view_deg: Annotated[
        float | None, typer.Option(help="In place of these two: field of view of the whole line (deg).")
    ] = None,
    view_angles: Annotated[
        Path | None,
        typer.Option(
            metavar="FILE", help="In place of these: a CSV with the view angle of each pixel (docs/conventions.md)."
        ),
    ] = None,
    pixels: Annotated[int | None, typer.Option(min=2, help="Pixels of a scan line.")] = None,
    principal_point_px: Annotated[
        float | None, typer.Option(help="Where the optical axis meets the line (px).", show_default="the middle")
    ] = None,
    position_m: Annotated[
        tuple[float, float, float] | None,
        typer.Option(metavar="X Y Z", help="Camera in the body frame by tape: forward, right, down (m)."),
    ] = None,
    euler_deg: Annotated[
        tuple[float, float, float] | None,
        typer.Option(metavar="R P Y", help="Camera to body by eye: roll, pitch, yaw, zyx intrinsic (deg)."),
    ] = None,
    sigma_position_m: Annotated[
        float | None,
        typer.Option(help="How well the tape was read, one sigma (m).", show_default="as docs/configuration.md says"),
    ] = None,
    sigma_rotation_deg: Annotated[
        float | None,
        typer.Option(
            help="How well the angles are known, one sigma (deg).", show_default="as docs/configuration.md says"
        ),
    ] = None,
    source: Annotated[
        Literal["labelled_views", "scans"] | None,
        typer.Option(help="What was recorded: points with poses, one CSV file a view; or scans and a raw log."),
    ] = None,
    dataset: Annotated[
        str | None, typer.Option(help="Folder of the platform's files below data/.", show_default="NAME")
    ] = None,
    navigation_format: Annotated[
        str | None,
        typer.Option(
            help="Format of the navigation log, for scans (docs/formats.md).", show_default="our own CSV or Parquet"
        ),
    ] = None,
    navigation: Annotated[str | None, typer.Option(help="File of the navigation log, for scans.")] = None,
    navigation_file: Annotated[
        Path | None,
        typer.Option(metavar="FILE", help="A navigation log to look into: its format and preset are taken from it."),
    ] = None,
    target: Annotated[
        str | None,
        typer.Option(
            metavar="FILE|KIND",
            help="What the scans show: a file with `target:`, as `linepose target` writes it, or a kind.",
            show_default="the paper's board",
        ),
    ] = None,
    description: Annotated[str | None, typer.Option(help="One line for people.")] = None,
    force: Annotated[bool, typer.Option("--force", help="Overwrite a platform file of this name.")] = False,
    project: Annotated[
        Path, typer.Option("--project", "-p", metavar="FOLDER", help="The project's folder.", show_default="here")
    ] = HERE,
) -> None:
    """Write a commented file for a platform of your own, and add it to config.yaml.

    Asks for what the options leave out. In a folder without a project, a minimal one is made.
    """
    from linepose.config.names import check_name
    from linepose.config.new_platform import NewPlatform, files_of_source, write_platform
    from linepose.config.platform import load_platform

    check_name(name)
    shown = None if target is None else _shown(target, source)
    source = source if shown is None else "scans"
    navigation_keys: dict[str, Any] = {}
    if navigation_file is not None:
        source = source or "scans"
        navigation_format, navigation_keys = _recognised(navigation_file, navigation_format)
    camera = ToldCamera(focal_length_mm, pixel_pitch_um, field_of_view_deg, view_angles)
    check_one_way(camera, principal_point_px)
    _check_numbers(*camera.numbers(), principal_point_px, *(position_m or ()), *(euler_deg or ()))
    asks = not camera.is_whole() or any(value is None for value in (pixels, position_m, euler_deg))
    root, platforms = _places(project)
    if (platforms / f"{name}.yaml").exists() and not force:
        _refuse(platforms / f"{name}.yaml")
    camera = asked_camera(camera)
    pixels = given(pixels, "--pixels", "Pixels of a scan line", whole)
    if asks and principal_point_px is None and camera.view_angles is None:
        ask = "Principal point (px; the middle if not known)"
        principal_point_px = given(None, "--principal-point-px", ask, positive, (pixels - 1) / 2)
    ask = "Camera in the body frame: forward right down (m), as in 0.2 0 -0.8"
    position_m = given(position_m, "--position-m", ask, triple)
    ask = "Camera to body: roll pitch yaw (deg), as in -56 0 -90"
    euler_deg = given(euler_deg, "--euler-deg", ask, triple)
    if asks and source is None:
        ask = "Recorded: labelled_views (points with poses) or scans (images and a raw log)"
        source = given(None, "--source", ask, source_kind, "labelled_views")
    if asks and dataset is None:
        dataset = given(None, "--dataset", "Folder of its files below data/", str, name)
    if asks and source == "scans" and navigation_format is None:
        from linepose.inputs.navigation.registry import FORMATS

        ask = f"Navigation log ({', '.join(FORMATS.names())})"
        navigation_format = given(None, "--navigation-format", ask, str, "table")
    if navigation_file is not None:
        navigation = navigation or _below(root / "data" / (dataset or name), navigation_file)
    elif not navigation_format and (root / "data" / (dataset or name) / _OWN_PARQUET).is_file():
        navigation = navigation or _OWN_PARQUET
    sigmas = {"sigma_position_m": sigma_position_m, "sigma_rotation_deg": sigma_rotation_deg}
    path = write_platform(
        platforms,
        NewPlatform(
            name=name,
            focal_length_m=camera.focal_length_m,
            pixel_pitch_m=camera.pixel_pitch_m,
            field_of_view_deg=camera.field_of_view_deg,
            view_angles=camera.view_angles,
            n_pixels=pixels,
            position_m=position_m,
            euler_deg=euler_deg,
            principal_point_px=principal_point_px,
            description=description or "",
            **{name: value for name, value in sigmas.items() if value is not None},
            source=source or "labelled_views",
            dataset=dataset or name,
            navigation_format=navigation_format or "",
            navigation=navigation or "",
            navigation_keys=navigation_keys,
            target=shown,
        ),
        force,
    )
    typer.echo(f"wrote {path}")
    _add_to_project(root, name)
    files = ", ".join(files_of_source(load_platform(platforms, name).source))
    typer.echo(f"next: put {files} into {root / 'data' / (dataset or name)}; {path.name} says what each must hold")
    typer.echo(f"then: linepose check {name}")


def _shown(target: str, source: str | None) -> "TargetSection":
    """The target of a file, or of a kind as it is by default."""
    from linepose.config.target_file import read_target
    from linepose.errors import InputError
    from linepose.survey.targets.registry import KINDS

    if source == "labelled_views":
        raise InputError("--target", "with --source labelled_views", "--source scans", "leave one of them out")
    if target in KINDS:
        return KINDS[target](kind=target)
    if not Path(target).suffix and not Path(target).is_file():
        raise InputError("--target", repr(target), f"a file, or one of {', '.join(KINDS)}", "correct it")
    return read_target(Path(target))


def _recognised(path: Path, chosen: str | None) -> tuple[str, dict[str, Any]]:
    """Name of a log's format and its keys, by what the file holds; the format that is chosen, where one is.

    The name is empty for our own table of poses, which needs no format.
    """
    from linepose.errors import InputError
    from linepose.inputs.navigation.log_file import is_own_log
    from linepose.inputs.navigation.registry import FORMATS, recognised

    if not path.exists():
        raise InputError(str(path), "no such file", "a navigation log", "correct --navigation-file")
    if chosen is None and is_own_log(path):
        typer.echo(f"{path}: linepose's own table of poses")
        return "", {}
    name, keys = recognised(path, chosen)
    if name is None:
        remedy = "give --navigation-format and --navigation instead (docs/formats.md)"
        raise InputError(str(path), "no log that is recognised", f"one of {', '.join(FORMATS.names())}", remedy)
    typer.echo(f"{path}: {', '.join([f'format {name}', *(f'{key} {value}' for key, value in keys.items())])}")
    return name, keys


def _below(folder: Path, path: Path) -> str:
    """A file's path below the folder of the platform's files; its name where it is not there yet."""
    whole = path.resolve()
    return whole.relative_to(folder.resolve()).as_posix() if whole.is_relative_to(folder.resolve()) else path.name


def _check_numbers(*values: float | None) -> None:
    from linepose.errors import InputError

    for value in (one for one in values if one is not None and not math.isfinite(one)):
        raise InputError("options", f"{value:g}", "finite numbers", "correct the option")


def _places(project: Path) -> tuple[Path, Path]:
    """The project's folder, or where one will be made, and its folder of platform files."""
    from linepose.config.yaml_file import read_yaml
    from linepose.errors import InputError
    from linepose.pipeline.project_folder import CONFIG, find_project

    try:
        root = find_project(project)
    except InputError:
        root = project.resolve()
        return root, root / "config" / "platforms"
    return root, root / str(read_yaml(root / CONFIG).get("platforms_folder", "config/platforms"))


def _refuse(path: Path) -> None:
    from linepose.errors import InputError

    raise InputError(str(path), "a platform of this name", "a new name", "choose another, or give --force")


def _add_to_project(root: Path, name: str) -> None:
    from linepose.config.new_project import add_platform, make_project
    from linepose.pipeline.project_folder import CONFIG

    if not (root / CONFIG).is_file():
        typer.echo(f"wrote {make_project(root, name)}")
    elif add_platform(root / CONFIG, name):
        typer.echo(f"added {name} to the platforms of {root / CONFIG}")
