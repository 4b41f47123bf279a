"""The section that says of each parameter whether data or prior decided it."""

from typing import Final

import numpy as np

from linepose.estimation.identifiability import WORDS
from linepose.experiments.prior import PRIOR_TABLE
from linepose.geometry.pose import N_PARAMETERS
from linepose.output.report.sections import SectionOnPage, TableOnPage
from linepose.pipeline.calibration import Calibration

_WITH: Final = (
    "The hand measurement is a prior of the pose. The weight is the data's share of what is known: near 1 the data "
    "decided, near 0 the prior did."
)
_WITHOUT: Final = (
    "The data decided the pose alone: the hand measurement is no prior. The weight is what the data would have beside "
    "it; below one half the tape measure knew that parameter better, and `prior: hand_measured` in the platform's file "
    "would help."
)

_OTHERS: Final = " Levels and intrinsics always have a prior, which is the noise model's and the camera's."


def prior_weight_section(calibration: Calibration) -> SectionOnPage | None:
    """The section; None where the result was not made."""
    if not calibration.results.has("prior"):
        return None
    table = calibration.results.table("prior", PRIOR_TABLE)
    rows = [
        [
            _name(row["parameter"]),
            _number(row["difference"], row["parameter"]),
            _number(row["sigma"], row["parameter"]),
            _number(row["prior_sigma"], row["parameter"]),
            f"{row['data_weight']:.2f}",
            row["decided_by"],
        ]
        for _, row in table.iterrows()
    ]
    counted_in = bool(table["prior_counted_in"].iloc[0])
    known = ["Estimate minus prior", "Prior's sigma"] if counted_in else ["Estimate minus hand", "Sigma by hand"]
    heads = ["Parameter", known[0], "Sigma", known[1], "Weight of the data", "Decided by"]
    anchor = f"{calibration.name}-decided"
    title = "Data or prior" if counted_in else "Data or hand measurement"
    sentence = f"{_count(table['decided_by'])}."
    on_page = TableOnPage(f"{anchor}-table", title, sentence, heads, rows, folded=False)
    text = (_WITH if counted_in else _WITHOUT) + (_OTHERS if len(table) > N_PARAMETERS else "")
    return SectionOnPage(anchor, "What decided each parameter", text, [on_page])


def _count(deciders: "np.ndarray | object") -> str:
    counts = dict(zip(*np.unique(np.asarray(deciders, dtype=str), return_counts=True), strict=True))
    return ", ".join(
        f"{counts[name]} decided by {name}" for name in ("data", "data and prior", "prior") if name in counts
    )


def _name(parameter: str) -> str:
    unit = {"m": "m", "rad": "°", "px": "px"}.get(parameter.rsplit("_", 1)[-1], "")
    words = WORDS.get(parameter, parameter).removeprefix("the ")
    if parameter == "focal_length_m":
        unit = "mm"
    return f"{words} ({unit})" if unit else f"{words} (logarithm)"


def _number(value: float, parameter: str) -> str:
    if parameter.endswith("_rad"):
        return f"{np.degrees(value) + 0.0:.2f}"
    return f"{1e3 * value + 0.0:.4f}" if parameter == "focal_length_m" else f"{value + 0.0:.4f}"
