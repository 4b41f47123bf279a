"""The section on the scans' maps: millimetres by source at the centre and at the edge."""

import pandas as pd
import pytest

from linepose.output.map.budget import ALL, AS_REPORTED
from linepose.output.map.sources import SOURCES
from linepose.output.map.tables import MAP_TABLES
from linepose.output.report.on_the_map import map_section
from linepose.pipeline.calibration import Calibration
from linepose.tables import write_table
from unit import made_up

BUDGET = pd.DataFrame(
    [
        ["strip", place, source, factor * 0.001 * k, 0.002, 0.01 * factor]
        for place, factor in (("centre", 1.0), ("edge", 2.0))
        for k, source in enumerate((*SOURCES, AS_REPORTED, ALL), start=1)
    ],
    columns=MAP_TABLES["map_budget"].names,
)
SCANS = pd.DataFrame([["strip", 0.02, 1000, 7, 0, 3, 0, 800, 50]], columns=MAP_TABLES["map_scans"].names)


def section_of(folder, budget, **changes):
    for name, table in (("map_budget", budget), ("map_scans", SCANS)):
        write_table(table, folder / f"{name}.parquet", MAP_TABLES[name])
    return map_section(Calibration.from_results(folder, made_up.platform(**changes)))


def test_budget_is_told_in_millimetres_a_column_a_source(tmp_path):
    section = section_of(tmp_path, BUDGET, map={})
    budget, pixels = section.tables
    assert [head.lower() for head in budget.heads[1:-2]] == [*SOURCES, AS_REPORTED, ALL]
    assert budget.rows[0] == ["strip, centre", "1.0", "2.0", "3.0", "4.0", "5.0", "6.0", "7.0", "2.0", "10.0"]
    assert budget.rows[1][1] == "2.0"
    assert pixels.rows == [["strip", "1000", "7", "0", "3", "0", "20.0", "50"]]
    assert "within 10.0 mm at the centre of the line. 95 % of places lie within 20.0 mm at the edge" in section.text


def test_a_scan_without_ground_has_empty_cells(tmp_path):
    nothing = BUDGET.assign(horizontal_m=None, height_m=None, radius_95_m=None)
    section = section_of(tmp_path, nothing.astype({"horizontal_m": float, "height_m": float}), map={})
    assert set(section.tables[0].rows[0][1:]) == {""}
    assert "2 of 2 places of the budget see no ground" in section.text


@pytest.mark.parametrize("changes", [{}, {"map": {}}])
def test_no_section_where_there_are_no_maps(tmp_path, changes):
    assert map_section(Calibration.from_results(tmp_path, made_up.platform(**changes))) is None
    if not changes:
        assert section_of(tmp_path, BUDGET) is None
