"""A target as a PDF file."""

from pathlib import Path
from typing import Final

from linepose.errors import InputError
from linepose.output.printing.board import sheet, tiled
from linepose.output.printing.fit import check_fits
from linepose.output.printing.notes import notes
from linepose.output.printing.paper import Paper
from linepose.survey.targets.base import GridSection
from linepose.tables import atomic_write

_MOST_SHEETS: Final = 400


def write_pdf(target: GridSection, path: Path, paper: Paper | None, tile: Paper | None) -> int:
    """Write the print, and a page of notes, whole or not at all; returns the number of sheets of the print.

    On one sheet of `paper`, or over as many of `tile` as it takes. Raises InputError where it does not fit.
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
        check_fits(target, artwork, paper)
    pages = [sheet(target, artwork, paper)] if tile is None and paper is not None else []
    if tile is not None:
        area = artwork.width_m * artwork.height_m * 1e6 / (tile.inner_mm[0] * tile.inner_mm[1])
        if area > _MOST_SHEETS:
            raise InputError(
                "--tile", f"{area:.0f} sheets of {tile.name}", f"at most {_MOST_SHEETS}", "use larger paper"
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
