"""Opening the labelling window over a platform's scans."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Final

import pandas as pd

from linepose.cli.labelling.scan_view import ScanView, as_recorded
from linepose.cli.labelling.session import Place, Session, resumed, save, table_of
from linepose.cli.labelling.window import LabelWindow
from linepose.errors import InputError
from linepose.inputs.labels.labels import read_labels
from linepose.inputs.observed_points import select_scans
from linepose.inputs.source import ScansSection
from linepose.inputs.targets.refine import METHODS, REFINEMENTS, Refine
from linepose.survey.point_names import Name, point_name
from linepose.survey.targets.registry import Target
from linepose.survey.targets.rings import RingsSection

_BOARD: Final = RingsSection()


def label_platform(
    folder: Path,
    source: ScansSection,
    labels_path: Path | None = None,
    target: Target = _BOARD,
    read: Callable[[Path], ScanView] = as_recorded,
) -> pd.DataFrame:
    """Label the scans of a platform whose files stand in `folder`, in a window that blocks until it is closed.

    The points of a target are asked for in their order, where it has a pattern; else any points, by name. Labels go to
    `labels_path`, by default `source.labels`, and those that it already holds are gone on with. `read` gives a scan as
    it is shown. Returns observation, point, u_px, line. Raises InputError where there is no scan, no display, or the
    file is not our CSV.
    """
    path = folder / source.labels if labels_path is None else labels_path
    scans = select_scans(folder, source.scans, source.left_out)
    return label(scans, path, REFINEMENTS[source.refinement], target, read)


def label(
    scans: Mapping[int, Path],
    labels_path: Path,
    refine: Refine = METHODS["centroid"],
    target: Target = _BOARD,
    read: Callable[[Path], ScanView] = as_recorded,
) -> pd.DataFrame:
    """Label scan files, given by observation, in a window; see `label_platform`."""
    from matplotlib import pyplot as plt

    session = session_of(scans, labels_path, target)
    figure = plt.figure(figsize=(13, 8.5), num=f"linepose: labels to {labels_path}")
    if figure.canvas.required_interactive_framework is None:
        plt.close(figure)
        raise InputError(
            "the labelling window",
            f"no display, or no toolkit for windows (matplotlib's {plt.get_backend()})",
            "a desktop with Tk or Qt",
            "install the extra linepose[window] and run it on a desktop, or label with LabelMe or CVAT",
        )
    # kept, because matplotlib holds its handlers only as long as their window
    window = LabelWindow(figure, session, scans, read, refine, lambda one: save(one, labels_path), target)
    plt.show(block=True)
    return table_of(window.session.labels)


def session_of(scans: Mapping[int, Path], labels_path: Path, target: Target = _BOARD) -> Session:
    """The session that a labels file was left at, or a new one."""
    if labels_path.suffix.lower() != ".csv":
        remedy = "name a CSV file with the option for the labels, or in source.labels"
        raise InputError(str(labels_path), f"file type {labels_path.suffix!r}", ".csv", remedy)
    labels: dict[tuple[int, Name], Place] = {}
    if labels_path.is_file():
        for number, point, u_px, line in read_labels(labels_path, list(scans)).itertuples(index=False, name=None):
            name = point_name(point)
            if name is not None:
                labels[number, name] = u_px, line
    return resumed(list(scans), labels, target.ids(), takes_new=target.artwork() is None)
