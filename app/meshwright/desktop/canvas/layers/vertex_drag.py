"""The layer of dragged vertices: their edges at the new places, inverted elements hatched."""

import numpy as np
from qtpy.QtCore import QLineF, QPointF, QRect, QRectF, Qt
from qtpy.QtGui import QColor, QPainter, QPen

from meshwright.desktop.canvas.layers.base import Layer, pen
from meshwright.desktop.canvas.layers.inverted_elements import paint_hatched
from meshwright.graphics.theme import Theme

SLACK = 24.0
COVER = 13.0
"""Radius in pixels of the cover over the disc at the original place of a vertex."""


class RubberLayer(Layer):
    """Follows a drag; lies below the markers, with the vertices in :attr:`top` above them."""

    def __init__(self, theme: Theme) -> None:
        super().__init__(theme)
        self._before = np.zeros((0, 2, 2))
        self._segments = np.zeros((0, 2, 2))
        self._folded = np.zeros((0, 3, 2))
        self._places = np.zeros((0, 2))
        self._from = np.zeros((0, 2))
        self.top = RubberVertices(theme, self)

    @property
    def folded(self) -> int:
        """Elements that would be inverted."""
        return len(self._folded)

    @property
    def places(self) -> np.ndarray:
        """(n, 2) where the dragged vertices would be, in the plane."""
        return self._places

    def begin(self, segments: np.ndarray, places: np.ndarray) -> None:
        """Begin a drag of vertices (n, 2) with their edges (m, 2, 2)."""
        self._before, self._from = segments, places
        self.show(segments, np.zeros((0, 3, 2)), np.zeros((0, 2)))

    def show(self, segments: np.ndarray, folded: np.ndarray, places: np.ndarray) -> None:
        """The edges (m, 2, 2), folded elements (f, k, 2) and vertices (n, 2) as they are now."""
        before = self._rect()
        self._segments, self._folded, self._places = segments, folded, places
        self.changed(before.united(self._rect()))

    def clear(self) -> None:
        """End the drag."""
        before = self._rect()
        self._before = self._segments = np.zeros((0, 2, 2))
        self._folded = np.zeros((0, 3, 2))
        self._places = self._from = np.zeros((0, 2))
        self.changed(before)

    def paint(self, painter: QPainter, rect: QRect) -> None:
        """Paint the original edges faded, then the new ones."""
        if not len(self._segments):
            return
        painter.setPen(pen(self.theme.fill, 4.0))
        painter.drawLines(self._lines(self._before))
        paint_hatched(painter, self.viewport.to_screen(self._folded), self.theme)
        painter.setPen(pen(self.theme.arrow, 1.75))
        painter.drawLines(self._lines(self._segments))

    def paint_vertices(self, painter: QPainter) -> None:
        """Cover the marks at the original places, and paint the vertices at the new ones."""
        painter.setPen(QPen(QColor(self.theme.faint), 1.25, Qt.PenStyle.DotLine))
        painter.setBrush(QColor(self.theme.fill))
        for x, y in self.viewport.to_screen(self._from).tolist():
            painter.drawEllipse(QPointF(x, y), COVER, COVER)
        painter.setPen(pen(self.theme.background, 1.5))
        painter.setBrush(QColor(self.theme.arrow))
        for x, y in self.viewport.to_screen(self._places).tolist():
            painter.drawEllipse(QPointF(x, y), 6.0, 6.0)

    def _lines(self, segments: np.ndarray) -> list[QLineF]:
        ends = self.viewport.to_screen(segments.reshape(-1, 2)).reshape(-1, 4)
        return [QLineF(*line) for line in ends.tolist()]

    def _rect(self) -> QRectF:
        ends = np.concatenate([self._before.reshape(-1, 2), self._segments.reshape(-1, 2)])
        if not len(ends):
            return QRectF()
        at = self.viewport.to_screen(ends)
        low, high = at.min(axis=0) - SLACK, at.max(axis=0) + SLACK
        return QRectF(QPointF(*low.tolist()), QPointF(*high.tolist()))


class RubberVertices(Layer):
    """The dragged vertices."""

    def __init__(self, theme: Theme, edges: RubberLayer) -> None:
        super().__init__(theme)
        self._edges = edges

    def paint(self, painter: QPainter, rect: QRect) -> None:
        """Paint the vertices at the original and at the new places."""
        self._edges.paint_vertices(painter)
