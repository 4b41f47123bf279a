"""Labelled view files: every fault of every file in one pass, not only the first of the first."""

from pathlib import Path
from typing import Final

import numpy as np
import pandas as pd

from linepose.check.dots import shared_findings
from linepose.check.finding import Finding, error, of_fault, of_faults
from linepose.check.labels import pose_findings, repeated_findings, sensor_findings
from linepose.errors import InputError
from linepose.inputs.labels.labelled_views import read_labelled_views, select_views
from linepose.inputs.number_files import check_microseconds, read_named_numbers
from linepose.inputs.patterns import matching
from linepose.inputs.source import LabelledViewsSection
from linepose.survey.observations import EULER_COLUMNS, POSITION_COLUMNS

_COLUMNS: Final = ("u_px", *POSITION_COLUMNS, *EULER_COLUMNS)
_WHAT: Final = "time (us), point, u (px), north, east, down (m), roll, pitch, yaw (rad)"


def view_findings(
    source: LabelledViewsSection, folder: Path, n_pixels: int
) -> tuple[list[Finding], pd.DataFrame | None]:
    """Findings on a platform's view files, and its points (`POINTS`) where they can be used."""
    paths = select_views(folder, source.views, source.first, source.step)
    if not paths:
        total = len(matching(folder, source.views))
        found = f"no view file {folder / source.views}" + (f" of {total} from number {source.first}" if total else "")
        advice = (
            "correct source.views, first and step" if total else "put the view files there, or correct source.views"
        )
        return [error("view files", found, advice)], None
    raw, faults = _raw_points(paths)
    findings = of_faults("view files", faults)
    if raw is not None:
        findings += sensor_findings(raw, n_pixels) + repeated_findings(raw) + pose_findings(raw)
    if any(finding.level > 0 for finding in findings) or raw is None:
        return findings, None
    try:
        points = read_labelled_views(paths, n_pixels)
    except InputError as fault:
        return [*findings, of_fault("view files", fault)], None
    return [*findings, *shared_findings(points)], points


def _raw_points(paths: list[Path]) -> tuple[pd.DataFrame | None, list[InputError]]:
    """Labelled points of every file that can be read at all, with `place` of each; and the faults of the others."""
    tables, faults = [], []
    for number, path in enumerate(paths, start=1):
        try:
            time_us, names, values = read_named_numbers(path, 2 + len(_COLUMNS), _WHAT)
            check_microseconds(time_us, path)
        except InputError as fault:
            faults.append(fault)
            continue
        table = pd.DataFrame(values, columns=list(_COLUMNS)).assign(observation=number, time_us=time_us, point=names)
        table["place"] = [f"{path.name}, row {row + 1}" for row in range(len(table))]
        tables.append(table[np.isfinite(table["u_px"])])
    joined = pd.concat(tables, ignore_index=True) if tables else None
    return (None if joined is None or joined.empty else joined), faults
