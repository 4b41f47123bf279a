"""What the page says of priors and clocks."""

import pandas as pd
import pytest

from linepose.experiments.clock_offset import CLOCK_OFFSET
from linepose.experiments.prior import PRIOR_TABLE
from linepose.output.report.clocks import clocks_section
from linepose.output.report.data_or_prior import prior_weight_section
from linepose.pipeline.calibration import Calibration
from linepose.tables import write_table
from unit import made_up


def results_with(folder, **tables):
    for name, (table, schema) in tables.items():
        write_table(table, folder / f"{name}.parquet", schema)
    return Calibration.from_results(folder, made_up.platform())


def test_who_decided_stands_in_a_table(tmp_path):
    section = prior_weight_section(results_with(tmp_path, prior=(made_up.prior(), PRIOR_TABLE)))
    (table,) = section.tables
    assert table.sentence == "5 decided by data, 1 decided by data and prior."
    assert table.rows[2] == ["r_z (m)", "0.0100", "0.0600", "0.1000", "0.50", "data and prior"]
    assert table.rows[3] == ["turn about forward (°)", "1.15", "0.92", "2.01", "0.90", "data"]
    assert "The hand measurement is a prior" in section.text
    assert table.title == "Data or prior"


def test_without_a_prior_the_page_says_what_it_would_add(tmp_path):
    table = made_up.prior().assign(prior_counted_in=False, decided_by="data")
    section = prior_weight_section(results_with(tmp_path, prior=(table, PRIOR_TABLE)))
    assert "The data decided the pose alone" in section.text
    assert section.tables[0].sentence == "6 decided by data."
    assert section.tables[0].heads[1] == "Estimate minus hand"
    assert "Levels and intrinsics" not in section.text


def test_levels_and_intrinsics_have_their_units(tmp_path):
    names = ["log_shared_level", "principal_point_px", "focal_length_m"]
    others = made_up.prior().iloc[:3].assign(parameter=names, difference=[0.5, 1.5, 2e-5])
    table = pd.concat([made_up.prior(), others])
    section = prior_weight_section(results_with(tmp_path, prior=(table, PRIOR_TABLE)))
    assert "Levels and intrinsics always have a prior" in section.text
    assert [row[:2] for row in section.tables[0].rows[6:]] == [
        ["shared level (logarithm)", "0.5000"],
        ["principal point (px)", "1.5000"],
        ["focal length (mm)", "0.0200"],
    ]


def test_clock_offset_comes_with_both_sigmas_and_what_to_do(tmp_path):
    section = clocks_section(results_with(tmp_path, clock_offset=(made_up.clock_offset(), CLOCK_OFFSET)))
    assert section.text == (
        "The camera's clock is behind. What to do: Add 30000 us. One sigma is the larger of 5.0 ms from samples of the "
        "noise model and 8.0 ms from leaving out one observation at a time."
    )
    rows = section.tables[0].rows
    assert rows[0] == ["r_x (m)", "0.1900 ± 0.0300", "0.1900 ± 0.0300", "+0.25"]
    assert [row[0] for row in rows[6:]] == ["turn about forward", "turn about right", "turn about down"]


def test_an_offset_that_cannot_be_told_is_a_warning(tmp_path):
    table = made_up.clock_offset().assign(identifiable=False, jackknife_sigma_s=float("nan"))
    section = clocks_section(results_with(tmp_path, clock_offset=(table, CLOCK_OFFSET)))
    assert section.text.startswith("Warning: The camera's clock")
    assert "nan" not in section.text


@pytest.mark.parametrize("make", [prior_weight_section, clocks_section])
def test_no_result_no_section(make, tmp_path):
    assert make(results_with(tmp_path)) is None
