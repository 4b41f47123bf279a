"""What the adjustment corrected in the reported body poses, measurement by measurement, beside what was reported."""

from typing import Final

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from linepose.arrays import Floats
from linepose.output.adjusted import CORRECTION_HEADS, CORRECTION_SCALE, without_adjustment
from linepose.output.figures.entry import FigureEntry
from linepose.output.figures.style import BLACK, BLUE, GREY, ORANGE, WIDE_IN, blank_figure, styled
from linepose.pipeline.adjusted_schemas import CORRECTION_COLUMNS, MEASUREMENTS
from linepose.pipeline.calibration import Calibration
from linepose.pipeline.table_checks import usable_rows
from linepose.survey.observations import OBSERVATIONS, VARIANCE_COLUMNS

_VARIANCES: Final = list(VARIANCE_COLUMNS)
_GAP: Final = 0.25  # of a mean observation's duration, drawn between one observation and the next
_LEAST: Final = 0.3  # of a mean observation's duration, as which a shorter one is drawn
_LABEL_SHARE: Final = 0.09  # of the axis, which a label takes


@styled
def corrections(measurements: pd.DataFrame, observations: pd.DataFrame) -> Figure:
    """A panel a number of the body's pose: corrections against time, one observation beside the other.

    `measurements` as in `MEASUREMENTS`; `observations` as in `OBSERVATIONS` has the reported sigmas, the band.
    """
    rows = with_sigmas(measurements, observations)
    time, centre = side_by_side(rows)
    numbers = list(centre)
    figure = blank_figure(WIDE_IN, 4.8)
    panels = figure.subplots(3, 2, sharex=True)
    for index, panel in enumerate(panels.T.ravel()):
        for place, number in enumerate(numbers):
            mine = (rows["observation"] == number).to_numpy()
            value = CORRECTION_SCALE[index] * rows.loc[mine, CORRECTION_COLUMNS[index]]
            sigma = CORRECTION_SCALE[index] * rows.loc[mine, f"sigma_{index}"]
            panel.fill_between(time[mine], -sigma, sigma, color=GREY, alpha=0.3, linewidth=0)
            colour = (BLUE, ORANGE)[place % 2]
            panel.plot(time[mine], value, ".-", color=colour, markersize=2.5, linewidth=0.7)
        panel.axhline(0.0, color=BLACK, linewidth=0.5)
        panel.set_ylabel(CORRECTION_HEADS[index])
        panel.grid(visible=False, axis="x")
        panel.margins(x=0.01)
    shown = labelled(centre, _LABEL_SHARE * float(time.max()))
    for panel in panels[-1]:
        panel.set_xticks([centre[number] for number in shown], shown)
        panel.tick_params(axis="x", length=0)
        panel.set_xlabel("Observation, in time")
    handles = [
        Line2D([], [], color=BLUE, marker=".", linewidth=0.7, label="one observation"),
        Line2D([], [], color=ORANGE, marker=".", linewidth=0.7, label="the next"),
        Patch(color=GREY, alpha=0.3, label="± 1 sigma reported"),
    ]
    figure.align_ylabels()
    figure.legend(handles=handles, loc="outside upper center", ncols=3)
    return figure


def corrections_caption(measurements: pd.DataFrame, observations: pd.DataFrame) -> str:
    """How large the corrections are beside the reported sigmas, and how long observations and survey lasted."""
    rows = with_sigmas(measurements, observations)
    ratio = [_rms(rows[CORRECTION_COLUMNS[k]] / rows[f"sigma_{k}"]) for k in range(6)]
    time_s = 1e-6 * rows["time_us"].to_numpy(dtype=float)
    lasted = 1e-6 * rows.groupby("observation")["time_us"].agg(np.ptp)
    return (
        "What the adjustment takes off the reported body poses, in time, the breaks between observations cut short. "
        f"RMS {_listed(ratio[:3])} of the reported sigmas in north, east and down, and {_listed(ratio[3:])} in roll, "
        f"pitch and yaw. An observation lasted {lasted.min():.1f} to {lasted.max():.1f} s, the survey "
        f"{np.ptp(time_s):.0f} s. A slope within an observation is drift, a step from one to the next is what an "
        "observation shares. Corrections that stay within a part of the band say that the reported sigmas are too "
        "large there; where data say little they stay near zero."
    )


def with_sigmas(measurements: pd.DataFrame, observations: pd.DataFrame) -> pd.DataFrame:
    """The measurements in time, each with the reported sigmas of its body pose as `sigma_0` to `sigma_5`."""
    usable_rows(measurements, CORRECTION_COLUMNS, "adjusted_measurements.parquet")
    reported = usable_rows(observations, _VARIANCES, "observations.parquet")[["observation", "point", *_VARIANCES]]
    joined = measurements.merge(reported, on=["observation", "point"], how="left")
    usable_rows(joined, _VARIANCES, "observations.parquet, points of adjusted_measurements.parquet")
    sigmas = np.sqrt(np.maximum(joined[_VARIANCES].to_numpy(), 0.0))
    joined[[f"sigma_{k}" for k in range(6)]] = sigmas
    return joined.sort_values(["time_us", "observation", "point"], kind="stable", ignore_index=True)


def side_by_side(rows: pd.DataFrame) -> tuple[Floats, dict[int, float]]:
    """A place in time (L,) for every measurement, observations in their order without the breaks between them.

    Also the middle of each observation, by its number.
    """
    time_s = 1e-6 * (rows["time_us"] - rows["time_us"].min()).to_numpy(dtype=float)
    parts = {int(number): part for number, part in rows.groupby("observation", sort=False).indices.items()}
    lasted = {number: float(np.ptp(time_s[part])) for number, part in parts.items()}
    mean = float(np.mean(list(lasted.values()))) or 1.0
    place, centre, start = np.zeros(len(rows)), {}, 0.0
    for number, part in parts.items():
        width = max(lasted[number], _LEAST * mean)
        place[part] = start + time_s[part] - time_s[part].min() + (width - lasted[number]) / 2
        centre[number] = start + width / 2
        start += width + _GAP * mean
    return place, centre


def labelled(centre: dict[int, float], clear: float) -> list[int]:
    """The observations whose numbers are written: as many as stand `clear` of each other, the first among them."""
    shown: list[int] = []
    for number, place in centre.items():
        if not shown or place - centre[shown[-1]] >= clear:
            shown.append(number)
    return shown


def _rms(values: pd.Series) -> float:
    finite = values.to_numpy()[np.isfinite(values.to_numpy())]
    return float(np.sqrt(np.mean(finite**2))) if finite.size else 0.0


def _listed(values: list[float]) -> str:
    return ", ".join(f"{value:.2f}" for value in values)


def _tables(r: Calibration) -> tuple[pd.DataFrame, pd.DataFrame]:
    return r.results.table("adjusted_measurements", MEASUREMENTS), r.results.table("observations", OBSERVATIONS)


FIGURES: Final = (
    FigureEntry(
        "corrections",
        "Corrections of the navigation",
        "six panels of the corrections of the body's position and attitude in time, with the reported sigmas as a band",
        ("adjusted_measurements", "observations"),
        lambda r: corrections(*_tables(r)),
        lambda r: corrections_caption(*_tables(r)),
        without_adjustment,
    ),
)
