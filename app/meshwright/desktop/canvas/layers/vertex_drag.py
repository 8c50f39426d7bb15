"""The layer of dragged vertices: their edges at the new places, inverted elements hatched."""

from __future__ import annotations

import numpy as np
from qtpy.QtCore import QPointF, QRect, QRectF, Qt
from qtpy.QtGui import QColor, QPainter, QPen

from meshwright.desktop.canvas.layers.base import Layer, pen
from meshwright.desktop.canvas.layers.edge_strokes import EdgeStrokes
from meshwright.desktop.canvas.layers.inverted_elements import paint_hatched
from meshwright.document.vertex_drag import Drag
from meshwright.graphics.theme import Theme
from meshwright.graphics.true_edges import polylines
from meshwright_core.geometry.edge_parts import EdgeParts

SLACK = 24.0
COVER = 13.0
"""Radius in pixels of the cover over the disc at the original place of a vertex."""


class RubberLayer(Layer):
    """Follows a drag; lies below the markers, with the vertices in :attr:`top` above them."""

    def __init__(self, theme: Theme) -> None:
        super().__init__(theme)
        self._before, self._edges = EdgeStrokes(), EdgeStrokes()
        self._folded: EdgeParts | None = None
        self._count = 0
        self._box, self._box_before = QRectF(), QRectF()  # in the plane
        self._places = np.zeros((0, 2))
        self._from = np.zeros((0, 2))
        self.top = RubberVertices(theme, self)

    @property
    def folded(self) -> int:
        """Elements that would be inverted."""
        return self._count

    @property
    def places(self) -> np.ndarray:
        """(n, 2) where the dragged vertices would be, in the plane."""
        return self._places

    def begin(self, drag: Drag) -> None:
        """Begin a drag."""
        edges = drag.edges
        self._before, self._box_before = EdgeStrokes(edges), _box(edges)
        self._from = drag.places[:, :2]
        self._show(edges, None, 0, np.zeros((0, 2)))

    def show(self, drag: Drag) -> None:
        """The edges, folded elements and vertices as they are now."""
        self._show(drag.edges, drag.folded_sides, len(drag.folded), drag.places[:, :2])

    def _show(
        self, edges: EdgeParts, folded: EdgeParts | None, count: int, places: np.ndarray
    ) -> None:
        before = self._rect()
        self._edges, self._box = EdgeStrokes(edges), _box(edges)
        self._folded, self._count, self._places = folded, count, places
        self.changed(before.united(self._rect()))

    def clear(self) -> None:
        """End the drag."""
        before = self._rect()
        self._before = self._edges = EdgeStrokes()
        self._folded, self._count = None, 0
        self._box = self._box_before = QRectF()
        self._places = self._from = np.zeros((0, 2))
        self.changed(before)

    def paint(self, painter: QPainter, rect: QRect) -> None:
        """Paint the original edges faded, then the new ones."""
        if self._box.isNull():
            return
        painter.setPen(pen(self.theme.fill, 4.0))
        self._before.draw(painter, self.viewport)
        if self._folded is not None and self._count:
            sides = polylines(self._folded, self.viewport)
            k = len(sides) // self._count
            shapes = [
                np.concatenate([side[:-1] for side in sides[first : first + k]])
                for first in range(0, len(sides), k)
            ]
            paint_hatched(painter, [self.viewport.to_screen(shape) for shape in shapes], self.theme)
        painter.setPen(pen(self.theme.arrow, 1.75))
        self._edges.draw(painter, self.viewport)

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

    def _rect(self) -> QRectF:
        box = self._box_before.united(self._box)
        if box.isNull():
            return QRectF()
        corners = np.array([(box.left(), box.bottom()), (box.right(), box.top())])
        low, high = self.viewport.to_screen(corners) + ((-SLACK, -SLACK), (SLACK, SLACK))
        return QRectF(QPointF(*low.tolist()), QPointF(*high.tolist()))


def _box(edges: EdgeParts) -> QRectF:
    """The box around edges in the plane."""
    (left, bottom, _), (right, top, _) = edges.box.tolist()
    return QRectF(QPointF(left, bottom), QPointF(right, top))


class RubberVertices(Layer):
    """The dragged vertices."""

    def __init__(self, theme: Theme, edges: RubberLayer) -> None:
        super().__init__(theme)
        self._edges = edges

    def paint(self, painter: QPainter, rect: QRect) -> None:
        """Paint the vertices at the original and at the new places."""
        self._edges.paint_vertices(painter)
