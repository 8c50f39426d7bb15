"""The mouse on the canvas: what a press, a move, a release and the wheel mean."""

from __future__ import annotations

from typing import TYPE_CHECKING

from qtpy.QtCore import QEvent, QPointF, Qt
from qtpy.QtGui import QMouseEvent, QWheelEvent

if TYPE_CHECKING:
    from app.desktop.canvas import Canvas

DRAG = 4
"""Pixels that the mouse may move between press and release of a click."""
ZOOM_PER_STEP = 1.0015


class Mouse:
    """Turns the plotter's mouse events into the canvas's calls and signals."""

    def __init__(self, canvas: Canvas) -> None:
        self._canvas = canvas
        self._pressed: QPointF | None = None
        self._panning = False

    def handle(self, event: QEvent) -> bool:
        """Act on an event of the plotter; True if VTK shall not see it."""
        kind = event.type()
        if kind == QEvent.Type.MouseMove:
            self._move(event)
        elif kind in (QEvent.Type.MouseButtonPress, QEvent.Type.MouseButtonDblClick):
            self._press(event)
        elif kind == QEvent.Type.MouseButtonRelease:
            self._release(event)
        elif kind == QEvent.Type.Wheel:
            self._wheel(event)
        elif kind == QEvent.Type.Leave:
            self._canvas.leave()
        elif kind not in (QEvent.Type.KeyPress, QEvent.Type.KeyRelease, QEvent.Type.Enter):
            return False
        return kind not in (QEvent.Type.Enter, QEvent.Type.Leave)

    def _move(self, event: QMouseEvent) -> None:
        at = event.position()
        if self._pressed is not None:
            step = at - self._pressed
            if self._panning or step.manhattanLength() > DRAG:
                self._panning = True
                self._pressed = at
                self._canvas.plotter.setCursor(Qt.CursorShape.ClosedHandCursor)
                self._canvas.see(self._canvas.viewport.panned(step.x(), step.y()))
                return
        self._canvas.point_at(at)

    def _press(self, event: QMouseEvent) -> None:
        self._canvas.plotter.setFocus(Qt.FocusReason.MouseFocusReason)
        if event.button() != Qt.MouseButton.RightButton:
            self._pressed = event.position()
            self._panning = False

    def _release(self, event: QMouseEvent) -> None:
        canvas = self._canvas
        panned, self._panning, self._pressed = self._panning, False, None
        canvas.plotter.unsetCursor()
        at = event.position()
        canvas.point_at(at)
        if panned or event.button() == Qt.MouseButton.MiddleButton:
            return
        where = canvas.plotter.mapToGlobal(at.toPoint())
        vertex = canvas.vertex_at(at) if event.button() == Qt.MouseButton.RightButton else -1
        if vertex >= 0:
            canvas.vertex_chosen.emit(vertex, where)
        elif canvas.document.hover >= 0:
            canvas.halfedge_chosen.emit(canvas.document.hover, where)

    def _wheel(self, event: QWheelEvent) -> None:
        at = event.position()
        factor = ZOOM_PER_STEP ** event.angleDelta().y()
        self._canvas.see(self._canvas.viewport.zoomed(factor, at.x(), at.y()))
        self._canvas.point_at(at)
