"""Mouse and key events of the canvas: hover, clicks, drags, wheel and Escape."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from qtpy.QtCore import QEvent, QPoint, QPointF, Qt
from qtpy.QtGui import QKeyEvent, QMouseEvent, QWheelEvent

from meshwright.desktop.canvas.gestures import Gesture, Pan

if TYPE_CHECKING:
    from meshwright.desktop.canvas.canvas import Canvas

DRAG = 4
"""Distance in pixels that the mouse may move during a click."""
ZOOM_PER_STEP = 1.0015


@dataclass(frozen=True)
class Click:
    """A click at ``at`` in pixels of the canvas, ``where`` on the screen, with half-edge and vertex
    there.
    """

    at: QPointF
    where: QPoint
    button: Qt.MouseButton
    modifiers: Qt.KeyboardModifier
    halfedge: int
    vertex: int

    @property
    def shift(self) -> bool:
        """Whether the shift key was down."""
        return bool(self.modifiers & Qt.KeyboardModifier.ShiftModifier)


class MouseInput:
    """Translates events of the plotter into calls and signals of the canvas."""

    def __init__(self, canvas: Canvas) -> None:
        self._canvas = canvas
        self._pressed: QPointF | None = None
        self._button = Qt.MouseButton.NoButton
        self._modifiers = Qt.KeyboardModifier.NoModifier
        self._gesture: Gesture | None = None

    @property
    def dragging(self) -> bool:
        """True while a drag is under way."""
        return self._gesture is not None

    def cancel(self) -> bool:
        """Cancel the current drag; True if there was one."""
        gesture, self._gesture, self._pressed = self._gesture, None, None
        if gesture is None:
            return False
        gesture.cancel()
        self._canvas.plotter.unsetCursor()
        return True

    def interrupt(self) -> None:
        """Cancel a drag that depends on the mesh, which has changed."""
        if self._gesture is not None and self._gesture.of_mesh:
            self.cancel()

    def handle(self, event: QEvent) -> bool:
        """Handle an event of the plotter; True if VTK must not receive it."""
        kind = event.type()
        if isinstance(event, QMouseEvent):
            if kind == QEvent.Type.MouseMove:
                self._move(event)
            elif kind == QEvent.Type.MouseButtonRelease:
                self._release(event)
            else:  # also the second press of a double click
                self._press(event)
        elif isinstance(event, QWheelEvent):
            self._wheel(event)
        elif isinstance(event, QKeyEvent) and kind == QEvent.Type.KeyPress:
            if event.key() in (Qt.Key.Key_Tab, Qt.Key.Key_Backtab):
                return False  # the focus moves on
            self._key(event)
        elif kind == QEvent.Type.Leave:
            self._canvas.leave()
        elif kind not in (QEvent.Type.KeyRelease, QEvent.Type.Enter):
            return False
        return kind not in (QEvent.Type.Enter, QEvent.Type.Leave)

    def _move(self, event: QMouseEvent) -> None:
        at = event.position()
        if self._pressed is None:
            self._canvas.point_at(at)
            return
        if self._gesture is None:
            if (at - self._pressed).manhattanLength() <= DRAG:
                self._canvas.point_at(at)
                return
            self._gesture = self._begin(self._pressed)
            self._canvas.plotter.setCursor(self._gesture.cursor)
        self._gesture.move(at)

    def _begin(self, start: QPointF) -> Gesture:
        if self._button == Qt.MouseButton.LeftButton:
            gesture = self._canvas.gesture_at(start, self._modifiers)
            if gesture is not None:
                self._canvas.leave()
                return gesture
        return Pan(self._canvas, start)

    def _press(self, event: QMouseEvent) -> None:
        self._canvas.plotter.setFocus(Qt.FocusReason.MouseFocusReason)
        if event.button() != Qt.MouseButton.RightButton and self._gesture is None:
            self._pressed = event.position()
            self._button, self._modifiers = event.button(), event.modifiers()

    def _release(self, event: QMouseEvent) -> None:
        canvas, at = self._canvas, event.position()
        if self._gesture is not None:
            if event.button() != self._button:
                return
            gesture, self._gesture, self._pressed = self._gesture, None, None
            canvas.plotter.unsetCursor()
            gesture.end(at)
            canvas.point_at(at)
            return
        pressed, self._pressed = self._pressed, None
        canvas.point_at(at)
        if event.button() == Qt.MouseButton.LeftButton and pressed is None:
            return  # the press was cancelled, or did not reach the canvas
        if event.button() != Qt.MouseButton.MiddleButton:
            where = canvas.plotter.mapToGlobal(at.toPoint())
            modifiers = event.modifiers()
            vertex = canvas.vertex_at(at)
            halfedge = canvas.document.hover
            canvas.clicked.emit(Click(at, where, event.button(), modifiers, halfedge, vertex))

    def _wheel(self, event: QWheelEvent) -> None:
        at = event.position()
        factor = ZOOM_PER_STEP ** event.angleDelta().y()
        self._canvas.see(self._canvas.viewport.zoomed(factor, at.x(), at.y()))
        if self._gesture is None:
            self._canvas.point_at(at)

    def _key(self, event: QKeyEvent) -> None:
        if event.key() != Qt.Key.Key_Escape:
            self._canvas.unused.emit(event)
        elif not self.cancel():
            self._canvas.escaped.emit()
