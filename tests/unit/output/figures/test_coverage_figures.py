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


def test_a_panel_for_each_platform_and_regime(surveys):
    figure = figures.coverage(coverage_curve(surveys, stated_probabilities()))
    assert [axes.get_title() for axes in figure.axes] == ["white", "shared"]
    assert all(len(axes.lines) == 3 for axes in figure.axes)  # the diagonal and two models


def test_cell_of_failures_has_no_bar_and_no_ratio(surveys):
    summary = coverage_summary(surveys, POOLS)
    figure = figures.errors(summary)
    assert sum(len(container) for container in figure.axes[0].containers) == 3
    (panel,) = figures.ratios(summary).axes
    points = {(line.get_xdata()[0], line.get_ydata()[0]) for line in panel.lines if line.get_marker() == "o"}
    assert {row for _, row in points} == {0, 1}
    assert len(points) == 3
    assert {value for value, _ in points} == set(summary[summary["platform"] == "p-sim"]["ratio"].dropna())


def test_pools_have_no_place_among_the_platforms(surveys):
    summary = coverage_summary(surveys, POOLS)
    assert [axes.get_title() for axes in figures.ratios(summary).axes] == ["p-sim"]
    assert len(figures.errors(summary).axes) == 2


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
    figure = figures.coverage(coverage_curve(surveys.assign(regime="gauss-markov-60"), stated_probabilities()))
    assert figure.axes[0].get_title() == "gauss markov\n60"
