"""A target as a PDF file."""

from pathlib import Path

from linepose.errors import InputError
from linepose.output.printing.board import sheet, tiled
from linepose.output.printing.fit import MOST_SHEETS, check_fits, sheets_of
from linepose.output.printing.notes import notes
from linepose.output.printing.paper import Paper
from linepose.survey.targets.base import GridSection
from linepose.tables import atomic_write


def write_pdf(
    target: GridSection,
    path: Path,
    paper: Paper | None,
    tile: Paper | None,
    *,
    may_scale: bool = True,
    paper_given: bool = True,
) -> int:
    """Write the print, and a page of notes, whole or not at all; returns the number of sheets of the print.

    On one sheet of `paper`, or over as many of `tile` as it takes. Raises InputError where it does not fit;
    `may_scale` says whether its spacing may then be another, `paper_given` whether the paper is by an option.
    """
    import matplotlib as mpl
    from matplotlib.backends.backend_pdf import PdfPages

    if path.suffix.lower() != ".pdf":
        raise InputError("--output", str(path), "a name that ends in .pdf", f"give --output {path.stem}.pdf")
    if not path.resolve().parent.is_dir():
        raise InputError("--output", f"no folder {path.parent}", "a folder that there is", "make the folder first")
    artwork = target.artwork()
    assert artwork is not None
    if paper is not None:
        check_fits(target, artwork, paper, may_scale, paper_given)
    pages = [sheet(target, artwork, paper)] if tile is None and paper is not None else []
    if tile is not None:
        n_sheets = sheets_of(tile, artwork)
        if n_sheets > MOST_SHEETS:
            raise InputError(
                "--tile", f"{n_sheets:.0f} sheets of {tile.name}", f"at most {MOST_SHEETS}", "use larger paper"
            )
        pages = tiled(target, artwork, tile)
    with (
        atomic_write(path) as temporary,
        mpl.rc_context({"pdf.fonttype": 42, "path.simplify": False}),
        PdfPages(temporary, metadata={"CreationDate": None, "Title": f"linepose {target.kind}"}) as pdf,
    ):
        for page in [*pages, notes(target, artwork, tile is not None)]:
            pdf.savefig(page)
    return len(pages)
