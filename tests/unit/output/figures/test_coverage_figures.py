"""The coverage study's figures and table, on made-up surveys."""

import numpy as np
import pandas as pd
import pytest

from linepose.experiments.coverage import ERROR_COLUMNS, ERROR_SIGMA_COLUMNS
from linepose.experiments.coverage_summary import coverage_curve, coverage_summary, stated_probabilities
from linepose.experiments.coverage_table import coverage_table
from linepose.output.figures import coverage as figures

POOLS = {"both": ["white", "shared"]}


@pytest.fixture
def surveys() -> pd.DataFrame:
    random, parts = np.random.default_rng(1), []
    for regime in ("white", "shared"):
        for model in ("published", "adjustment"):
            n = 40
            parts.append(
                pd.DataFrame(
                    {"platform": "p-sim", "regime": regime, "noise_model": model, "survey": np.arange(n)}
                    | {"failed": (model == "published") & (regime == "white"), "heavy_tails": False}
                    | {"least_eigenvalue": 0.9 if model == "adjustment" else np.nan}
                    | {"credibility": random.uniform(size=n)}
                    | {key: random.normal(size=n) for key in ERROR_COLUMNS}
                    | dict.fromkeys(ERROR_SIGMA_COLUMNS, 1.0)
                )
            )
    return pd.concat(parts, ignore_index=True)


def two_platforms(surveys):
    return pd.concat([surveys, surveys.assign(platform="q-sim")])


def test_a_panel_for_each_regime_and_a_curve_for_each_platform_and_model(surveys):
    figure = figures.coverage(coverage_curve(two_platforms(surveys), stated_probabilities()))
    assert [axes.get_title() for axes in figure.axes] == ["white", "shared"]
    for axes in figure.axes:
        curves = {(line.get_color(), line.get_linestyle()) for line in axes.lines[1:]}  # the first is the diagonal
        assert len(curves) == len(axes.lines) - 1 == 4


def points(panel):
    """Row of each marker, and what it stands at."""
    return [(line.get_ydata()[0], line.get_xdata()[0]) for line in panel.lines if line.get_linestyle() == "None"]


def test_cell_of_failures_has_no_mark(surveys):
    summary = coverage_summary(two_platforms(surveys), POOLS)
    for panel, column, scale in zip(
        figures.errors(summary).axes, ("rmse_position_m", "rmse_turn_rad"), (1.0, np.degrees(1.0)), strict=True
    ):
        cells = summary[(summary["platform"] != "all") & summary[column].notna()]
        expected = [(("white", "shared").index(row["regime"]), scale * row[column]) for _, row in cells.iterrows()]
        assert points(panel) == expected
        assert len(expected) == 6


def test_ratios_stand_in_their_row_and_those_beyond_the_axis_as_numbers(surveys):
    summary = coverage_summary(surveys, POOLS)
    summary.loc[summary["noise_model"] == "published", "ratio"] *= 4.0
    (panel,) = figures.ratios(summary).axes
    own = summary[(summary["platform"] == "p-sim") & (summary["noise_model"] == "adjustment")]
    assert points(panel) == list(enumerate(own["ratio"]))
    beyond = summary[(summary["regime"] == "shared") & (summary["noise_model"] == "published")]["ratio"].item()
    assert [text.get_text() for text in panel.texts] == [f"{beyond:.1f}"]


def test_pools_have_no_place_among_the_platforms(surveys):
    summary = coverage_summary(surveys, POOLS)
    assert [axes.get_title() for axes in figures.ratios(summary).axes] == ["p-sim"]
    assert [label.get_text() for label in figures.errors(summary).axes[0].get_yticklabels()] == ["white", "shared"]


def test_table_has_a_row_a_cell_with_intervals_and_one_a_pool(surveys):
    lines = coverage_table(coverage_summary(surveys, POOLS)).splitlines()
    assert len(lines) == 2 + 4 + 2
    assert lines[2].startswith("| p-sim | white | published |")
    assert lines[2].endswith("| - - - | - - - | - | 40 of 40 |")
    assert "nan" not in "".join(lines)
    assert "(" in lines[3]
    assert lines[-1].startswith("| all | both | adjustment |")


def test_many_regimes_go_into_rows_of_four(surveys):
    many = pd.concat([surveys.assign(regime=f"{regime}-{n}") for n in range(3) for regime in ("white", "shared")])
    figure = figures.coverage(coverage_curve(many, stated_probabilities()))
    shown = [axes for axes in figure.axes if axes.axison]
    assert len({axes.get_position().y0 for axes in shown}) == 2
    assert [axes.get_title() for axes in shown[:2]] == ["white 0", "shared 0"]
    assert len(shown) == 6


def test_long_names_of_regimes_take_two_rows(surveys):
    figure = figures.coverage(coverage_curve(surveys.assign(regime="hand-measured-white"), stated_probabilities()))
    assert figure.axes[0].get_title() == "hand measured\nwhite"
