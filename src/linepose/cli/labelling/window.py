"""The labelling window: a scan, the points placed in it, a sketch of the board that shows which point is next."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np
from matplotlib.backend_bases import Event, KeyEvent, MouseButton, MouseEvent
from matplotlib.figure import Figure
from matplotlib.widgets import TextBox

from linepose.arrays import Floats
from linepose.cli.labelling.scan_view import ScanView
from linepose.cli.labelling.session import Session
from linepose.inputs.targets.refine import Refine
from linepose.survey.targets.registry import Target
from linepose.survey.targets.rings import RingsSection

_HELP: Final = (
    "left click: place    right click or u: undo    x: skip a hidden point    n, b: next scan, one back    "
    "click the board: that point\n"
    "a: a new point, or write its name (where there is no pattern)\n"
    "d: snap to the dot on, off    mouse wheel or toolbar: zoom    r: whole scan    q: close; all is saved at once"
)
_CONTRAST_PERCENT: Final = (1.0, 99.5)
_ZOOM: Final = 1.4
_LISTED: Final = 24  # names below each other
_PLACED, _NEXT = "#ffb000", "#dc267f"


class LabelWindow:
    """A figure in which the points of each scan are clicked in their order; every change is saved at once.

    `scans` are the scan files by observation, `read` gives a scan as it is shown, `refine` the centre of the dot near a
    click, and `save` keeps the session.
    """

    def __init__(
        self,
        figure: Figure,
        session: Session,
        scans: Mapping[int, Path],
        read: Callable[[Path], ScanView],
        refine: Refine,
        save: Callable[[Session], None],
        target: Target,
    ) -> None:
        self.figure, self.session, self.scans = figure, session, scans
        self._read, self._refine, self._save = read, refine, save
        self.snaps, self.message = True, ""
        grid = figure.add_gridspec(1, 2, width_ratios=(4, 1), left=0.06, right=0.98, top=0.92, bottom=0.14)
        self.axes, self._board = figure.add_subplot(grid[0]), figure.add_subplot(grid[1])
        self._target, self._name = target, self._name_box() if session.takes_new else None
        figure.text(0.06, 0.02, _HELP, fontsize=9, color="0.35")
        figure.canvas.mpl_connect("button_press_event", self._pressed)
        figure.canvas.mpl_connect("key_press_event", self._typed)
        figure.canvas.mpl_connect("scroll_event", self._scrolled)
        self._marks: list[Any] = []
        self._show_scan()

    def _pressed(self, event: Event) -> None:
        if not isinstance(event, MouseEvent) or event.dblclick or self._toolbar_acts():
            return
        if event.inaxes is self._board:
            self._choose(event)
        elif event.inaxes is not self.axes:
            return
        elif event.button == MouseButton.RIGHT:
            self._undo()
        elif event.button == MouseButton.LEFT and event.xdata is not None and event.ydata is not None:
            self._place(float(event.xdata), float(event.ydata))

    def _typed(self, event: Event) -> None:
        actions = {
            "u": self._undo,
            "x": self._skip,
            "n": lambda: self._turn(1),
            "b": lambda: self._turn(-1),
            "a": self._choose_new,
            "d": self._switch_snapping,
        }
        writes = self._name is not None and self._name.capturekeystrokes
        if isinstance(event, KeyEvent) and event.key in actions and not writes:
            actions[event.key]()

    def _scrolled(self, event: Event) -> None:
        if not isinstance(event, MouseEvent) or event.inaxes is not self.axes:
            return
        factor = 1 / _ZOOM if event.button == "up" else _ZOOM
        for centre, limits, change in (
            (event.xdata, self.axes.get_xlim(), self.axes.set_xlim),
            (event.ydata, self.axes.get_ylim(), self.axes.set_ylim),
        ):
            if centre is not None:
                change(*(centre + factor * (limit - centre) for limit in limits))
        self.figure.canvas.draw_idle()

    def _toolbar_acts(self) -> bool:
        """Whether the toolbar's zoom or pan takes the clicks."""
        toolbar = getattr(self.figure.canvas, "toolbar", None)
        return bool(toolbar is not None and str(getattr(toolbar, "mode", "")))

    def _choose(self, event: MouseEvent) -> None:
        """Make the point of the sketch that was clicked the next one, to place it anew."""
        if self.session.names:
            apart = np.hypot(*(self._sketch() - [event.xdata, event.ydata]).T)
            self.session.point, self.message = int(apart.argmin()), ""
            self._draw()

    def _choose_new(self) -> None:
        self.session.choose_new()
        self._draw()

    def _name_box(self) -> TextBox:
        """A line in which the next point's name is written, new or known."""
        box = TextBox(self.figure.add_axes((0.85, 0.08, 0.13, 0.04)), "name ")
        box.on_submit(self._named)
        return box

    def _named(self, text: str) -> None:
        if text.strip() and self._name is not None:
            self.message = "" if self.session.choose(text) else f"no name of a point: {text!r}"
            self._name.set_val("")
            self._draw()

    def _place(self, column: float, row: float) -> None:
        clicked = self._view.to_scan(column, row)
        if clicked is None:
            return
        found = self._refine(self._view.intensity, *clicked) if self.snaps else None
        self.message = "no dot near there: the point is where you clicked" if self.snaps and found is None else ""
        self.session.place(*(found or clicked))
        self._changed()

    def _skip(self) -> None:
        self.message = ""
        self.session.skip()
        self._changed()

    def _undo(self) -> None:
        before, self.message = self.session.observation, ""
        self.session.undo()
        self._changed(other_scan=self.session.observation != before)

    def _turn(self, step: int) -> None:
        self.message = ""
        self.session.turn(step)
        self._show_scan()

    def _switch_snapping(self) -> None:
        self.snaps, self.message = not self.snaps, ""
        self._draw()

    def _changed(self, other_scan: bool = False) -> None:
        self._save(self.session)
        if other_scan:
            self._show_scan()
        else:
            self._draw()

    def _show_scan(self) -> None:
        self._view = self._read(self.scans[self.session.observation])
        low, high = np.percentile(self._view.intensity, _CONTRAST_PERCENT)
        self.axes.clear()
        self._marks = []
        self.axes.imshow(
            self._view.picture,
            cmap="gray",
            vmin=low,
            vmax=max(high, low + 1e-6),
            aspect="equal" if self._view.is_map else "auto",
            interpolation="nearest",
        )
        self.axes.set_xlabel(self._view.axes[0])
        self.axes.set_ylabel(self._view.axes[1])
        self._keep_home()
        self._draw()

    def _keep_home(self) -> None:
        """Let the toolbar's home button show the whole of the scan that is now in view."""
        toolbar = getattr(self.figure.canvas, "toolbar", None)
        if toolbar is not None:
            toolbar.update()
            toolbar.push_current()

    def _draw(self) -> None:
        for mark in self._marks:
            mark.remove()
        self._marks = []
        for point, label in self.session.here().items():
            place = self._view.to_picture(*label)
            if place is None:
                continue
            self._marks += self.axes.plot(*place, "+", color=_PLACED, markersize=11, markeredgewidth=1.2)
            self._marks.append(
                self.axes.annotate(
                    str(point), place, xytext=(6, 6), textcoords="offset points", color=_PLACED, fontsize=10
                )
            )
        self.axes.set_title(self._title(), loc="left", fontsize=11)
        self._draw_board()
        self.figure.canvas.draw_idle()

    def _title(self) -> str:
        session = self.session
        place = f"scan {session.numbers.index(session.observation) + 1} of {len(session.numbers)}"
        name = self.scans[session.observation].name
        is_new = "new " if session.point == len(session.names) else ""
        done = session.name is None
        task = "all points done: n for the next scan" if done else f"click {is_new}point {session.name}"
        snapping = "" if self.snaps else "    (not snapping)"
        return f"{name}, {place}    {task}{snapping}" + "".join(
            f"\n{one}" for one in (self.message, self._view.note) if one
        )

    def _draw_board(self) -> None:
        """The target as seen from its front, so that a corner mark tells which way round the scan is; or a list."""
        axes, here, target, artwork = self._board, self.session.here(), self._target, self._target.artwork()
        axes.clear()
        if isinstance(target, RingsSection):
            mark_x, mark_y = target.corner_mark_centre_m
            axes.plot(-mark_y, mark_x, "s", color="0.2", markersize=9)
        for point, (name, (x, y)) in enumerate(zip(self.session.names, self._sketch(), strict=True)):
            colour = _NEXT if point == self.session.point else _PLACED if name in here else "0.75"
            axes.plot(x, y, "o", color=colour, markersize=15)
            axes.annotate(str(name), (x, y), ha="center", va="center", fontsize=8)
        half_x, half_y = (artwork.height_m / 2, artwork.width_m / 2) if artwork else (1.5, _LISTED / 2)
        axes.set_xlim(-half_x, half_x)
        axes.set_ylim(half_y, -half_y)
        axes.set_aspect("equal" if artwork else "auto")
        axes.set_xticks([])
        axes.set_yticks([])
        axes.set_title("board from its front\n(scans may mirror it)" if artwork else "known points", fontsize=9)

    def _sketch(self) -> Floats:
        """Places of all names in the sketch: the target turned upright, to fit beside the scan; others listed."""
        places = self._target.points()[:, [1, 0]] * [-1.0, 1.0]
        listed = np.arange(len(self.session.names) - len(places))
        columns = 1 + len(listed) // _LISTED
        across = 3 * (listed // _LISTED + 0.5) / columns - 1.5
        return np.concatenate([places, np.column_stack([across, listed % _LISTED + 0.5 - _LISTED / 2])])
