"""Whether labels lie on dots, each on one of its own: by their places, and by the scans' pixels."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from linepose.arrays import Floats
from linepose.check.finding import Finding, error, numbers, warning
from linepose.errors import InputError
from linepose.inputs.scans.scan_files import read_intensity
from linepose.inputs.targets.contrast import contrast
from linepose.inputs.targets.refine import Refine, refine_points
from linepose.survey.point_names import in_words

_ONE_DOT_PX: Final = 1.0  # pixels and lines between centres of one dot
_ONE_TIME: Final = 0.002  # of a view's duration, between points seen at one time
_NOISE: Final = 4.0  # contrast that half of a scan's dots must have
_MOST: Final = 5  # of a kind that are named
_SUBJECT: Final = "labels"


def shared_findings(points: pd.DataFrame) -> list[Finding]:
    """Points of one observation that were seen at one pixel and time, of labelled views."""
    shared = []
    for number, view in points.groupby("observation"):
        time_us = view["time_us"].to_numpy(dtype=float)
        lasted = max(float(np.ptp(time_us)), 1.0)
        places = np.column_stack([view["u_px"], time_us / (_ONE_TIME * lasted) * _ONE_DOT_PX])
        shared += [(int(str(number)), pair) for pair in _pairs(view["point"].to_numpy(), places)]
    return _shared(shared)


def dot_findings(scans: Mapping[int, Path], labels: pd.DataFrame, refine: Refine) -> list[Finding]:
    """Labels of a scan that lead to one dot or to none, and scans in which the dots do not stand out of the noise."""
    shared: list[tuple[int, tuple[object, object]]] = []
    missing, noisy = [], []
    for number, path in scans.items():
        mine = labels[labels["observation"] == number]
        if mine.empty:
            continue
        try:
            intensity = read_intensity(path)
        except InputError:  # told by the run; the header was looked at before
            continue
        names, found = mine["point"].to_numpy(), refine_points(refine, intensity, mine[["u_px", "line"]])
        seen = np.isfinite(found[:, 0])
        missing += [f"{name} of observation {number}" for name in names[~seen]]
        shared += [(number, pair) for pair in _pairs(names[seen], found[seen])]
        if seen.any() and np.median([contrast(intensity, u, line) for u, line in found[seen]]) < _NOISE:
            noisy.append(number)
    findings = _shared(shared)
    if missing:
        advice = "correct or remove the label, or set source.refinement: none where points are no bright dots"
        findings.append(error(_SUBJECT, f"no dot near the label of point {in_words(missing, _MOST)}", advice))
    if noisy:
        told = f"scan {numbers(noisy)}: what the labels mark hardly stands out of the noise"
        findings.append(warning(_SUBJECT, told, "look at the scan and its labels, or add it to source.left_out"))
    return findings


def _pairs(names: np.ndarray, places: Floats) -> list[tuple[object, object]]:
    """Pairs of names whose places (K, 2) are one."""
    order = np.argsort(places[:, 0], kind="stable")
    pairs = []
    for rank, one in enumerate(order):
        for other in order[rank + 1 :]:
            if places[other, 0] - places[one, 0] >= _ONE_DOT_PX:
                break
            if abs(places[other, 1] - places[one, 1]) < _ONE_DOT_PX:
                pairs.append((names[min(one, other)], names[max(one, other)]))
    return pairs


def _shared(shared: Sequence[tuple[int, tuple[object, object]]]) -> list[Finding]:
    if not shared:
        return []
    told = [f"{one} and {other} of observation {number}" for number, (one, other) in shared]
    found = f"two points on one dot: {in_words(told, _MOST)}"
    return [error(_SUBJECT, found, "label each point on its own dot, and remove the label of one that is not seen")]
