"""Scans, their time stamps and labels, from headers and small files; pixels are read around labels alone."""

from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from linepose.check import contents
from linepose.check.clock import header_findings
from linepose.check.dots import dot_findings
from linepose.check.finding import Finding, Level, error, numbers, of_fault, of_faults, ok, warning
from linepose.check.labels import sensor_findings
from linepose.errors import InputError
from linepose.inputs.labels import read_point_labels
from linepose.inputs.observed_points import SCAN_POINTS, select_scans
from linepose.inputs.scans import header_time
from linepose.inputs.scans.line_times import line_times_of
from linepose.inputs.scans.scan_files import scan_size
from linepose.inputs.source import ScansSection
from linepose.inputs.targets.refine import AS_LABELLED, REFINEMENTS
from linepose.tables import read_table


def scan_findings(
    source: ScansSection, folder: Path, n_pixels: int, results: Path | None = None
) -> tuple[list[Finding], pd.DataFrame | None]:
    """Findings on scans and labels, and the labelled points with times: observation, point, time_us, u_px, line.

    The points are as labelled, not refined; of a target that is found without labels those that the last run found, in
    `results`. None where there are none, or they cannot be used.
    """
    try:
        scans = select_scans(folder, source.scans, source.left_out)
    except InputError as fault:
        return [of_fault("scans", fault)], None
    times, faults, widths, line_times = {}, [], {}, line_times_of(source)
    for number, path in scans.items():
        try:
            n_lines, widths[number] = scan_size(path)
            times[number] = line_times(path, n_lines)
        except InputError as fault:
            faults.append(fault)
    findings = of_faults("scans", faults)
    other = [number for number, width in widths.items() if width != n_pixels]
    if other:
        found = f"scan {numbers(other)}: {widths[other[0]]} pixels a line, camera.n_pixels is {n_pixels}"
        findings.append(error("scans", found, f"set camera.n_pixels: {widths[other[0]]}, or restore the scans"))
    findings += header_findings(
        {scans[number].name: int(stamps[0]) for number, stamps in times.items()},
        _header_starts(scans.values()),
        source.time_offset_s,
    )
    if not any(finding.level == Level.ERROR for finding in findings):
        findings.append(ok("scans", f"{len(scans)} scans of {n_pixels} pixels, a time stamp for each line"))
        try:
            findings.append(contents.of_scans(scans, times))
        except InputError as fault:
            findings.append(of_fault("scans", fault))
    detected = _detected(source, results, list(scans.values()))
    if detected is not None:
        label_findings, points = _timed(detected[detected["observation"].isin(times)], times, n_pixels)
        told = ok(
            "labels", f"points are found without labels; those of the last run count: {len(detected)} measurements"
        )
        return [*findings, told, *label_findings], points
    if source.points != "labels":
        found = (
            "points are found without labels: their numbers, conventions and predicted sigmas are looked at once a run "
            "has found them; check again then"
            if source.points == "detection"
            else "points are matched by the run: its verdict tells what it finds of conventions and sigmas"
        )
        return [*findings, ok("labels", found)], None
    try:
        labels = read_point_labels(folder, source.labels, scans, n_pixels, source.point_id)
    except InputError as fault:
        return [*findings, of_fault("labels", fault)], None
    if not labels.empty:
        findings.append(contents.of_labels(labels))
    label_findings, points = _timed(labels[labels["observation"].isin(times)], times, n_pixels)
    unlabelled = sorted(set(scans) - set(labels["observation"]))
    if unlabelled:
        found = f"scan {numbers(unlabelled)}: no label, left out"
        label_findings.append(warning("labels", found, "label it, or add it to source.left_out"))
    if points is not None and source.refinement != AS_LABELLED:
        label_findings += dot_findings(scans, labels, REFINEMENTS[source.refinement])
    return [*findings, *label_findings], points


def _detected(source: ScansSection, results: Path | None, scans: Sequence[Path]) -> pd.DataFrame | None:
    """What the last run found of a target without labels; None where nothing, or before the scans were written."""
    found = None if results is None else results / "points.parquet"
    if source.points != "detection" or found is None or not found.is_file():
        return None
    if any(path.stat().st_mtime > found.stat().st_mtime for path in scans):
        return None
    try:
        return read_table(found, SCAN_POINTS)
    except InputError:  # of another version: the run makes it anew
        return None


def _header_starts(scans: Iterable[Path]) -> dict[str, int]:
    """Unix times (us) of the first lines that headers say, by the scan's file name."""
    starts = {}
    for path in scans:
        try:
            start_us = header_time.start_us(header_time.words_of(path), path)
        except InputError:  # told with the scan
            continue
        if start_us is not None:
            starts[path.name] = start_us
    return starts


def _timed(
    labels: pd.DataFrame, times: dict[int, np.ndarray], n_pixels: int
) -> tuple[list[Finding], pd.DataFrame | None]:
    """Findings on labels of readable scans, and the labels with their times where all lie within their scans."""
    if labels.empty:
        return [error("labels", "no label of a readable scan", "label the scans: observation, point, u_px, line")], None
    place = [f"observation {o:g}, point {p}" for o, p in zip(labels["observation"], labels["point"], strict=True)]
    findings = sensor_findings(labels.assign(place=place), n_pixels)
    count = labels["observation"].map({number: len(stamps) for number, stamps in times.items()}).to_numpy()
    line = labels["line"].to_numpy()
    beyond = np.flatnonzero((line < -0.5) | (line > count - 0.5))
    if beyond.size:
        first = int(beyond[0])
        found = f"{beyond.size} labels outside their scans; the first is {place[first]}, line {line[first]:g}"
        findings.append(error("labels", f"{found} of {count[first]}", "correct the labels: lines count from 0"))
    if any(finding.level > 0 for finding in findings if finding.subject == "labels" and finding.advice):
        return findings, None
    stamps = [
        np.interp(at, np.arange(len(times[number])), times[number])
        for number, at in zip(labels["observation"], line, strict=True)
    ]
    return findings, labels.assign(time_us=np.rint(stamps).astype(np.int64))
