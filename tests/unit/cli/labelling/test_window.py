"""The window under a backend without a display, driven by the events that a mouse and a keyboard send."""

import os
import shutil
import subprocess
import sys
from functools import cache
from io import BytesIO

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.backend_bases import KeyEvent, MouseButton, MouseEvent, NavigationToolbar2
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from PIL import Image

from linepose.cli.labelling import label, label_platform
from linepose.cli.labelling.run import session_of
from linepose.cli.labelling.scan_view import as_recorded
from linepose.cli.labelling.session import save
from linepose.cli.labelling.window import LabelWindow
from linepose.errors import InputError
from linepose.inputs.source import ScansSection
from linepose.inputs.targets.refine import METHODS
from linepose.survey.pattern import N_POINTS
from linepose.survey.targets.points import PointsSection
from linepose.survey.targets.rings import RingsSection
from unit.inputs.targets.conftest import draw


@cache
def scan_picture(number):
    """A scan as PNG, and where its points (15, 2) are."""
    picture, png = draw([[420.0, 30.0], [20.0, 500.0]], (150.0, 190.0 + 10 * number), seed=number), BytesIO()
    Image.fromarray(np.clip(picture.intensity / 16, 0, 255).astype(np.uint8)).save(png, "png")
    return png.getvalue(), picture.truth


class Mouse:
    """A window over two scans, and what a person does to it."""

    def __init__(self, folder, target=None):
        self.target = target or RingsSection()
        self.path, self.truth = folder / "labels.csv", {}
        self.scans = {1: folder / "run-01.png", 2: folder / "run-02.png"}
        for number, path in self.scans.items():
            png, self.truth[number] = scan_picture(number)
            path.write_bytes(png)
        self.open()

    def open(self):
        self.figure = Figure(figsize=(13, 8.5), dpi=50)  # as large on screen as a real one, with fewer pixels to paint
        FigureCanvasAgg(self.figure)
        session = session_of(self.scans, self.path, self.target)
        self.window = LabelWindow(
            self.figure,
            session,
            self.scans,
            as_recorded,
            METHODS["centroid"],
            lambda one: save(one, self.path),
            self.target,
        )
        self.figure.canvas.draw()

    def click(self, u_px, line, button=MouseButton.LEFT, axes=None, **keys):
        x, y = (axes or self.window.axes).transData.transform((u_px, line))
        MouseEvent("button_press_event", self.figure.canvas, x, y, button, **keys)._process()

    def scroll(self, u_px, line, way):
        x, y = self.window.axes.transData.transform((u_px, line))
        MouseEvent("scroll_event", self.figure.canvas, x, y, way, step=1 if way == "up" else -1)._process()

    def press(self, key):
        KeyEvent("key_press_event", self.figure.canvas, key)._process()

    def saved(self):
        rows = np.loadtxt(self.path, delimiter=",", skiprows=1, ndmin=2)
        return {(int(o), int(p)): (u, line) for o, p, u, line in rows}


@pytest.fixture
def mouse(tmp_path):
    return Mouse(tmp_path)


def test_rough_clicks_snap_to_the_dots_and_are_saved_at_once(mouse):
    rng = np.random.default_rng(1)
    for point in range(N_POINTS):
        mouse.click(*(mouse.truth[1][point] + rng.uniform(-3, 3, 2)))
        assert len(mouse.saved()) == point + 1
    placed = np.array([mouse.saved()[1, point] for point in range(N_POINTS)])
    np.testing.assert_allclose(placed, mouse.truth[1], atol=0.1)
    assert "all points done" in mouse.window.axes.get_title(loc="left")


def test_without_snapping_a_click_is_where_it_was(mouse):
    mouse.press("d")
    mouse.click(101.25, 57.5)
    assert mouse.saved()[1, 0] == pytest.approx((101.25, 57.5), abs=2e-3)
    assert "not snapping" in mouse.window.axes.get_title(loc="left")


def test_click_beside_every_dot_stays_and_is_told(mouse):
    u_px, line = mouse.truth[1][0] + [0, 27]
    mouse.click(u_px, line)
    assert mouse.saved()[1, 0] == pytest.approx((u_px, line), abs=2e-3)
    assert "no dot near there" in mouse.window.axes.get_title(loc="left")


def test_undo_by_key_and_by_the_right_button(mouse):
    mouse.click(*mouse.truth[1][0])
    mouse.click(*mouse.truth[1][1])
    mouse.press("u")
    assert set(mouse.saved()) == {(1, 0)}
    mouse.click(50, 50, MouseButton.RIGHT)
    assert mouse.path.read_text() == "observation,point,u_px,line\n"


def test_skipped_point_has_no_label(mouse):
    mouse.press("x")
    mouse.click(*mouse.truth[1][1])
    assert set(mouse.saved()) == {(1, 1)}


def test_next_scan_and_back(mouse):
    mouse.click(*mouse.truth[1][0])
    mouse.press("n")
    mouse.click(*mouse.truth[2][0])
    assert set(mouse.saved()) == {(1, 0), (2, 0)}
    np.testing.assert_allclose(mouse.saved()[2, 0], mouse.truth[2][0], atol=0.1)
    mouse.press("b")
    mouse.click(*mouse.truth[1][1])
    assert set(mouse.saved()) == {(1, 0), (1, 1), (2, 0)}
    for _ in range(2):
        mouse.press("u")  # the last is of the scan in view, the one before of the other
    assert mouse.window.session.observation == 2
    assert "run-02.png" in mouse.window.axes.get_title(loc="left")


@pytest.mark.parametrize("tool", ["zoom", "pan"])
def test_toolbars_zoom_places_no_point(mouse, tool):
    mouse.figure.canvas.toolbar = toolbar = NavigationToolbar2(mouse.figure.canvas)
    getattr(toolbar, tool)()
    mouse.click(*mouse.truth[1][0])
    mouse.click(50, 50, MouseButton.RIGHT)
    assert not mouse.path.exists()
    getattr(toolbar, tool)()
    mouse.click(*mouse.truth[1][0])
    assert set(mouse.saved()) == {(1, 0)}


def test_home_button_shows_the_scan_in_view(mouse):
    mouse.figure.canvas.toolbar = toolbar = NavigationToolbar2(mouse.figure.canvas)
    mouse.press("n")
    mouse.scroll(*mouse.truth[2][0], "up")
    toolbar.home()
    assert mouse.window.axes.get_xlim() == (-0.5, 299.5)


def test_wheel_zooms_about_the_mouse_and_clicks_stay_true(mouse):
    place = mouse.truth[1][7]
    before = np.ptp(mouse.window.axes.get_xlim())
    for _ in range(4):
        mouse.scroll(*place, "up")
    assert np.ptp(mouse.window.axes.get_xlim()) == pytest.approx(before / 1.4**4)
    x, y = mouse.window.axes.transData.transform(place)
    box = mouse.window.axes.bbox
    assert box.x0 < x < box.x1
    assert box.y0 < y < box.y1
    view = mouse.window.axes.get_xlim()
    mouse.click(*place)
    np.testing.assert_allclose(mouse.saved()[1, 0], place, atol=0.1)
    assert mouse.window.axes.get_xlim() == view  # a label moves nothing
    mouse.scroll(*place, "down")
    assert np.ptp(mouse.window.axes.get_xlim()) == pytest.approx(before / 1.4**3)


def test_double_click_and_clicks_outside_place_nothing(mouse):
    mouse.click(*mouse.truth[1][0], dblclick=True)
    mouse.scroll(150, 200, "down")  # now there is margin around the scan
    mouse.click(-20, 100)
    mouse.click(100, -30)
    MouseEvent("button_press_event", mouse.figure.canvas, 3, 3, MouseButton.LEFT)._process()
    assert not mouse.path.exists()


def test_sketch_chooses_a_point_to_place_anew(mouse):
    mouse.press("d")
    mouse.click(10, 10)
    mouse.click(20, 20)
    board = mouse.window._board
    (place,) = [text.get_position() for text in board.texts if text.get_text() == "0"]
    mouse.click(*place, axes=board)
    assert "click point 0" in mouse.window.axes.get_title(loc="left")
    mouse.click(30, 30)
    assert mouse.saved()[1, 0] == pytest.approx((30, 30), abs=2e-3)
    assert set(mouse.saved()) == {(1, 0), (1, 1)}


def test_points_without_a_pattern_are_named_by_writing_or_numbered(tmp_path):
    mouse = Mouse(tmp_path, PointsSection(names=("gate",)))
    mouse.click(*mouse.truth[1][0])
    mouse.click(*mouse.truth[1][1])
    mouse.window._name.set_val("post 3")
    assert "click point post 3" in mouse.window.axes.get_title(loc="left")
    mouse.click(*mouse.truth[1][2])
    mouse.press("n")
    board = mouse.window._board
    (place,) = [text.get_position() for text in board.texts if text.get_text() == "post 3"]
    mouse.click(*place, axes=board)
    mouse.click(*mouse.truth[2][2])
    mouse.press("a")
    assert "click new point 1" in mouse.window.axes.get_title(loc="left")
    points = [line.split(",")[:2] for line in mouse.path.read_text().splitlines()[1:]]
    assert points == [["1", "0"], ["1", "gate"], ["1", "post 3"], ["2", "post 3"]]
    mouse.open()
    assert mouse.window.session.names == ["gate", 0, "post 3"]


def test_session_is_gone_on_with(mouse):
    mouse.click(*mouse.truth[1][0])
    mouse.click(*mouse.truth[1][1])
    mouse.open()
    mouse.click(*mouse.truth[1][2])
    assert set(mouse.saved()) == {(1, 0), (1, 1), (1, 2)}


def test_first_pixels_centre_is_zero(mouse):
    """The picture covers -0.5 to n - 0.5: a click on the middle of the first pixel is at 0, 0."""
    assert mouse.window.axes.get_images()[0].get_extent() == [-0.5, 299.5, 399.5, -0.5]


def test_labels_must_be_our_csv(mouse, tmp_path):
    with pytest.raises(InputError, match=r"labels.json: found file type '.json', expected .csv"):
        session_of(mouse.scans, tmp_path / "labels.json")
    mouse.path.write_text("observation,point,u_px,line\n3,1,2,3\n")
    with pytest.raises(InputError, match=r"labels.csv, row 2, observation: found 3"):
        session_of(mouse.scans, mouse.path)


def test_without_a_display_it_says_what_to_do(mouse, tmp_path, monkeypatch):
    plt.switch_backend("agg")
    monkeypatch.setattr("matplotlib.pyplot.show", lambda **_: pytest.fail("nobody could close it"))
    with pytest.raises(
        InputError, match=r"found no display, or no toolkit for windows.*install the extra linepose\[wind"
    ):
        label(mouse.scans, mouse.path)
    source = ScansSection(kind="scans", dataset="x", scans="*.png")
    with pytest.raises(InputError, match="no display"):
        label_platform(tmp_path, source)
    with pytest.raises(InputError, match=r"found no file, expected one scan an observation"):
        label_platform(tmp_path / "none", source)


@pytest.mark.skipif(shutil.which("Xvfb") is None, reason="no virtual display")
def test_a_real_window_under_a_virtual_display(mouse, tmp_path):
    """Tk's own events: two clicks, one of them undone by the key; the toolbar's zoom takes a third; then q closes."""
    pytest.importorskip("tkinter")
    (tmp_path / "person.py").write_text(PERSON)
    read_end, write_end = os.pipe()
    screen = ["Xvfb", "-displayfd", str(write_end), "-screen", "0", "1600x1200x24", "-nolisten", "tcp"]
    with subprocess.Popen(screen, pass_fds=[write_end], stderr=subprocess.DEVNULL) as server:
        try:
            os.close(write_end)
            display = os.read(read_end, 16).decode().strip()
            places = [f"{one}" for point in (0, 1) for one in mouse.truth[1][point]]
            run = subprocess.run(
                [sys.executable, str(tmp_path / "person.py"), str(mouse.scans[1]), str(mouse.path), *places],
                env=os.environ | {"DISPLAY": f":{display}", "MPLBACKEND": "TkAgg"},
                capture_output=True,
                text=True,
                timeout=120,
                check=False,
            )
        finally:
            server.terminate()
            os.close(read_end)
    assert run.returncode == 0, run.stderr
    assert run.stdout.split() == ["1", "1", "2", "1", "0"]
    assert set(mouse.saved()) == {(1, 0)}
    np.testing.assert_allclose(mouse.saved()[1, 0], mouse.truth[1][0], atol=0.1)


PERSON = """
import itertools
import sys
import time
from pathlib import Path

from matplotlib import pyplot as plt

from linepose.cli.labelling import label

scan, labels, *places = sys.argv[1:]
u0, line0, u1, line1 = (float(one) for one in places)
show, seconds = plt.show, itertools.count(1)


def count():
    print(len(Path(labels).read_text().splitlines()) - 1 if Path(labels).exists() else 0)


def act(**keys):
    canvas = plt.gcf().canvas
    widget, axes = canvas.get_tk_widget(), plt.gcf().axes[0]

    def click(u, line):
        x, y = axes.transData.transform((u, line))
        height = canvas.figure.bbox.height
        later = next(seconds) * 1000  # ms: else Tk takes two clicks in one place for a double one
        for kind in ("Button-1", "ButtonRelease-1"):
            widget.event_generate(f"<{kind}>", x=round(x), y=round(height - y), time=later)
        widget.update()

    def key(name):
        widget.focus_force()
        widget.event_generate(f"<Key-{name}>")
        widget.update()

    def person():
        for _ in range(20):  # until the window has its size
            widget.update()
            time.sleep(0.05)
        click(u0, line0)
        count()
        canvas.toolbar.zoom()
        click(u1, line1)
        count()
        canvas.toolbar.zoom()
        click(u1, line1)
        count()
        key("u")
        count()
        key("q")
        print(len(plt.get_fignums()))

    widget.after(500, person)
    show(**keys)


plt.show = act
label({1: Path(scan)}, Path(labels))
"""
