"""The coverage study's figures and table, on made-up surveys."""

import numpy as np
import pandas as pd
import pytest

from linepose.experiments.coverage import N_RANKED, RANK_COLUMNS, TRUE_COLUMNS
from linepose.experiments.coverage_summary import coverage_curve, coverage_summary, stated_probabilities
from linepose.experiments.coverage_table import coverage_table
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from linepose.output.figures import coverage as figures


@pytest.fixture
def surveys() -> pd.DataFrame:
    random, parts = np.random.default_rng(1), []
    for regime in ("white", "shared"):
        for model in ("published", "balanced"):
            n = 40
            parts.append(
                pd.DataFrame(
                    {"platform": "p-sim", "regime": regime, "noise_model": model, "survey": np.arange(n)}
                    | {"failed": (model == "published") & (regime == "white"), "pareto_shape": 0.2}
                    | {"effective_sample_size": 300.0}
                    | {key: random.uniform(size=n) for key in ("credibility", "laplace_credibility")}
                    | dict.fromkeys(TRUE_COLUMNS, 0.0)
                    | {key: random.normal(size=n) for key in POSE_COLUMNS}
                    | dict.fromkeys(SIGMA_COLUMNS, 1.0)
                    | {key: random.integers(0, N_RANKED + 1, n) for key in RANK_COLUMNS}
                )
            )
    return pd.concat(parts, ignore_index=True)


def test_a_panel_for_each_platform_and_regime(surveys):
    figure = figures.coverage(coverage_curve(surveys, stated_probabilities()))
    assert [axes.get_title() for axes in figure.axes] == ["white", "shared"]
    assert all(len(axes.lines) == 3 for axes in figure.axes)  # the diagonal and two models


def test_ranks_have_a_row_a_cell_and_a_column_a_parameter(surveys):
    assert len(figures.ranks(surveys, "balanced").axes) == 2 * 6
    assert len(figures.ranks(surveys, "published").axes) == 1 * 6  # the cell of which all failed has none


def test_cell_of_failures_has_no_bar(surveys):
    figure = figures.errors(coverage_summary(surveys))
    assert sum(len(container) for container in figure.axes[0].containers) == 3


def test_table_has_a_row_a_cell_with_intervals(surveys):
    lines = coverage_table(coverage_summary(surveys)).splitlines()
    assert len(lines) == 2 + 4
    assert lines[2].startswith("| p-sim | white | published |")
    assert lines[2].endswith("| - | - | 40 of 40 |")
    assert "(" in lines[3]


def test_many_regimes_go_into_rows_of_four(surveys):
    many = pd.concat([surveys.assign(regime=f"{regime}-{n}") for n in range(3) for regime in ("white", "shared")])
    figure = figures.coverage(coverage_curve(many, stated_probabilities()))
    shown = [axes for axes in figure.axes if axes.axison]
    assert len({axes.get_position().y0 for axes in shown}) == 2
    assert [axes.get_title() for axes in shown[:2]] == ["white\n0", "shared\n0"]
    assert len(shown) == 6
