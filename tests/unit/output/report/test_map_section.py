"""The section on the scans' maps: millimetres by source at the centre and at the edge."""

import pandas as pd
import pytest

from linepose.output.figures import strip_fit
from linepose.output.figures.render import render_figures
from linepose.output.map.budget import ALL, AS_REPORTED
from linepose.output.map.sources import SOURCES
from linepose.output.map.strip_fit import FIT_TABLES
from linepose.output.map.tables import MAP_TABLES
from linepose.output.report.on_the_map import map_section
from linepose.pipeline.calibration import Calibration
from linepose.tables import write_table
from unit import made_up

MAPPED = {"map": {}, "source": {"kind": "scans", "dataset": "made-up"}}
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
    section = section_of(tmp_path, BUDGET, **MAPPED)
    budget, pixels = section.tables
    assert [head.lower() for head in budget.heads[1:-2]] == [*SOURCES, AS_REPORTED, ALL]
    assert budget.rows[0] == ["strip, centre", "1.0", "2.0", "3.0", "4.0", "5.0", "6.0", "7.0", "2.0", "10.0"]
    assert budget.rows[1][1] == "2.0"
    assert pixels.rows == [["strip", "1000", "7", "0", "3", "0", "20.0", "50"]]
    assert "within 10.0 mm at the centre of the line. 95 % of places lie within 20.0 mm at the edge" in section.text


def test_a_scan_without_ground_has_empty_cells(tmp_path):
    nothing = BUDGET.assign(horizontal_m=None, height_m=None, radius_95_m=None)
    section = section_of(tmp_path, nothing.astype({"horizontal_m": float, "height_m": float}), **MAPPED)
    assert set(section.tables[0].rows[0][1:]) == {""}
    assert "2 of 2 places of the budget see no ground" in section.text


@pytest.mark.parametrize("changes", [{}, MAPPED])
def test_no_section_where_there_are_no_maps(tmp_path, changes):
    assert map_section(Calibration.from_results(tmp_path, made_up.platform(**changes))) is None
    if not changes:
        assert section_of(tmp_path, BUDGET) is None


FIT_ROW = {"n_scans": 3, "n_pairs": 2, "n_tried": 40, "n_uncorrelated": 5, "n_contradicted": 4, "n_without_ground": 1}
FIT_ROW |= {"n_scans_left_out": 0}
FIT_ROW |= {"n_compared": 30, "pixel_m": 0.04, "rms_before_m": 0.8, "rms_after_m": 0.06}


def fit_written(folder, **changes):
    fit = pd.DataFrame([FIT_ROW | changes])
    write_table(fit, folder / "strip_fit.parquet", FIT_TABLES["strip_fit"])
    values = [20.0, 30.0, 10.0, 50.0, 0.9, 7.0, 8.0, 0.5, 0.1, 0.03, -0.02]
    patches = pd.DataFrame([["a", "b", *values], ["a", "c", *values]], columns=FIT_TABLES["strip_patches"].names)
    write_table(patches.head(fit["n_compared"][0]), folder / "strip_patches.parquet", FIT_TABLES["strip_patches"])


def test_misfit_is_told_in_millimetres_and_pixels_with_what_was_left_out(tmp_path):
    fit_written(tmp_path)
    assert section_of(tmp_path, BUDGET, **MAPPED).paragraphs[-1] == (
        "Overlapping scans lie 60 mm apart on the map, 1.5 pixels (RMS), and 800 mm, 20.0 pixels, at the hand-measured "
        "pose: 30 patches of 2 pairs of scans (5 were not found again, 4 are not borne out by others of their pair, 1 "
        "see no ground)."
    )
    fit_written(tmp_path, n_compared=0, n_uncorrelated=36, n_without_ground=0, n_scans_left_out=1)
    assert section_of(tmp_path, BUDGET, **MAPPED).paragraphs[-1] == (
        "Overlapping scans could not be compared: of 40 patches 36 were not found again, 4 are not borne out by others "
        "of their pair. Scans that could not be put on level ground: 1 of 3."
    )
    fit_written(tmp_path, n_compared=0, n_tried=0, n_scans_left_out=0)
    assert section_of(tmp_path, BUDGET, **MAPPED).paragraphs[-1] == (
        "No two of 3 scans share 65 by 65 pixels of level ground, so none was compared."
    )


@pytest.mark.parametrize("n_compared", [30, 0])
def test_misfit_is_drawn_on_the_map_even_where_there_is_none(tmp_path, n_compared):
    fit_written(tmp_path, n_compared=n_compared)
    calibration = Calibration.from_results(tmp_path, made_up.platform(**MAPPED))
    index = render_figures(calibration, tmp_path / "figures", strip_fit.FIGURES)
    assert index["left_out"].tolist() == [""]
    assert (tmp_path / "figures" / "strip_fit.png").stat().st_size > 5000
