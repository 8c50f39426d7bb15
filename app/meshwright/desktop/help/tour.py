"""The tour: five callouts over the window, shown at the first start."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from qtpy.QtCore import QEvent, QObject, QPoint, QRect, Signal
from qtpy.QtWidgets import QWidget

from meshwright.desktop.canvas.canvas import Canvas
from meshwright.desktop.controller import Connections
from meshwright.desktop.help.callout import Callout
from meshwright.desktop.widgets.action_set import ActionSet
from meshwright.document.document import Document
from meshwright.graphics.theme import Theme


@dataclass(frozen=True)
class TourPlaces:
    """The parts of ``window`` that the tour points at."""

    window: QWidget
    canvas: Canvas
    pages: QWidget
    """The middle of the window: the canvas, or a page while there is no mesh."""
    columns: tuple[QWidget, ...]
    """The columns beside it, which hold the panels."""
    operations: QWidget
    score: QWidget
    agent: QWidget
    history: tuple[QWidget, ...]
    """Where the history is, best first: timeline, list, undo button."""
    reveal: Callable[[QWidget], None]
    """Unfolds a panel."""

    def rect(self, widget: QWidget) -> QRect | None:
        """Where ``widget`` is in the window's pixels; None if it is hidden."""
        if not widget.isVisible():
            return None
        return QRect(widget.mapTo(self.window, QPoint(0, 0)), widget.size())

    def panel(self, panel: QWidget) -> QRect | None:
        """The visible part of a panel in one of the columns, as wide as the column."""
        column = next(column for column in self.columns if column.isAncestorOf(panel))
        whole, seen = self.rect(panel), self.rect(column)
        if whole is None or seen is None:
            return None
        return QRect(seen.x(), whole.y(), seen.width(), whole.height()).intersected(seen)

    def halfedge(self) -> QRect | None:
        """A few pixels around the middle of an edge at the right of the visible mesh."""
        canvas, mesh = self.canvas, self.canvas.document.mesh
        if mesh is None or not canvas.isVisible():
            return None
        elements = mesh.elements()
        centres = canvas.viewport.to_screen(mesh.points[elements].mean(axis=1))
        seen = ((centres > 0) & (centres < canvas.viewport.size)).all(axis=1)
        row = int(np.where(seen, centres[:, 0], -1.0).argmax())
        x, y = canvas.viewport.to_screen(mesh.points[elements[row, :2]].mean(axis=0)).tolist()
        at = canvas.mapTo(self.window, QPoint(round(x), round(y)))
        return QRect(at - QPoint(10, 10), at + QPoint(10, 10))

    def first_visible(self, widgets: tuple[QWidget, ...]) -> QRect | None:
        """Where the first visible one of ``widgets`` is."""
        return next((found for part in widgets if (found := self.rect(part)) is not None), None)


@dataclass(frozen=True)
class TourStep:
    """Heading and text, the place that it points at (None while it cannot be seen), and the text
    that confirms that the user has done it.
    """

    heading: str
    text: str
    target: Callable[[TourPlaces], QRect | None]
    done: str = ""
    panel: Callable[[TourPlaces], QWidget] | None = None
    """The panel that it is about, which is unfolded."""
    sides: tuple[str, ...] = ("left", "right")
    """On which side of the place the callout stands, best first."""
    menu: str = ""
    """The menu of the actions that it is about."""


STEPS = (
    TourStep(
        "Point at a half-edge",
        "Move the mouse over the mesh. The arrow is the half-edge under it, just inside its "
        "element; numbers mark vertices with too many edges (+) or too few (\u2212).",
        TourPlaces.halfedge,
        "That is a half-edge.",
        sides=("right", "below", "left"),
    ),
    TourStep(
        "Apply an operation",
        "Point at a half-edge and press one of these keys, or click for a menu with all of them. "
        "Ctrl+Z undoes it.",
        lambda places: places.panel(places.operations),
        "Done. The mesh has changed, and is still valid.",
        panel=lambda places: places.operations,
        sides=("right",),
    ),
    TourStep(
        "Watch the score",
        "s is the sum of |degree \u2212 desired degree| over all vertices. It cannot fall below "
        "the optimum s*; where s = s*, the connectivity is provably optimal.",
        lambda places: places.panel(places.score),
        panel=lambda places: places.score,
    ),
    TourStep(
        "Let the agent help",
        "Step applies one operation, Play continues, Complete searches for the optimum. Edit or "
        "stop at any time: its operations are kept.",
        lambda places: places.panel(places.agent),
        panel=lambda places: places.agent,
        menu="Agent",
    ),
    TourStep(
        "Go back at any time",
        "Every step, yours or the agent\u2019s, is recorded. Click or drag on the timeline to go "
        "back, and continue editing from there. Ctrl+K finds every command, F1 lists all keys.",
        lambda places: places.first_visible(places.history),
        sides=("above", "right", "below"),
        menu="History",
    ),
)


WORK = ("Blocks", "Agent", "Levels")
"""Menus whose actions show that the user has begun to work."""
ENOUGH = 3
"""So many operations applied beside the second step show it, too."""


class Tour(QObject):
    """Shows ``steps`` one after the other until the last, or until it is skipped: ``ended()``.

    The first two steps are confirmed when the user hovers a half-edge and applies an operation. The
    tour also ends when the user works on without it, so that its card is not in the way:
    ``passed_by()`` precedes ``ended()`` then.
    """

    ended = Signal()
    passed_by = Signal()

    def __init__(
        self,
        document: Document,
        places: TourPlaces,
        actions: ActionSet,
        theme: Theme,
        steps: tuple[TourStep, ...] = STEPS,
    ) -> None:
        super().__init__(places.window)
        self._document, self._places, self._steps = document, places, steps
        self._actions = actions
        self._at = 0
        self._applied = 0
        self._did = [False] * len(steps)
        self.callout = Callout(theme, places.window)
        self.callout.step_requested.connect(self._on_step_requested)
        self.callout.ended.connect(self.end)
        places.window.installEventFilter(self)
        self._connections = Connections()
        self._connections.add(document.hover_changed, self._on_hover_changed)
        self._connections.add(document.history_changed, self._on_history_changed)
        self._connections.add(document.replaced, self._on_replaced)
        actions.triggered.connect(self._on_action)
        order = (places.canvas.plotter, *self.callout.buttons)
        for before, after in pairwise(order):
            QWidget.setTabOrder(before, after)
        self._show()

    @property
    def at(self) -> int:
        """The step that is shown, from 0."""
        return self._at

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self.callout.set_theme(theme)

    def end(self) -> None:
        """Remove the callout, and emit ``ended``."""
        self._places.window.removeEventFilter(self)
        self._actions.triggered.disconnect(self._on_action)
        self._connections.close()
        self.callout.hide()
        self.callout.deleteLater()
        self.ended.emit()
        self.deleteLater()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        """Follow the place that is pointed at when the window is resized."""
        if event.type() in (QEvent.Type.Resize, QEvent.Type.LayoutRequest):
            self._place()
        return False

    def _on_step_requested(self, step: int) -> None:
        if self._at + step >= len(self._steps):
            self.end()
        else:
            self._at = max(self._at + step, 0)
            self._show()

    def _on_hover_changed(self, halfedge: int) -> None:
        if halfedge >= 0:
            self._do(0)

    def _on_history_changed(self) -> None:
        if self._document.history.cursor == 0:
            return
        self._do(1)
        if self._at != 1 and not self._steps[self._at].menu:
            self._applied += 1
            if self._applied == ENOUGH:
                self._pass_by()

    def _on_action(self, action_id: str) -> None:
        menu = self._actions.entry(action_id).menu
        if menu in WORK and menu != self._steps[self._at].menu:
            self._pass_by()

    def _pass_by(self) -> None:
        self.passed_by.emit()
        self.end()

    def _on_replaced(self) -> None:
        self._show()

    def _do(self, number: int) -> None:
        """Confirm step ``number`` if it is the current one."""
        if number == self._at and not self._did[number]:
            self._did[number] = True
            self._show()

    def _show(self) -> None:
        step = self._steps[self._at]
        if step.panel is not None:
            self._places.reveal(step.panel(self._places))
        done = step.done if self._did[self._at] else ""
        self.callout.show_step(self._at + 1, len(self._steps), step.heading, step.text, done)
        self._place()

    def _place(self) -> None:
        """Place the callout beside the target, or in the middle of the canvas if that is hidden."""
        step = self._steps[self._at]
        target = step.target(self._places)
        if target is None:
            target = self._places.rect(self._places.pages) or self._places.window.rect()
            target = QRect(target.center(), target.center())
        canvas = self._places.rect(self._places.pages) or self._places.window.rect()
        self.callout.point_at(target, step.sides, canvas)
