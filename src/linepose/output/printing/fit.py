"""Whether a target fits the paper, and which nearest one would."""

from typing import Final

from linepose.errors import InputError
from linepose.output.printing.paper import Paper, paper_of, smallest_paper
from linepose.survey.targets.artwork import Artwork
from linepose.survey.targets.base import GridSection

MOST_SHEETS: Final = 400
_SMALLEST_MM: Final = 1
_TILE: Final = "A4"


def check_fits(target: GridSection, artwork: Artwork, paper: Paper, may_scale: bool, paper_given: bool) -> None:
    """Raise InputError where the artwork does not fit the paper, with the paper that would, and the spacing.

    `may_scale` says whether the spacing is given by an option, `paper_given` whether the paper is.
    """
    width, height = artwork.width_m * 1e3, artwork.height_m * 1e3
    if paper.holds(width, height):
        return
    remedies = []
    spacing = _largest_spacing_mm(target, paper) if may_scale else None
    if spacing is not None:
        remedies.append(f"--spacing-mm {spacing}")
    larger = smallest_paper(width, height)
    if larger is not None:
        remedies.append(f"--paper {larger.name}")
    remedies.append(_over_tiles(paper_given))
    inner = paper.laid_for(width, height).inner_mm
    raise InputError(
        f"{target.kind}, {target.rows} rows and {target.columns} columns {target.spacing * 1e3:g} mm apart",
        f"a print of {width:.0f} x {height:.0f} mm",
        f"at most {inner[0]:.0f} x {inner[1]:.0f} mm, {paper.name} less its margin",
        f"give {' or '.join(remedies)}",
    )


def options_for(target: GridSection, paper: Paper | None, tile: Paper | None, paper_given: bool) -> list[str] | None:
    """The options with which a target that does not fit `paper`, or is spread over `tile`, is printed.

    Empty where it is printed so; None where nothing prints it. `paper_given` says whether the paper is by an option.
    """
    artwork = target.artwork()
    assert artwork is not None
    width, height = artwork.width_m * 1e3, artwork.height_m * 1e3
    if paper is not None and paper.holds(width, height):
        return []
    larger = None if paper is None else smallest_paper(width, height)
    if larger is not None:
        return [f"--paper {larger.name}"]
    if sheets_of(tile or paper_of(_TILE), artwork) > MOST_SHEETS:
        return None
    return [] if tile is not None else [_over_tiles(paper_given)]


def _over_tiles(paper_given: bool) -> str:
    return f"--tile {_TILE}{' (and leave --paper out)' if paper_given else ''}"


def sheets_of(tile: Paper, artwork: Artwork) -> float:
    """How many sheets the artwork covers."""
    return artwork.width_m * artwork.height_m * 1e6 / (tile.inner_mm[0] * tile.inner_mm[1])


def _largest_spacing_mm(target: GridSection, paper: Paper) -> int | None:
    """The largest spacing in whole mm at which a target in proportion fits; None where even the smallest does not."""
    low, high = 0, int(target.spacing * 1e3) + 1
    while high - low > 1:
        middle = (low + high) // 2
        field = type(target).scaled(target.rows, target.columns, middle / 1e3).artwork()
        assert field is not None
        low, high = (middle, high) if paper.holds(field.width_m * 1e3, field.height_m * 1e3) else (low, middle)
    return low if low >= _SMALLEST_MM else None
