"""The coverage study: coverage against what is stated, sigma ratios, and errors."""

import math
from typing import Final

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from linepose.experiments.coverage_summary import ALL_PLATFORMS, ratio_interval
from linepose.output.figures.style import GREEN, GREY, ORANGE, WIDE_IN, blank_figure, styled
from linepose.pipeline.table_checks import usable_rows

_PANELS_A_ROW: Final = 4
_COLOURS: Final = {"adjustment": GREEN, "published": ORANGE}


@styled
def coverage(curve: pd.DataFrame) -> Figure:
    """A panel a platform and regime: how often regions hold the truth against what they state, with 95 % intervals.

    `curve` as in `COVERAGE`.
    """
    rows = usable_rows(curve, ["platform", "regime", "noise_model", "nominal", "coverage"], "coverage.parquet")
    platforms, regimes = _names(rows, "platform"), _names(rows, "regime")
    n_rows = math.ceil(len(regimes) / _PANELS_A_ROW)  # of a platform
    n_columns = min(len(regimes), _PANELS_A_ROW)
    figure = blank_figure(WIDE_IN, 0.6 + 1.35 * n_rows * len(platforms))
    panels = figure.subplots(n_rows * len(platforms), n_columns, sharex=True, sharey=True, squeeze=False)
    for panel in panels.flat:
        panel.set_axis_off()
    for i, platform in enumerate(platforms):
        for j, regime in enumerate(regimes):
            panel = panels[n_rows * i + j // n_columns, j % n_columns]
            panel.set_axis_on()
            _curves(panel, rows[(rows["platform"] == platform) & (rows["regime"] == regime)])
            panel.set_title(_in_words(regime, "\n"))
            if j % n_columns == 0:
                panel.set_ylabel(f"{platform}\nholds the truth")
    figure.supxlabel("Stated probability of the region", fontsize=8)
    _legend(figure, _names(rows, "noise_model"))
    return figure


def _curves(panel: Axes, part: pd.DataFrame) -> None:
    panel.plot([0, 1], [0, 1], color=GREY, linewidth=0.8)
    for model, line in part.groupby("noise_model", sort=False):
        colour = _COLOURS[str(model)]
        panel.fill_between(line["nominal"], line["coverage_low"], line["coverage_high"], color=colour, alpha=0.2)
        panel.plot(line["nominal"], line["coverage"], color=colour, linewidth=1.0)
    panel.set(xlim=(0, 1), ylim=(0, 1), xticks=[0, 0.5, 1], yticks=[0, 0.5, 1])


@styled
def ratios(summary: pd.DataFrame) -> Figure:
    """Errors in units of the stated sigmas, a panel a platform and a row a regime, with where 95 % of right ones are.

    `summary` as in `COVERAGE_SUMMARY`.
    """
    rows = _of_platforms(summary, "ratio")
    platforms, regimes = _names(rows, "platform"), _names(rows, "regime")
    figure = blank_figure(WIDE_IN, 0.9 + 0.17 * len(regimes))
    panels = figure.subplots(1, len(platforms), sharex=True, sharey=True, squeeze=False)
    for panel, platform in zip(panels[0], platforms, strict=True):
        part = rows[rows["platform"] == platform]
        for _, row in part.iterrows():
            at = regimes.index(row["regime"])
            low, high = ratio_interval(row["n_surveys"] - row["n_failed"])
            panel.plot([low, high], [at, at], color=GREY, linewidth=5, alpha=0.5, solid_capstyle="butt")
            panel.plot(row["ratio"], at, "o", color=_COLOURS[row["noise_model"]])
        panel.axvline(1.0, color=GREY, linewidth=0.8)
        panel.set_title(platform)
    first = panels[0, 0]
    first.set_xscale("log")
    low, high = 0.95 * min(rows["ratio"].min(), 0.9), 1.05 * max(rows["ratio"].max(), 1.1)
    ticks = [tick for tick in (0.5, 0.7, 1, 1.5, 2, 3, 5, 7, 10, 20) if low <= tick <= high]
    first.set(xlim=(low, high), ylim=(len(regimes) - 0.5, -0.5))
    first.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    first.set_xticks([], minor=True)
    first.set_yticks(range(len(regimes)), [_in_words(regime, " ") for regime in regimes])
    figure.supxlabel("Error in stated sigmas (1 is right)", fontsize=8)
    _legend(figure, _names(rows, "noise_model"))
    return figure


@styled
def errors(summary: pd.DataFrame) -> Figure:
    """Root-mean-square errors of position (m) and rotation (°), a group of bars a regime, a bar a noise model.

    `summary` as in `COVERAGE_SUMMARY`; one row of panels a platform.
    """
    rows = _of_platforms(summary, "rmse_position_m")
    platforms, regimes, models = (_names(rows, key) for key in ("platform", "regime", "noise_model"))
    figure = blank_figure(WIDE_IN, 1.0 + 1.5 * len(platforms))
    panels = figure.subplots(len(platforms), 2, squeeze=False, sharex=True)
    for i, platform in enumerate(platforms):
        part = rows[rows["platform"] == platform]
        for panel, column, scale in (
            (panels[i, 0], "rmse_position_m", 1.0),
            (panels[i, 1], "rmse_turn_rad", float(np.degrees(1.0))),
        ):
            for k, model in enumerate(models):
                line = part[part["noise_model"] == model]
                at = np.array([regimes.index(regime) for regime in line["regime"]])
                shift = (k - (len(models) - 1) / 2) * 0.8 / len(models)
                panel.bar(at + shift, scale * line[column], 0.8 / len(models), color=_COLOURS[model])
            panel.set_xticks(range(len(regimes)), [_in_words(regime, " ") for regime in regimes], rotation=90)
        panels[i, 0].set_ylabel(f"{platform}\nposition (m)")
        panels[i, 1].set_ylabel("rotation (°)")
    _legend(figure, models)
    return figure


def _of_platforms(summary: pd.DataFrame, column: str) -> pd.DataFrame:
    """The rows of cells, without pools and without cells of which every estimate failed."""
    rows = usable_rows(summary, ["platform", "regime", "noise_model"], "summary.parquet")
    return rows[(rows["platform"] != ALL_PLATFORMS) & rows[column].notna()]


def _names(rows: pd.DataFrame, column: str) -> list[str]:
    return [str(name) for name in dict.fromkeys(rows[column])]


def _in_words(regime: str, between: str) -> str:
    """A regime's name for people: its hyphens as spaces, the first of them as `between` where it is long."""
    return regime.replace("-", " ") if len(regime) < 12 else between.join(regime.replace("-", " ").rsplit(" ", 1))


def _legend(figure: Figure, models: list[str]) -> None:
    handles = [Line2D([], [], color=_COLOURS[model], linewidth=2.5, label=model) for model in models]
    figure.legend(handles=handles, loc="outside upper center", ncols=len(models))
