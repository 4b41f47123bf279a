"""The coverage study: coverage against what is stated, ranks of the truth, and errors."""

import math
from typing import Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from scipy.stats import binom

from linepose.estimation.noise_models import noise_model
from linepose.experiments.coverage import N_RANKED, RANK_COLUMNS
from linepose.experiments.coverage_summary import N_BINS, RMSE_COLUMNS, rank_histogram
from linepose.output.figures.style import GREY, WIDE_IN, blank_figure, styled
from linepose.pipeline.table_checks import usable_rows

_PANELS_A_ROW: Final = 4
_PARAMETERS: Final = ("$r_x$", "$r_y$", "$r_z$", r"$\theta e_x$", r"$\theta e_y$", r"$\theta e_z$")


@styled
def coverage(curve: pd.DataFrame) -> Figure:
    """A panel a platform and regime: how often regions hold the truth against what they state, with 95 % intervals.

    `curve` as in `COVERAGE`.
    """
    rows = usable_rows(curve, ["platform", "regime", "noise_model", "nominal", "coverage"], "coverage.parquet")
    platforms, regimes = _names(rows, "platform"), _names(rows, "regime")
    n_rows = math.ceil(len(regimes) / _PANELS_A_ROW)  # of a platform
    n_columns = min(len(regimes), _PANELS_A_ROW)
    figure = blank_figure(WIDE_IN, 0.6 + 1.6 * n_rows * len(platforms))
    panels = figure.subplots(n_rows * len(platforms), n_columns, sharex=True, sharey=True, squeeze=False)
    for panel in panels.flat:
        panel.set_axis_off()
    for i, platform in enumerate(platforms):
        for j, regime in enumerate(regimes):
            panel = panels[n_rows * i + j // n_columns, j % n_columns]
            panel.set_axis_on()
            panel.plot([0, 1], [0, 1], color=GREY, linewidth=0.8)
            part = rows[(rows["platform"] == platform) & (rows["regime"] == regime)]
            for model, line in part.groupby("noise_model", sort=False):
                colour = _colour(str(model))
                panel.fill_between(
                    line["nominal"], line["coverage_low"], line["coverage_high"], color=colour, alpha=0.2
                )
                panel.plot(line["nominal"], line["coverage"], color=colour, linewidth=1.0)
            panel.set(xlim=(0, 1), ylim=(0, 1), xticks=[0, 0.5, 1], yticks=[0, 0.5, 1])
            panel.set_title(regime.replace("-", "\n", 1).replace("-", " "))
            if j % n_columns == 0:
                panel.set_ylabel(f"{platform}\nholds the truth")
    figure.supxlabel("Stated probability of the region", fontsize=8)
    _legend(figure, _names(rows, "noise_model"))
    return figure


@styled
def ranks(surveys: pd.DataFrame, noise_model: str) -> Figure:
    """A panel a platform and regime, a histogram for each parameter: where the truth ranks among the samples.

    `surveys` as in `COVERAGE_SURVEYS`; the band is where 99 % of bars are if ranks are uniform.
    """
    rows = usable_rows(surveys, ["platform", "regime", "noise_model", "failed"], "surveys.parquet")
    rows = rows[(rows["noise_model"] == noise_model) & ~rows["failed"]]
    cells = list(rows.groupby(["platform", "regime"], sort=False))
    figure = blank_figure(WIDE_IN, 0.6 + 0.75 * len(cells))
    panels = figure.subplots(len(cells), len(RANK_COLUMNS), sharex=True, squeeze=False)
    edges = np.linspace(0, N_RANKED + 1, N_BINS + 1)
    for i, (cell, part) in enumerate(cells):
        low, high = binom.interval(0.99, len(part), 1 / N_BINS)
        for j, column in enumerate(RANK_COLUMNS):
            panel = panels[i, j]
            panel.axhspan(low, high, color=GREY, alpha=0.3, linewidth=0)
            panel.stairs(rank_histogram(part[column]), edges, fill=True, color=_colour(noise_model), alpha=0.8)
            panel.set(xlim=(0, N_RANKED + 1), xticks=[0, 50, 100], yticks=[])
            if i == 0:
                panel.set_title(_PARAMETERS[j])
        platform, regime = cell
        words = f"{str(platform).removesuffix('-sim')} {str(regime).replace('-', ' ')}".replace(" ", "\n")
        panels[i, 0].set_ylabel(words, rotation=0, ha="right", va="center")
    figure.supxlabel(f"Rank of the true parameter among {N_RANKED} samples", fontsize=8)
    return figure


@styled
def errors(summary: pd.DataFrame) -> Figure:
    """Root-mean-square errors of position (m) and rotation (°), a group of bars a regime, a bar a noise model.

    `summary` as in `COVERAGE_SUMMARY`; one row of panels a platform.
    """
    rows = usable_rows(summary, ["platform", "regime", "noise_model"], "summary.parquet")
    rows = rows[rows[list(RMSE_COLUMNS)].notna().all(axis=1)]  # without those of which every estimate failed
    platforms, regimes, models = (_names(rows, key) for key in ("platform", "regime", "noise_model"))
    figure = blank_figure(WIDE_IN, 0.5 + 1.6 * len(platforms))
    panels = figure.subplots(len(platforms), 2, squeeze=False, sharex=True)
    for i, platform in enumerate(platforms):
        part = rows[rows["platform"] == platform]
        for panel, columns, scale in (
            (panels[i, 0], list(RMSE_COLUMNS[:3]), 1.0),
            (panels[i, 1], list(RMSE_COLUMNS[3:]), float(np.degrees(1.0))),
        ):
            for k, model in enumerate(models):
                line = part[part["noise_model"] == model].set_index("regime")
                at = [regimes.index(regime) for regime in line.index]
                total = scale * np.sqrt((line[columns].to_numpy() ** 2).sum(axis=1))
                shift = (k - (len(models) - 1) / 2) * 0.8 / len(models)
                panel.bar(np.array(at) + shift, total, 0.8 / len(models), color=_colour(model))
            panel.set_xticks(range(len(regimes)), regimes, rotation=35, ha="right")
            panel.set_yscale("log")
        panels[i, 0].set_ylabel(f"{platform}\nposition (m)")
        panels[i, 1].set_ylabel("rotation (°)")
    _legend(figure, models)
    return figure


def _names(rows: pd.DataFrame, column: str) -> list[str]:
    return [str(name) for name in dict.fromkeys(rows[column])]


def _colour(model: str) -> str:
    return noise_model(model).colour


def _legend(figure: Figure, models: list[str]) -> None:
    handles = [Line2D([], [], color=_colour(model), linewidth=2.5, label=model) for model in models]
    figure.legend(handles=handles, loc="outside upper center", ncols=len(models))
