"""The preview of the mesh, which can be zoomed and panned."""

from __future__ import annotations

import numpy as np
from qtpy.QtCore import QPointF, QRectF, Qt
from qtpy.QtGui import (
    QColor,
    QMouseEvent,
    QPainter,
    QPainterPath,
    QPaintEvent,
    QPen,
    QPixmap,
    QResizeEvent,
    QWheelEvent,
)
from qtpy.QtWidgets import QSizePolicy, QWidget

from meshwright.desktop.files.new_mesh.painting import paint_mesh
from meshwright.graphics.theme import GRID, Theme
from meshwright.graphics.viewport import Viewport
from meshwright.sources.new_mesh import NewMesh

MARGIN = 20.0
ROUND = 8.0
TOO_FINE = "Too fine to draw: zoom in to see it"


class Preview(QWidget):
    """Shows a :class:`meshwright.sources.new_mesh.NewMesh`; an old one is paler while a new one
    is made.
    """

    def __init__(self, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAccessibleName("Preview of the mesh")
        self.setToolTip("Wheel: zoom. Drag: pan. Double click: fit.")
        self.setMinimumSize(240, 200)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self._theme = theme
        self._made: NewMesh | None = None
        self._words = ""
        self._stale = False
        self._view = Viewport()
        self._picture: QPixmap | None = None
        self._shows_edges = True
        self._dragged: QPointF | None = None

    def show_made(self, made: NewMesh) -> None:
        """Show a mesh; the view is refitted if the shape is another one."""
        before, self._made = self._made, made
        self._words, self._stale = "", False
        if before is None or not _same_extent(before, made):
            self._fit()
        self._redraw()

    def show_words(self, words: str, stale: bool) -> None:
        """Show a message in place of the mesh; a ``stale`` mesh stays visible, paler."""
        self._words = words
        self._stale = stale and self._made is not None
        if not stale:
            self._made = self._picture = None
        self.update()

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self._theme = theme
        self._redraw()

    def _fit(self) -> None:
        self._view = self._view.resized(self.width(), self.height())
        if self._made is not None:
            self._view = self._view.fitted(np.array([self._made.low, self._made.high]), MARGIN)

    def _redraw(self) -> None:
        self._picture = None
        self.update()

    def _drawn(self) -> QPixmap:
        ratio = self.devicePixelRatioF()
        picture = QPixmap(self.size() * ratio)
        picture.setDevicePixelRatio(ratio)
        picture.fill(QColor(self._theme.background))
        if self._made is not None:
            painter = QPainter(picture)
            painter.setRenderHint(QPainter.RenderHint.Antialiasing)
            painter.setFont(self.font())
            self._shows_edges = paint_mesh(painter, self._view, self._made, self._theme)
            painter.end()
        return picture

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802
        """Paint the cached picture, and the message."""
        if self._picture is None:
            self._picture = self._drawn()
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        frame = QPainterPath()
        frame.addRoundedRect(QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5), ROUND, ROUND)
        painter.fillPath(frame, QColor(self._theme.background))
        painter.setClipPath(frame)
        painter.setOpacity(0.35 if self._stale else 1.0)
        painter.drawPixmap(0, 0, self._picture)
        painter.setOpacity(1.0)
        words = self._words
        if not words and self._made is not None and not self._shows_edges:
            words = TOO_FINE
        if words:
            self._say(painter, words)
        painter.setClipping(False)
        painter.setPen(QPen(QColor(self._theme.line), 1.0))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawPath(frame)
        painter.end()

    def _say(self, painter: QPainter, words: str) -> None:
        room = QRectF(self.rect()).adjusted(3 * GRID, 2 * GRID, -3 * GRID, -2 * GRID)
        flags = Qt.AlignmentFlag.AlignCenter | Qt.TextFlag.TextWordWrap
        if self._made is not None:
            flags = (
                Qt.AlignmentFlag.AlignHCenter
                | Qt.AlignmentFlag.AlignBottom
                | Qt.TextFlag.TextWordWrap
            )
            box = painter.boundingRect(room, int(flags), words).adjusted(-12, -4, 12, 4)
            painter.setPen(QPen(QColor(self._theme.line), 1.0))
            painter.setBrush(QColor(self._theme.raised))
            painter.drawRoundedRect(box, 6, 6)
        painter.setPen(QColor(self._theme.muted))
        painter.drawText(room, int(flags), words)

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802
        """Refit the view."""
        self._fit()
        self._redraw()

    def wheelEvent(self, event: QWheelEvent) -> None:  # noqa: N802
        """Zoom about the mouse."""
        place = event.position()
        self._view = self._view.zoomed(1.0015 ** event.angleDelta().y(), place.x(), place.y())
        self._redraw()

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """Begin to pan."""
        self._dragged = event.position()

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """Pan."""
        if self._dragged is not None:
            step = event.position() - self._dragged
            self._dragged = event.position()
            self._view = self._view.panned(step.x(), step.y())
            self._redraw()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """End panning."""
        self._dragged = None

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """Fit the view to the mesh."""
        self._fit()
        self._redraw()


def _same_extent(one: NewMesh, other: NewMesh) -> bool:
    apart = max(abs(one.low - other.low).max(), abs(one.high - other.high).max())
    return bool(apart < 1e-6 * max(one.extent, other.extent))
