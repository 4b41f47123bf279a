"""What the adjustment's levels say, in words that need no table."""

from collections.abc import Mapping
from typing import Final

import numpy as np
import pandas as pd

from linepose.adjustment.thresholds import CLOCK, JUMP, LABEL, UNCLEAR
from linepose.arrays import Floats
from linepose.experiments.adjustment_beside import INLIERS
from linepose.output.adjusted import common_share, set_in_words
from linepose.pipeline.evidence import position_error

LEVEL_WORDS: Final = {
    "drift": "Navigation error that drifts (reported sigmas)",
    "correlation_time_s": "How long the drift lasts (s)",
    "constant": "Navigation error common to an observation (reported sigmas)",
    "white": "Navigation error of each measurement's own (reported sigmas)",
    "attitude": "Attitude errors, times the above (no unit)",
    "pixel": "Noise along the scan line (stated pixel sigmas)",
    "lateness": "Noise across it, as lateness (lines)",
}
FAULT_WORDS: Final = {
    CLOCK: "as if its clock were off",
    LABEL: "as if points were mislabelled",
    JUMP: "as if the navigation had jumped",
    UNCLEAR: "with too few points to tell why",
}
_NOTABLE: Final = 0.05  # of the reported sigmas: below, a part of the error is not worth a word
_LONG: Final = 0.5  # share of the drift that a survey has in common, from which a boresight has it in it


def level_values(table: pd.DataFrame) -> pd.DataFrame:
    """Value, low, high of each level by its name; `table` as in `LEVELS`."""
    return table.set_index("level")[["value", "low", "high"]].astype(float)


def levels_sentence(table: pd.DataFrame) -> str:
    """The levels in two sentences; `table` as in `LEVELS`."""
    value = level_values(table)["value"]
    whole = position_error(value)
    parts = []
    if value["drift"] >= _NOTABLE:
        parts.append(f"{value['drift']:.2g} drifts within {seconds(value['correlation_time_s'])}")
    if value["constant"] >= _NOTABLE:
        parts.append(f"{value['constant']:.2g} is common to an observation")
    if value["white"] >= _NOTABLE:
        parts.append(f"{value['white']:.2g} is each measurement's own")
    made_of = f" ({', '.join(parts)})" if parts else ""
    return (
        f"The navigation's position errs by {whole:.2g} of what it reports{made_of}, its attitude by "
        f"{whole * value['attitude']:.2g} of what it reports. Labels are good to {value['pixel']:.2g} of the stated "
        f"pixel noise along the scan line and to {value['lateness']:.2g} line across it."
    )


def seconds(value: float) -> str:
    """A duration as people say it."""
    return f"{value:.0f} s" if value < 120 else f"{value / 60:.0f} min"


def boresight_sentence(table: pd.DataFrame, duration_s: float, reported_rad: Floats) -> str:
    """What a boresight means where drift outlasts the survey; empty where it does not.

    `duration_s` is the survey's, `reported_rad` (3,) the typical reported sigmas of roll, pitch and yaw.
    """
    value = level_values(table)["value"]
    share = common_share(value["correlation_time_s"], duration_s)
    if share < _LONG or value["drift"] < _NOTABLE:
        return ""
    common_deg = np.degrees(np.sqrt(share) * value["drift"] * value["attitude"] * np.asarray(reported_rad))
    names = ", ".join(f"{one:.3f}° in {name}" for one, name in zip(common_deg, ("roll", "pitch", "yaw"), strict=True))
    return (
        f"The drift lasts {seconds(value['correlation_time_s'])}, the survey {seconds(duration_s)}: "
        f"{100 * share:.0f} % of the drift's variance is common to the whole survey, and no data of one survey can "
        f"tell an attitude error common to it from the camera's boresight. The angles found have it in them, {names} "
        "(one sigma): they are right for this survey, and another day's will differ by as much. Average over surveys "
        "of several days."
    )


def sigmas_sentence(tables: Mapping[str, pd.DataFrame]) -> str:
    """Which reported sigmas look wrong, attitude against position, set by set; `tables` as in `LEVELS`."""
    told = [_sigmas_of(name, table) for name, table in tables.items()]
    sentence = f"Reported attitude sigmas against position sigmas: {'; '.join(told)}."
    first, *others = tables
    better = [name for name in others if name != INLIERS and attitude_fits(tables[name])]
    if attitude_fits(tables[first]) is not False or not better:
        return sentence
    return (
        f"{sentence} Where {' or '.join(better)} differs from this platform in its covariance columns alone, those "
        "columns are the ones to read the attitude from."
    )


def attitude_fits(table: pd.DataFrame) -> bool | None:
    """Whether the attitude sigmas fit the position sigmas as they are; None where that is not known."""
    factor = level_values(table).loc["attitude"]
    if not np.isfinite(factor[["low", "high"]]).all():
        return None
    return bool(factor["low"] <= 1.0 <= factor["high"])


def _sigmas_of(name: str, table: pd.DataFrame) -> str:
    factor, fits = level_values(table).loc["attitude"], attitude_fits(table)
    place = set_in_words(name)
    if fits is None:
        return f"{place}: not known"
    interval = f"{factor['low']:.2g} to {factor['high']:.2g}"
    if fits:
        return f"{place}: they fit as they are (factor {factor['value']:.2g}, {interval} with 95 %)"
    word = "large" if factor["value"] < 1 else "small"
    return f"{place}: they look too {word} and want a factor of {factor['value']:.2g} ({interval} with 95 %)"
