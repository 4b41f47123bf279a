"""Scans shown as maps: places lead there and back, labels are the scan's, and what cannot be rectified is shown."""

from pathlib import Path

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from linepose.cli.labelling import scan_view
from linepose.cli.labelling.session import resumed
from linepose.cli.labelling.window import LabelWindow
from linepose.inputs.source import ScansSection
from linepose.inputs.targets.refine import METHODS
from linepose.survey.targets.chessboard import ChessboardSection
from linepose.survey.targets.points import PointsSection
from unit.target_scans import hand_view, scan_of, survey_of

SURVEY = survey_of(ChessboardSection(), (18, 8))
RANGE_M = 3.4
SOURCE = ScansSection(kind="scans", dataset="x")


@pytest.fixture
def shown(monkeypatch):
    """The first scan of a chessboard on the ground, rectified, and where its corners are in the scan."""
    seen = scan_of(SURVEY, 1)
    monkeypatch.setattr(scan_view, "read_scan", lambda *_: seen.scan)
    return scan_view.rectified(hand_view(SURVEY), SOURCE, RANGE_M), seen.truth[seen.visible]


def test_places_lead_to_the_map_and_back(shown):
    read, corners = shown
    view = read(Path("scan.hdr"))
    on_map = np.array([view.to_picture(*corner) for corner in corners])
    back = np.array([view.to_scan(*place) for place in on_map])
    assert np.abs(back - corners).max() < 0.1
    # the board is 9 x 7 squares: on the map its corners are a lattice of one spacing, in the scan they are not
    apart = np.linalg.norm(on_map[:, None] - on_map, axis=-1) + 1e9 * np.eye(len(on_map))
    assert apart.min(axis=1) == pytest.approx(np.median(apart.min(axis=1)), rel=0.1)
    assert view.to_scan(-50.0, -50.0) is None


def test_a_click_on_the_map_is_a_label_of_the_scan(shown):
    read, corners = shown
    figure, saved = Figure(), []
    FigureCanvasAgg(figure)
    session = resumed([1], {}, [], takes_new=True)
    window = LabelWindow(
        figure, session, {1: Path("scan.hdr")}, read, METHODS["centroid"], saved.append, PointsSection()
    )
    window.snaps = False
    window._place(*window._view.to_picture(*corners[0]))
    assert session.labels[1, 0] == pytest.approx(tuple(corners[0]), abs=0.1)
    assert saved
    assert window.axes.get_aspect() == 1
    assert window.axes.get_xlabel().startswith("across the ground, cells of")


def test_a_scan_outside_the_log_is_shown_as_recorded_and_told(shown, monkeypatch):
    read, _ = shown
    seen = scan_of(SURVEY, 1).scan
    late = type(seen)(seen.intensity, seen.time_us + 10**12, "late")
    monkeypatch.setattr(scan_view, "read_scan", lambda *_: late)
    view = read(Path("late.hdr"))
    assert view.picture is seen.intensity
    assert view.to_scan(3.0, 4.0) == (3.0, 4.0)
    assert view.note.startswith("shown as recorded: late: found lines from")
