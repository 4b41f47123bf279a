"""The tables of the section on the adjustment."""

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from linepose.experiments.adjustment_beside import ALL
from linepose.geometry.pose import POSE_COLUMNS, SIGMA_COLUMNS
from linepose.output.adjusted import CORRECTION_HEADS, CORRECTION_SCALE, Halves, estimates, set_in_words
from linepose.output.report.adjustment_words import (
    FAULT_WORDS,
    LEVEL_WORDS,
    attitude_fits,
    level_values,
)
from linepose.output.report.sections import TableOnPage
from linepose.pipeline.adjusted_schemas import CORRECTION_COLUMNS
from linepose.pipeline.calibration import INLIERS, Calibration
from linepose.pipeline.evidence import pose_numbers, position_error


def pose_table(anchor: str, calibration: Calibration) -> TableOnPage:
    """The pose under the adjustment and under the platform's own noise model, beside the hand measurement."""
    table, numbers = estimates(calibration), pose_numbers(calibration)
    own = (table["noise_model"] == calibration.noise_model) & (table["set"] == INLIERS)
    beside = (table["noise_model"] != calibration.noise_model) & table["set"].isin([ALL, INLIERS])
    chosen = [row for _, row in pd.concat([table[beside], table[own]]).iterrows()]
    heads = ["Number", *(_counted(row) for row in chosen), "By hand"]
    rows = [
        [
            f"{number.name} ({number.unit})",
            *(f"{row[POSE_COLUMNS[k]]:.4f} ± {row[SIGMA_COLUMNS[k]]:.4f}" for row in chosen),
            f"{number.hand:.4f} ± {number.hand_sigma:.4f}",
        ]
        for k, number in enumerate(numbers)
    ]
    if calibration.true_pose is not None:
        heads.append("Truth")
        rows = [[*row, f"{truth:.4f}"] for row, truth in zip(rows, calibration.true_pose, strict=True)]
    sentence = (
        "First the pose under the adjustment, which needs no observation removed, then the same of the accepted ones "
        f"alone, then that of the {calibration.noise_model} noise model; each with one sigma."
    )
    return TableOnPage(anchor, "Pose by noise model", sentence, heads, rows, folded=False)


def _counted(row: "pd.Series") -> str:
    which = "all" if row["set"] == ALL else "accepted"
    return f"{str(row['noise_model']).capitalize()}, {row['n_observations']} {which}"


def level_table(anchor: str, levels: Mapping[str, pd.DataFrame]) -> TableOnPage:
    """Each level with its 95 % interval, a column a set of observations, and what was known before the data."""
    first = next(iter(levels.values())).set_index("level")
    values = [level_values(table) for table in levels.values()]
    rows = [
        [
            words,
            *(_interval(*one.loc[level]) for one in values),
            _interval(*first.loc[level, ["prior_median", "prior_low", "prior_high"]]),
        ]
        for level, words in LEVEL_WORDS.items()
    ]
    heads = ["Level", *(set_in_words(name).capitalize() for name in levels), "Before the data"]
    return TableOnPage(anchor, "Levels", "Each with its 95 % interval.", heads, rows, folded=False)


def sigma_table(anchor: str, levels: Mapping[str, pd.DataFrame]) -> TableOnPage:
    """How large errors were beside the reported sigmas, position and attitude, a row a set of observations."""
    rows = []
    for name, table in levels.items():
        of_set = level_values(table)
        factor, whole = of_set.loc["attitude"], position_error(of_set["value"])
        verdict = {True: "fit", False: "look wrong", None: "not known"}[attitude_fits(table)]
        cells = [f"{whole:.2f}", f"{whole * factor['value']:.2f}", _interval(*factor)]
        rows.append([set_in_words(name), *cells, verdict])
    heads = ["Observations", "Position error / reported", "Attitude error / reported", "Attitude over position"]
    heads.append("Attitude sigmas")
    return TableOnPage(anchor, "Reported sigmas", "", heads, rows, folded=False)


def halves_table(anchor: str, found: Sequence[Halves]) -> TableOnPage:
    """How far apart random halves lie, a row a model and a set of observations."""
    rows = [
        [
            one.noise_model,
            set_in_words(one.set),
            f"{len(one.distance)}",
            f"{np.median(one.distance):.2f}",
            f"{one.factor:.2f}",
        ]
        for one in found
    ]
    heads = ["Noise model", "Observations", "Splits", "Median distance (sigmas)", "Times as far apart as stated"]
    return TableOnPage(anchor, "Random halves", f"{len(rows)} comparison{'s' * (len(rows) != 1)}", heads, rows)


def view_table(anchor: str, views: pd.DataFrame) -> TableOnPage:
    """Each observation's weight, the least of it and its measurements, what its errors look like, mean correction."""
    rows = []
    for _, row in views.iterrows():
        mean = CORRECTION_SCALE * row[list(CORRECTION_COLUMNS)].to_numpy(dtype=float)
        cells = [f"{value + 0.0:.{1 if k < 3 else 3}f}" if np.isfinite(value) else "" for k, value in enumerate(mean)]
        weights = [f"{row[name]:.2f}" if np.isfinite(row[name]) else "" for name in ("weight", "least_weight")]
        rows.append([str(row["observation"]), *weights, FAULT_WORDS.get(row["fault"], ""), *cells])
    heads = ["Observation", "Weight", "Least, of a measurement too", "Errors look", *CORRECTION_HEADS]
    sentence = f"weight and mean correction of {len(rows)} observations"
    return TableOnPage(anchor, "Observations", sentence, heads, rows)


def _interval(value: float, low: float, high: float) -> str:
    if not np.isfinite([low, high]).all():
        return _two_digits(value)
    return f"{_two_digits(value)} ({_two_digits(low)} to {_two_digits(high)})"


def _two_digits(value: float) -> str:
    """To two digits that count, written out: 15000, not 1.5e+04."""
    return f"{float(f'{value:.2g}'):.10g}"
