"""The coverage study's table as Markdown, for people."""

from typing import Final

import numpy as np
import pandas as pd

from linepose.experiments.coverage_summary import RMSE_COLUMNS

HEADINGS: Final = (
    *("platform", "true error", "model", "68 % region holds", "95 % region holds", "ratio", "uniform p"),
    *("RMSE r_x r_y r_z (mm)", "RMSE turn x y z (mrad)", "heavy tails", "failed"),
)
NONE: Final = "-"


def coverage_table(summary: pd.DataFrame) -> str:
    """A Markdown table, one row a cell or pool; intervals are of 95 %."""
    lines = ["| " + " | ".join(HEADINGS) + " |", "|" + " --- |" * len(HEADINGS)]
    lines += ["| " + " | ".join(_cells(row)) + " |" for _, row in summary.iterrows()]
    return "\n".join(lines) + "\n"


def _cells(row: pd.Series) -> list[str]:
    return [
        *(row["platform"], row["regime"], row["noise_model"], _rate(row, 68), _rate(row, 95)),
        _number(row["ratio"], "{:.2f}"),
        _p_value(row["uniform_p_value"]),
        " ".join(_number(1e3 * row[name], "{:.0f}") for name in RMSE_COLUMNS[:3]),
        " ".join(_number(1e3 * row[name], "{:.1f}") for name in RMSE_COLUMNS[3:]),
        _number(100 * row["heavy_tails_share"], "{:.0f} %"),
        f"{row['n_failed']} of {row['n_surveys']}",
    ]


def _rate(row: pd.Series, percent: int) -> str:
    low, high = row[f"coverage_{percent}_low"], row[f"coverage_{percent}_high"]
    return f"{row[f'coverage_{percent}']:.3f} ({low:.2f}-{high:.2f})"


def _number(value: float, form: str) -> str:
    return form.format(value) if np.isfinite(value) else NONE


def _p_value(value: float) -> str:
    return f"{value:.3f}" if value >= 0.001 else "< 0.001"
