"""The coverage study: coverage against what is stated, errors in stated sigmas, errors in metres and degrees."""

import math
import textwrap
from typing import Final

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from linepose.estimation.noise_models import noise_model
from linepose.experiments.coverage_summary import ALL_PLATFORMS, ratio_interval
from linepose.output.figures.style import BLACK, GREY, LEAST_PT, WIDE_IN, blank_figure, styled
from linepose.pipeline.table_checks import usable_rows

_PANELS_A_ROW: Final = 4
_TITLE_LETTERS: Final = 15
_MOST_TICKS: Final = 5  # that fit side by side on an axis
_ROW_IN: Final = 0.17
_PLATFORM_LINES: Final = ("-", "--", ":", "-.")
_PLATFORM_MARKERS: Final = ("o", "D", "s", "^")
_RATIOS_SHOWN: Final = (0.8, 1.3)


@styled
def coverage(curve: pd.DataFrame) -> Figure:
    """A panel a regime: how often regions hold the truth against what they state, with 95 % intervals.

    `curve` as in `COVERAGE`; a colour a noise model, a kind of line a platform.
    """
    rows = usable_rows(curve, ["platform", "regime", "noise_model", "nominal", "coverage"], "coverage.parquet")
    platforms, regimes = _names(rows, "platform"), _names(rows, "regime")
    n_rows, n_columns = math.ceil(len(regimes) / _PANELS_A_ROW), min(len(regimes), _PANELS_A_ROW)
    figure = blank_figure(WIDE_IN, 0.8 + 1.35 * n_rows)
    panels = figure.subplots(n_rows, n_columns, sharex=True, sharey=True, squeeze=False).ravel()
    for panel, regime in zip(panels, regimes, strict=False):
        panel.plot([0, 1], [0, 1], color=GREY, linewidth=0.8)
        for (platform, model), line in rows[rows["regime"] == regime].groupby(["platform", "noise_model"], sort=False):
            colour, kind = noise_model(str(model)).colour, _PLATFORM_LINES[platforms.index(str(platform)) % 4]
            panel.fill_between(line["nominal"], line["coverage_low"], line["coverage_high"], color=colour, alpha=0.15)
            panel.plot(line["nominal"], line["coverage"], kind, color=colour, linewidth=1.0)
        panel.set(xlim=(0, 1), ylim=(0, 1), xticks=[0, 0.5, 1], yticks=[0, 0.5, 1])
        panel.set_title(textwrap.fill(_in_words(regime), _TITLE_LETTERS))
    for panel in panels[len(regimes) :]:
        panel.set_axis_off()
    for panel in panels[max(len(regimes) - n_columns, 0) : len(regimes)]:
        panel.tick_params(labelbottom=True)
    figure.supxlabel("Stated probability of the region", fontsize=8)
    figure.supylabel("Share of surveys whose truth it holds", fontsize=8)
    kinds = [Line2D([], [], color=BLACK, linestyle=_PLATFORM_LINES[i % 4], label=n) for i, n in enumerate(platforms)]
    _legend(figure, _names(rows, "noise_model"), kinds)
    return figure


@styled
def ratios(summary: pd.DataFrame) -> Figure:
    """Errors in stated sigmas, a panel a platform and a row a regime, with where 95 % of right ones lie.

    `summary` as in `COVERAGE_SUMMARY`; right ones as if the six errors of a survey were independent. Ratios beyond the
    axis are written at its end.
    """
    rows = _of_platforms(summary, "ratio")
    platforms, regimes = _names(rows, "platform"), _names(rows, "regime")
    figure = blank_figure(WIDE_IN, 0.9 + _ROW_IN * len(regimes))
    panels = figure.subplots(1, len(platforms), sharex=True, sharey=True, squeeze=False)[0]
    least, most = _RATIOS_SHOWN
    for panel, platform in zip(panels, platforms, strict=True):
        panel.axvline(1.0, color=GREY, linewidth=0.8)
        part = rows[rows["platform"] == platform]
        for _, row in part.drop_duplicates("regime").iterrows():
            at = regimes.index(row["regime"])
            low, high = ratio_interval(row["n_surveys"] - row["n_failed"])
            panel.plot([low, high], [at, at], color=GREY, linewidth=5, alpha=0.5, solid_capstyle="butt")
        for _, row in part.iterrows():
            at, colour = regimes.index(row["regime"]), noise_model(row["noise_model"]).colour
            if least < row["ratio"] < most:
                panel.plot(row["ratio"], at, "o", color=colour, markersize=3.5)
            else:
                where = {"x": most, "ha": "right"} if row["ratio"] > 1 else {"x": least, "ha": "left"}
                panel.text(**where, y=at, s=f"{row['ratio']:.1f}", va="center", color=colour, fontsize=LEAST_PT + 1.5)
        panel.set_title(platform)
    panels[0].set(xlim=(least, most), xticks=[0.8, 0.9, 1.0, 1.1, 1.2, 1.3])
    _rows_of(panels[0], regimes)
    figure.supxlabel("Error in stated sigmas (1 is right)", fontsize=8)
    _legend(figure, _names(rows, "noise_model"), [])
    return figure


@styled
def errors(summary: pd.DataFrame) -> Figure:
    """Root-mean-square errors of position (m) and rotation (°), a row a regime.

    `summary` as in `COVERAGE_SUMMARY`; a colour a noise model, a marker a platform.
    """
    rows = _of_platforms(summary, "rmse_position_m")
    platforms, regimes = _names(rows, "platform"), _names(rows, "regime")
    figure = blank_figure(WIDE_IN, 0.9 + _ROW_IN * len(regimes))
    panels = figure.subplots(1, 2, sharey=True)
    for panel, column, scale, label, ticks in (
        (panels[0], "rmse_position_m", 1.0, "Position error (m)", (0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 100)),
        (panels[1], "rmse_turn_rad", float(np.degrees(1.0)), "Rotation error (°)", (0.2, 0.5, 1, 2, 5, 10, 20, 50)),
    ):
        for _, row in rows.iterrows():
            marker = _PLATFORM_MARKERS[platforms.index(row["platform"]) % 4]
            colour, at = noise_model(row["noise_model"]).colour, regimes.index(row["regime"])
            panel.plot(scale * row[column], at, marker, color=colour, markersize=3.5)
        panel.set_xscale("log")
        low, high = panel.get_xlim()
        shown = [tick for tick in ticks if low <= tick <= high]
        if len(shown) > _MOST_TICKS:
            shown = [tick for tick in shown if f"{tick:e}".startswith("1")]
        panel.set_xticks(shown, [f"{tick:g}" for tick in shown])
        panel.set_xticks([], minor=True)
        panel.set_xlabel(label)
    _rows_of(panels[0], regimes)
    marks = [
        Line2D([], [], color=BLACK, linestyle="", marker=_PLATFORM_MARKERS[i % 4], label=name)
        for i, name in enumerate(platforms)
    ]
    _legend(figure, _names(rows, "noise_model"), marks)
    return figure


def _of_platforms(summary: pd.DataFrame, column: str) -> pd.DataFrame:
    """The rows of cells, without pools and without cells of which every estimate failed."""
    rows = usable_rows(summary, ["platform", "regime", "noise_model"], "summary.parquet")
    return rows[(rows["platform"] != ALL_PLATFORMS) & rows[column].notna()]


def _names(rows: pd.DataFrame, column: str) -> list[str]:
    return [str(name) for name in dict.fromkeys(rows[column])]


def _in_words(regime: str) -> str:
    return regime.replace("-", " ")


def _rows_of(panel: Axes, regimes: list[str]) -> None:
    """The regimes as rows, the first on top."""
    panel.set(ylim=(len(regimes) - 0.5, -0.5))
    panel.set_yticks(range(len(regimes)), [_in_words(regime) for regime in regimes])


def _legend(figure: Figure, models: list[str], further: list[Line2D]) -> None:
    handles = [Line2D([], [], color=noise_model(model).colour, linewidth=2.5, label=model) for model in models]
    figure.legend(handles=handles + further, loc="outside upper center", ncols=len(models) + len(further))
