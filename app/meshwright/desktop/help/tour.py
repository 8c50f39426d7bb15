"""The tour: five callouts over the real window, for whoever opens it for the first time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from qtpy.QtCore import QEvent, QObject, QPoint, QRect, Signal
from qtpy.QtWidgets import QWidget

from meshwright.desktop.help.callout import Callout
from meshwright.graphics.theme import Theme

if TYPE_CHECKING:
    from meshwright.desktop.main_window.window import MainWindow


@dataclass(frozen=True)
class Stop:
    """One step: heading and text, what it points at in the window's pixels (none if that is not
    to be seen), and what is said once the person has done it.
    """

    heading: str
    text: str
    target: Callable[[MainWindow], QRect | None]
    done: str = ""
    panel: Callable[[MainWindow], QWidget] | None = None
    """The panel beside the canvas that it is about, which is unfolded."""
    sides: tuple[str, ...] = ("left", "right")
    """Where the callout stands, best first."""


def _widget(window: MainWindow, widget: QWidget | None) -> QRect | None:
    if widget is None or not widget.isVisible():
        return None
    return QRect(widget.mapTo(window, QPoint(0, 0)), widget.size())


def _panel(window: MainWindow, panel: QWidget) -> QRect | None:
    """The part of a panel beside the canvas that is to be seen."""
    whole = _widget(window, panel)
    left = window.left.isAncestorOf(panel)
    seen = _widget(window, window.left if left else window.sidebar)
    return whole.intersected(seen) if whole is not None and seen is not None else None


def _halfedge(window: MainWindow) -> QRect | None:
    """A few pixels around the middle of an edge at the right of what is seen of the mesh."""
    canvas, mesh = window.canvas, window.document.mesh
    if mesh is None or not canvas.isVisible():
        return None
    elements = mesh.elements()
    centres = canvas.viewport.to_screen(mesh.points[elements].mean(axis=1))
    seen = ((centres > 0) & (centres < canvas.viewport.size)).all(axis=1)
    row = int(np.where(seen, centres[:, 0], -1.0).argmax())
    x, y = canvas.viewport.to_screen(mesh.points[elements[row, :2]].mean(axis=0)).tolist()
    at = canvas.mapTo(window, QPoint(round(x), round(y)))
    return QRect(at - QPoint(10, 10), at + QPoint(10, 10))


def _history(window: MainWindow) -> QRect | None:
    """The timeline, else the list, else the button that undoes."""
    button = window.toolbar.widgetForAction(window.actions_by_id["undo"])
    parts = (window.film.timeline, window.film.panel, button)
    return next((found for part in parts if (found := _widget(window, part)) is not None), None)


STOPS = (
    Stop(
        "Point at a half-edge",
        "Move the mouse over the mesh. The arrow is the half-edge under it, just inside its "
        "element; numbers mark vertices with too many edges (+) or too few (\u2212).",
        _halfedge,
        "That is a half-edge.",
        sides=("right", "below", "left"),
    ),
    Stop(
        "Do an operation",
        "While you point, press one of these keys, or click for a menu with all of them. "
        "Ctrl+Z takes everything back.",
        lambda window: _panel(window, window.operations_panel),
        "Done. The mesh has changed, and it is still a mesh.",
        panel=lambda window: window.operations_panel,
        sides=("right",),
    ),
    Stop(
        "Watch the score",
        "s adds up how far all degrees are from the desired ones. It can never fall below the "
        "optimum s*: where they meet, the connectivity is provably optimal.",
        lambda window: _panel(window, window.score_panel),
        panel=lambda window: window.score_panel,
    ),
    Stop(
        "Let the agent help",
        "Step takes one operation, Play goes on, Complete searches for the optimum. Edit or stop "
        "at any time: what it has done stays.",
        lambda window: _panel(window, window.agent_panel),
        panel=lambda window: window.agent_panel,
    ),
    Stop(
        "Nothing is lost",
        "Every step, yours or the agent\u2019s, is kept. Click or drag on the timeline to go back, "
        "and edit on from there. Ctrl+K finds every command, F1 lists all keys.",
        _history,
        sides=("above", "right", "below"),
    ),
)


class Tour(QObject):
    """Shows ``stops`` one after the other until the last, or until it is skipped: ``ended()``.

    It follows what the person does: a half-edge that is pointed at, an operation that is done.
    """

    ended = Signal()

    def __init__(self, window: MainWindow, stops: tuple[Stop, ...] = STOPS) -> None:
        super().__init__(window)
        self._window = window
        self._stops = stops
        self._at = 0
        self._did = [False] * len(stops)
        self.callout = Callout(window.theme, window)
        self.callout.went.connect(self._on_went)
        self.callout.ended.connect(self.end)
        window.installEventFilter(self)
        window.document.hover_changed.connect(self._on_hover_changed)
        window.document.history_changed.connect(self._on_history_changed)
        window.document.replaced.connect(self._on_replaced)
        self._show()

    @property
    def at(self) -> int:
        """The step that is shown, from 0."""
        return self._at

    def set_theme(self, theme: Theme) -> None:
        """Draw in other colours."""
        self.callout.set_theme(theme)

    def end(self) -> None:
        """Take the callout away."""
        window = self._window
        window.removeEventFilter(self)
        window.document.hover_changed.disconnect(self._on_hover_changed)
        window.document.history_changed.disconnect(self._on_history_changed)
        window.document.replaced.disconnect(self._on_replaced)
        self.callout.hide()
        self.callout.deleteLater()
        self.ended.emit()
        self.deleteLater()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        """Stay beside what it points at while the window changes its size."""
        if event.type() in (QEvent.Type.Resize, QEvent.Type.LayoutRequest):
            self._place()
        return False

    def _on_went(self, step: int) -> None:
        if self._at + step >= len(self._stops):
            self.end()
        else:
            self._at = max(self._at + step, 0)
            self._show()

    def _on_hover_changed(self, halfedge: int) -> None:
        if halfedge >= 0:
            self._do(0)

    def _on_history_changed(self) -> None:
        if self._window.document.history.cursor > 0:
            self._do(1)

    def _on_replaced(self) -> None:
        self._show()

    def _do(self, number: int) -> None:
        """The person has done what step ``number`` asks for, while it asks."""
        if number == self._at and not self._did[number]:
            self._did[number] = True
            self._show()

    def _show(self) -> None:
        stop = self._stops[self._at]
        if stop.panel is not None:
            self._window.reveal(stop.panel(self._window))
        done = stop.done if self._did[self._at] else ""
        self.callout.tell(self._at + 1, len(self._stops), stop.heading, stop.text, done)
        self._place()

    def _place(self) -> None:
        """Beside the target; in the middle of the canvas where that is not to be seen."""
        stop = self._stops[self._at]
        target = stop.target(self._window)
        if target is None:
            target = _widget(self._window, self._window.pages) or self._window.rect()
            target = QRect(target.center(), target.center())
        self.callout.point_at(target, stop.sides)
