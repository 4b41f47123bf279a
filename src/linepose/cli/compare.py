"""`linepose compare A B --range M`: how two calibrations differ, and what that moves on the ground."""

from typing import TYPE_CHECKING, Annotated

import typer

from linepose.cli.options import HERE, Name, ProjectFolder

if TYPE_CHECKING:
    from linepose.pipeline.comparison import Comparison


def compare(
    name: Name,
    other: Annotated[str, typer.Argument(metavar="OTHER", help="The platform that is compared with it.")],
    range_m: Annotated[float, typer.Option("--range", help="Distance of the ground from the camera (m).")],
    as_json: Annotated[bool, typer.Option("--json", help="Print all numbers as JSON instead.")] = False,
    project: ProjectFolder = HERE,
) -> None:
    """Tell how two finished platforms' poses differ: by number, in sigmas, and by what a pixel on the ground moves."""
    import json

    from linepose.cli.freshness import tell_outdated
    from linepose.errors import InputError
    from linepose.pipeline.calibration import Calibration
    from linepose.pipeline.comparison import compare as compared
    from linepose.pipeline.project_folder import find_project, load_platform_project

    root, calibrations = find_project(project), []
    for one in (name, other):
        loaded, folder = load_platform_project(one, root), root / "results" / one
        if not (folder / "pose.parquet").is_file():
            raise InputError(str(folder), "no result", "that of a run", f"linepose run {one}")
        calibrations.append(Calibration.from_results(folder, loaded.platforms[one], loaded.study.outliers.threshold_px))
        tell_outdated(loaded, root, one)
    found = compared(calibrations[0], calibrations[1], range_m)
    if as_json:
        typer.echo(json.dumps(found.as_dict(), indent=2, allow_nan=False))
        return
    for line in lines_of(found):
        typer.echo(line)


def lines_of(found: "Comparison") -> list[str]:
    """A comparison for people: each number, the tests, and the shift of three pixels."""
    from linepose.estimation.pose_change import GROUPS, in_words

    first, second = found.names
    lines = [f"{'':20s}{f'{second} - {first}':>24s}{'sigma':>12s}{'in sigmas':>12s}"]
    for number, row in found.table().iterrows():
        quantity, unit = in_words(str(number))
        digits = 4 if unit == "m" else 3
        cells = (f"{row['difference'] + 0.0:.{digits}f} {unit}", f"{row['sigma']:.{digits}f} {unit}")
        lines.append(f"{quantity:20s}{cells[0]:>24s}{cells[1]:>12s}{row['sigmas'] + 0.0:>+12.1f}")
    for group in GROUPS:
        one = found.change.test(group)
        chance = "" if found.n_shared_measurements else f", p = {one.p_value:.3g}"
        lines.append(f"{group:10s} {one.distance:.2f} sigmas apart{chance}")
    for place, row in found.pixels.iterrows():
        lines.append(
            f"{place} pixel at {found.range_m:g} m: {1e3 * row['along_m']:+.1f} +- {1e3 * row['sigma_along_m']:.1f} mm "
            f"along the line, {1e3 * row['across_m']:+.1f} +- {1e3 * row['sigma_across_m']:.1f} mm across it "
            f"({row['shift_px']:.2f} px)"
        )
    if found.n_shared_measurements:
        lines.append(
            f"both rest on the same {found.n_shared_measurements} measurements: how unlikely the difference is cannot "
            "be said, and its sigmas are too large"
        )
    if found.shares_hand_measurement:
        lines.append("both rest on the same hand measurement, which counts once")
    return lines
