"""A point that somebody clicked in a picture of a scan, and the way from there to labels."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from linepose.errors import InputError
from linepose.survey.pattern import N_POINTS

_CENTRE: Final = 0.5  # of the first pixel, counted from the picture's corner
_INTERLEAVES: Final = {".bil", ".bip", ".bsq"}


@dataclass(frozen=True)
class Clicked:
    """Text and place (x, y) of a label, from the corner of a picture of this name and width; `where` for messages.

    `given` are the other places that may hold the point's id: name ("group_id") and text.
    """

    text: str
    x: float
    y: float
    picture: str
    width: int | None
    where: str
    given: tuple[tuple[str, str], ...] = ()


def labels_of(clicked: Sequence[Clicked], scans: Mapping[int, Path], n_pixels: int) -> pd.DataFrame:
    """Labels observation, point, u_px, line, ordered by the first two; raises InputError naming what is no label."""
    observation_of = _observations(scans)
    rows: dict[tuple[int, int], tuple[float, float]] = {}
    for one in clicked:
        observation = observation_of.get(_name(one.picture))
        if observation is None:
            expected = f"the name of a scan: {', '.join(sorted(observation_of)[:3])}, ..."
            raise InputError(one.where, f"picture {one.picture}", expected, "rename the picture, or remove its labels")
        if one.width not in (None, n_pixels):
            found, expected = f"a picture {one.width} pixels wide", f"{n_pixels}, as camera.n_pixels says"
            raise InputError(one.where, found, expected, "label the scan's own pixels, neither turned nor scaled")
        if not (np.isfinite(one.x) and np.isfinite(one.y)):
            raise InputError(one.where, f"place {one.x}, {one.y}", "two numbers", "remove the label")
        key = observation, point_of(one)
        if key in rows:
            found = f"point {key[1]} of {one.picture} again"
            raise InputError(one.where, found, "each point once a scan", "remove one of the labels")
        rows[key] = one.x - _CENTRE, one.y - _CENTRE
    ordered = sorted((*key, *place) for key, place in rows.items())
    return pd.DataFrame(ordered, columns=["observation", "point", "u_px", "line"])


def _observations(scans: Mapping[int, Path]) -> dict[str, int]:
    """Observation by the scan's name, which must tell the scans apart."""
    found: dict[str, int] = {}
    for number, path in scans.items():
        before = found.setdefault(_name(path.name), number)
        if before != number:
            place, expected = str(path), f"another name than {scans[before]}"
            raise InputError(place, f"the name {path.name} again", expected, "rename the scan, or label in our CSV")
    return found


def point_of(clicked: Clicked) -> int:
    """The point's id: a number that `given` holds, or at the end of the label ("7", "point 7", "p07").

    No other digit counts. Raises InputError where there is no id, or two that differ.
    """
    found: dict[str, int] = {}
    expected = f"one number from 0 to {N_POINTS - 1}"
    for place, text in clicked.given:
        if not re.fullmatch(r"\d{1,9}", text.strip()):
            raise InputError(clicked.where, f"{place} {text!r}", expected, "write the point's id there, or clear it")
        found[place] = int(text)
    of_label = re.fullmatch(r"(?:[^\W\d]\D*|#)?(\d{1,9})", clicked.text.strip())
    if of_label:
        found["label"] = int(of_label[1])
    if len(set(found.values())) > 1:
        told = " and ".join(f"{place} {number}" for place, number in found.items())
        raise InputError(clicked.where, told, "one id of the point", "keep the point's id in one of them")
    number = next(iter(found.values()), N_POINTS)
    if number >= N_POINTS:
        places = {"label": clicked.text, **dict(clicked.given)}
        told = ", ".join(f"{place} {text!r}" for place, text in places.items())
        remedy = "write the point's id in the label, LabelMe's group_id or CVAT's attribute id, or remove it"
        raise InputError(clicked.where, told, expected, remedy)
    return number


def _name(file: str) -> str:
    """Name of a scan or picture without folders and endings; `run` of run.hdr, run.bil.hdr and run.png."""
    stem = Path(file.replace("\\", "/")).stem
    return Path(stem).stem if Path(stem).suffix.lower() in _INTERLEAVES else stem
