"""`linepose target`: a target to print, true to scale, and its description for a platform's file."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Final

import typer

if TYPE_CHECKING:
    from linepose.output.printing.paper import Paper
    from linepose.survey.targets.base import GridSection


_DEFAULT: Final = "rings"
_TOO_LARGE_MM: Final = 1e4  # for a spacing


def _tell_kinds(asked: bool) -> None:
    if asked:
        from linepose.survey.targets.registry import KINDS, PRINTED

        for name, section in KINDS.items():
            typer.echo(f"{name:12s}{section.title}{'' if name in PRINTED else ' (nothing to print)'}")
        raise typer.Exit


def target(
    kind: Annotated[str, typer.Option(help="One of those that --list tells.")] = _DEFAULT,
    rows: Annotated[
        int | None, typer.Option(min=1, help="Rows of rings, dots, squares or tags.", show_default="of the kind")
    ] = None,
    columns: Annotated[int | None, typer.Option(min=1, help="Columns of them.", show_default="of the kind")] = None,
    spacing_mm: Annotated[
        float | None,
        typer.Option(
            help="From one to the next, or the side of a square (mm); all else is in proportion.",
            show_default="of the kind",
        ),
    ] = None,
    described: Annotated[
        Path | None,
        typer.Option("--described", metavar="FILE", help="A description to print instead: a file with `target:`."),
    ] = None,
    paper: Annotated[
        str | None,
        typer.Option(help="A4 to A0, letter, ..., or width x height in mm.", show_default="A1, or none with --tile"),
    ] = None,
    tile: Annotated[
        str | None, typer.Option(metavar="PAPER", help="Spread it over sheets of this paper, to be glued.")
    ] = None,
    range_m: Annotated[
        float | None, typer.Option(help="From the camera to the target (m): tells whether it will be seen.")
    ] = None,
    pixel_mrad: Annotated[
        float | None, typer.Option(help="What a pixel sees (mrad): its field of view, or its spacing.")
    ] = None,
    output: Annotated[Path, typer.Option("--output", "-o", help="PDF to write.")] = Path("target.pdf"),
    _: Annotated[
        bool, typer.Option("--list", callback=_tell_kinds, is_eager=True, help="Tell the kinds and end.")
    ] = False,
) -> None:
    """Print a target true to scale, and write its description for a platform's file beside it.

    The default is the paper's board of 3 x 5 rings on A1.
    """
    from linepose.config.target_file import target_text
    from linepose.output.printing.paper import paper_of
    from linepose.output.printing.write import write_pdf
    from linepose.tables import atomic_write

    if range_m is not None or pixel_mrad is not None:
        _check_view(range_m, pixel_mrad)
    chosen = _chosen(kind, rows, columns, spacing_mm, described)
    sheet = paper_of(paper) if paper else None if tile else paper_of("A1")
    spread = paper_of(tile, "--tile") if tile else None
    n_sheets = write_pdf(chosen, output, sheet, spread, may_scale=described is None, paper_given=paper is not None)
    description = output.with_suffix(".yaml")
    is_new = described is None or described.resolve() != description.resolve()
    if is_new:
        with atomic_write(description) as temporary:
            temporary.write_text(target_text(chosen), encoding="utf-8")
    typer.echo(f"wrote {output}: {n_sheets} sheet{'s' if n_sheets > 1 else ''}, and a page on mounting it")
    if is_new:
        typer.echo(f"wrote {description}: the section `target` of the platform's file")
    if range_m is not None and pixel_mrad is not None and _tell_sizes(chosen, range_m, pixel_mrad):
        from linepose.output.printing.seen import range_for

        larger = _larger(chosen, range_m, pixel_mrad * 1e-3, described, sheet, spread, paper is not None)
        farthest_m = range_for(chosen, range_m, pixel_mrad * 1e-3)
        typer.echo(f"  {larger}come within {farthest_m:.3g} m (--range-m {farthest_m:.3g})")


def _chosen(
    kind: str, rows: int | None, columns: int | None, spacing_mm: float | None, described: Path | None
) -> "GridSection":
    from linepose.config.target_file import read_target
    from linepose.errors import InputError
    from linepose.survey.targets.base import GridSection
    from linepose.survey.targets.registry import KINDS, PRINTED

    if described is not None:
        if kind != _DEFAULT or rows or columns or spacing_mm is not None:
            found = "with --kind, --rows, --columns or --spacing-mm"
            raise InputError(f"--described {described}", found, "either", "change the file, or leave --described out")
        target = read_target(described)
        if not isinstance(target, GridSection):
            raise InputError(f"{described}: target.kind", target.kind, f"one of {', '.join(PRINTED)}", "there is none")
        return target
    if kind not in PRINTED:
        import difflib

        if kind in KINDS:
            remedy = f"nothing is printed for it; write `target: {{kind: {kind}}}` into the platform's file"
            raise InputError("--kind", f"{kind}, which has no pattern", f"one of {', '.join(PRINTED)}", remedy)
        near = difflib.get_close_matches(kind, PRINTED, n=1)
        remedy = f"did you mean {near[0]}?" if near else f"give --kind {next(iter(PRINTED))}"
        raise InputError("--kind", repr(kind), f"one of {', '.join(PRINTED)}", remedy)
    if spacing_mm is not None and not 0 < spacing_mm < _TOO_LARGE_MM:
        raise InputError("--spacing-mm", f"{spacing_mm:g}", "a length above 0 and below 10 m", "correct it")
    try:
        return PRINTED[kind].scaled(rows, columns, None if spacing_mm is None else round(spacing_mm / 1e3, 9))
    except InputError as fault:
        fields = PRINTED[kind].model_fields
        given = f"{rows or fields['rows'].default} rows and {columns or fields['columns'].default} columns"
        raise InputError(f"--kind {kind}", given, fault.expected, "change --rows or --columns") from None


def _check_view(range_m: float | None, pixel_mrad: float | None) -> None:
    from linepose.errors import InputError

    for option, value in (("--range-m", range_m), ("--pixel-mrad", pixel_mrad)):
        if value is None or not value > 0:
            found = "nothing" if value is None else f"{value:g}"
            raise InputError(option, found, "a number above 0", "give both --range-m and --pixel-mrad")


def _tell_sizes(target: "GridSection", range_m: float, pixel_mrad: float) -> bool:
    """Tell how large each detail is and must be; returns whether one is too small."""
    from linepose.output.printing.seen import is_seen, size_rows

    typer.echo(f"from {range_m:g} m a pixel sees {range_m * pixel_mrad:.1f} mm:")
    rows = size_rows(target, range_m, pixel_mrad * 1e-3)
    for name, size_m, needed_m in rows:
        verdict = "large enough" if is_seen(size_m, needed_m) else "too small"
        typer.echo(f"  {name} {size_m * 1e3:.1f} mm, at least {needed_m * 1e3:.1f} mm: {verdict}")
    return any(not is_seen(size_m, needed_m) for _, size_m, needed_m in rows)


def _larger(
    target: "GridSection",
    range_m: float,
    pixel_rad: float,
    described: Path | None,
    sheet: "Paper | None",
    spread: "Paper | None",
    paper_given: bool,
) -> str:
    """What prints the target large enough, with "or" behind it; empty where nothing does."""
    from linepose.output.printing.fit import options_for
    from linepose.output.printing.seen import factor_for, spacing_for

    if described is not None:
        return f"make all sizes in {described} {factor_for(target, range_m, pixel_rad):.3g} times as large, or "
    spacing_mm = spacing_for(target, target.spacing, range_m, pixel_rad)
    if spacing_mm >= _TOO_LARGE_MM:
        return ""
    larger = target.scaled(target.rows, target.columns, spacing_mm / 1e3)
    options = options_for(larger, sheet, spread, paper_given)
    return "" if options is None else f"give {' '.join([f'--spacing-mm {spacing_mm}', *options])}, or "
