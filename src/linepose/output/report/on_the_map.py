"""The section on the scans' maps: how sure places are, and which source gives how many millimetres of that."""

from typing import Final

import pandas as pd

from linepose.output.map.budget import ALL, BUDGET
from linepose.output.map.strip_fit import FIT
from linepose.output.map.tables import MAPPED
from linepose.output.map.words import fit_sentence
from linepose.output.report.sections import SectionOnPage, TableOnPage
from linepose.pipeline.calibration import Calibration

_MM: Final = 1000
_REASONS: Final = {
    "n_missed": "Miss the ground",
    "n_outside": "Leave the elevation model",
    "n_in_hole": "End in a hole of it",
    "n_met_twice": "Meet the ground twice",
}


def map_section(calibration: Calibration) -> SectionOnPage | None:
    """The section; None where the platform's file does not ask for maps."""
    if calibration.platform_file.map is None or not calibration.results.has("map_budget"):
        return None
    budget = calibration.results.table("map_budget", BUDGET)
    scans = calibration.results.table("map_scans", MAPPED)
    anchor = f"{calibration.name}-map"
    tables = [_budget_table(f"{anchor}-budget", budget), _pixel_table(f"{anchor}-pixels", scans)]
    text = _text(budget, scans)
    if calibration.results.has("strip_fit"):
        text += f"\n\n{fit_sentence(calibration.results.table('strip_fit', FIT).iloc[0])}"
    return SectionOnPage(anchor, "On the map", text, tables)


def _text(budget: pd.DataFrame, scans: pd.DataFrame) -> str:
    whole = budget[budget["source"] == ALL]
    placed = whole.dropna(subset=["radius_95_m"])
    told = f"{len(scans)} scan{'s' * (len(scans) != 1)} on the map, in the folder map beside this page."
    for place, rows in placed.groupby("place", sort=False):
        radius = rows["radius_95_m"].median() * _MM
        told += f" 95 % of places lie within {radius:.1f} mm at the {place} of the line."
    without = len(whole) - len(placed)
    return told + (f" {without} of {len(whole)} places of the budget see no ground." if without else "")


def _budget_table(anchor: str, budget: pd.DataFrame) -> TableOnPage:
    """One row a scan and place on the line, a column a source: one sigma of the place, horizontal, in mm."""
    sources = [*dict.fromkeys(source for source in budget["source"] if source != ALL), ALL]
    rows = []
    for (scan, place), part in budget.groupby(["scan", "place"], sort=False):
        by_source = part.set_index("source")
        cells = [_mm(by_source["horizontal_m"].get(source)) for source in sources]
        rows.append(
            [f"{scan}, {place}", *cells, *(_mm(by_source.loc[ALL, key]) for key in ("height_m", "radius_95_m"))]
        )
    heads = ["Scan", *(source.capitalize() for source in sources), "Height", "Radius of 95 %"]
    sentence = (
        "Millimetres: one sigma of the horizontal place that each source gives alone, of all together, of the height, "
        "and the radius that holds 95 %; medians over the scan's lines. Navigation as reported is what the levels "
        "scale, and no part of the whole. Pose and intrinsics of an adjustment err together: the whole may be less "
        "than both."
    )
    return TableOnPage(anchor, "Error budget of each scan", sentence, heads, rows, folded=False)


def _pixel_table(anchor: str, scans: pd.DataFrame) -> TableOnPage:
    rows = [
        [
            row["scan"],
            str(row["n_pixels"]),
            *(str(row[key]) for key in _REASONS),
            _mm(row["cell_m"]),
            str(row["n_filled"]),
        ]
        for _, row in scans.iterrows()
    ]
    heads = ["Scan", "Pixels", *_REASONS.values(), "Cell (mm)", "Cells filled from beside"]
    return TableOnPage(anchor, "Pixels of each scan", f"{len(rows)} scans", heads, rows)


def _mm(value: float | None) -> str:
    return "" if value is None or pd.isna(value) else f"{value * _MM:.1f}"
