"""The coverage study's table as Markdown, for people."""

from typing import Final

import pandas as pd

from linepose.experiments.coverage_summary import RMSE_COLUMNS

HEADINGS: Final = (
    *("platform", "true error", "model", "68 % region holds", "95 % region holds"),
    "RMSE r_x r_y r_z (m)",
    *("RMSE rotation vector (rad)", "failed"),
)


def coverage_table(summary: pd.DataFrame) -> str:
    """A Markdown table, one row a cell; intervals are of 95 %."""
    lines = ["| " + " | ".join(HEADINGS) + " |", "|" + " --- |" * len(HEADINGS)]
    for _, row in summary.iterrows():
        rmse = (
            [f"{row[column]:.3f}" for column in RMSE_COLUMNS]
            if row["n_failed"] < row["n_surveys"]
            else ["-", "", ""] * 2
        )
        cells = [
            *(row["platform"], row["regime"], row["noise_model"], _rate(row, 68), _rate(row, 95)),
            " ".join(rmse[:3]).strip(),
            *(" ".join(rmse[3:]).strip(), f"{row['n_failed']} of {row['n_surveys']}"),
        ]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def _rate(row: pd.Series, percent: int) -> str:
    low, high = row[f"coverage_{percent}_low"], row[f"coverage_{percent}_high"]
    return f"{row[f'coverage_{percent}']:.2f} ({low:.2f}-{high:.2f})"
