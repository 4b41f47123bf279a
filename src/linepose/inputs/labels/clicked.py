"""A point that somebody clicked in a picture of a scan, and the way from there to labels."""

import re
from collections.abc import Mapping, Sequence, Set
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from linepose.errors import InputError, quoted
from linepose.inputs.scans.scan_files import scan_size
from linepose.survey.point_names import WHAT, point_name, point_names

_CENTRE: Final = 0.5  # of the first pixel, counted from the picture's corner
_NUMBERED: Final = re.compile(r"(?:#|(?:point|pt|p|id)[\s_#.:-]*)?(\d{1,9})", re.IGNORECASE)
IDS: Final = ("group_id", "id", "point", "point_id", "point id")  # places that are known to hold names
_OF_HEADER: Final = ".hdr"
_OF_DATA: Final = {".bil", ".bip", ".bsq", ".raw", ".img"}  # within the name of a scan or its picture


@dataclass(frozen=True)
class Clicked:
    """Text and place (x, y) of a label, from the corner of a picture of this name and size; `where` for messages.

    `given` are the other places that may hold the point's name: what each is called ("group_id"), and its text.
    """

    text: str
    x: float
    y: float
    picture: str
    width: int | None
    where: str
    given: tuple[tuple[str, str], ...] = ()
    height: int | None = None


def labels_of(
    clicked: Sequence[Clicked], scans: Mapping[int, Path], n_pixels: int, point_id: str | None = None
) -> pd.DataFrame:
    """Labels observation, point, u_px, line, ordered by the first two; raises InputError naming what is no label.

    `point_id` is the place of the points' names, see `point_of`.
    """
    observation_of = _Scans(scans)
    lines_of = cache(lambda observation: _lines(scans[observation]))
    rows: dict[tuple[int, int | str], tuple[float, float]] = {}
    for one in clicked:
        observation = observation_of.picture(one.picture)
        if observation is None:
            expected = f"the name of a scan: {', '.join(observation_of.names()[:3])}, ..."
            raise InputError(one.where, f"picture {one.picture}", expected, "rename the picture, or remove its labels")
        if one.width not in (None, n_pixels):
            found, expected = f"a picture {one.width} pixels wide", f"{n_pixels}, as camera.n_pixels says"
            raise InputError(one.where, found, expected, "label the scan's own pixels, neither turned nor scaled")
        lines = None if one.height is None else lines_of(observation)
        if lines not in (None, one.height):
            found, expected = f"a picture of {one.height} lines", f"{lines}, as its scan has"
            raise InputError(one.where, found, expected, "label the scan's own pixels, neither turned nor scaled")
        if not (np.isfinite(one.x) and np.isfinite(one.y)):
            raise InputError(one.where, f"place {one.x}, {one.y}", "two numbers", "remove the label")
        key = observation, point_of(one, point_id)
        if key in rows:
            found = f"point {key[1]} of {one.picture} again"
            remedy = "remove one of the labels, or say by source.point_id where the points' names stand"
            raise InputError(one.where, found, "each point once a scan", remedy)
        rows[key] = one.x - _CENTRE, one.y - _CENTRE
    table = pd.DataFrame(
        [(*key, *place) for key, place in rows.items()], columns=["observation", "point", "u_px", "line"]
    )
    table["point"] = point_names(table["point"])
    return table.sort_values(["observation", "point"], ignore_index=True)


def _lines(scan: Path) -> int | None:
    """Lines of a scan; None where it cannot be read, which is told with the scan."""
    try:
        return scan_size(scan)[0]
    except InputError:
        return None


class _Scans:
    """Observations by the names of their scans, which must tell them apart; raises InputError where they do not."""

    def __init__(self, scans: Mapping[int, Path]) -> None:
        self._whole: dict[str, int] = {}
        self._short: dict[str, list[int]] = {}
        for number, path in scans.items():
            before = self._whole.setdefault(path.stem, number)
            if before != number:
                place, expected = str(path), f"another name than {scans[before]}"
                raise InputError(place, f"the name {path.name} again", expected, "rename the scan, or label in our CSV")
            self._short.setdefault(_without(path.stem, _OF_DATA), []).append(number)

    def names(self) -> list[str]:
        """What pictures may be called, without their ending: a scan's short name where it is of no other."""
        short = {whole: _without(whole, _OF_DATA) for whole in self._whole}
        return sorted(name if len(self._short[name]) == 1 else whole for whole, name in short.items())

    def picture(self, file: str) -> int | None:
        """The observation of a picture; None where it has no scan's name, or that of several.

        `run.png`, `run.hdr.png` and `run.bil.png` are of run.hdr and run.bil.hdr; whole names come before short ones.
        """
        stem = Path(file.replace("\\", "/")).stem
        of_scan = _without(stem, {_OF_HEADER})
        whole = (self._whole.get(name) for name in (stem, of_scan, _without(of_scan, _OF_DATA)))
        short = (self._short.get(name, []) for name in (stem, of_scan))
        alone = (numbers[0] for numbers in short if len(numbers) == 1)
        return next((number for number in whole if number is not None), next(alone, None))


def _without(name: str, endings: Set[str]) -> str:
    """A name without the last of its endings, where that is one of these."""
    return Path(name).stem if Path(name).suffix.lower() in endings else name


def point_of(clicked: Clicked, place: str | None = None) -> int | str:
    """The point's name, from the one `place` that holds it: `label`, or the name of one that is `given`.

    Without a place it is the one that is called an id, else the label. "point 7" and "p07" are the number 7; no other
    digit counts. Raises InputError where there is no name, or it is not plain which of two is meant.
    """
    places = {"label": clicked.text} | {name.strip().lower(): text for name, text in clicked.given}
    if place is not None:
        chosen = {place: places.get(place.lower(), "")}
    else:
        chosen = {name: text for name, text in places.items() if name in IDS}
        if not chosen or _NUMBERED.fullmatch(clicked.text.strip()):
            chosen["label"] = clicked.text
    names = {name: _named(text) for name, text in chosen.items()}
    if len(set(names.values())) > 1:
        told = " and ".join(f"{name} {quoted(text)}" for name, text in chosen.items())
        remedy = f"keep it in one of them, or set source.point_id: {next(iter(chosen))}"
        raise InputError(clicked.where, told, "one name of the point", remedy)
    found = next(iter(names.values()))
    if found is None:
        told = ", ".join(f"{name} {quoted(text)}" for name, text in {**places, **chosen}.items())
        remedy = "write the point's name there, or say by source.point_id which place holds it"
        raise InputError(clicked.where, told, WHAT, remedy)
    return found


def _named(text: str) -> int | str | None:
    numbered = _NUMBERED.fullmatch(text.strip())
    return point_name(numbered[1] if numbered else text)
