"""The layer of inverted elements, which are hatched."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from qtpy.QtCore import QPointF, QRect, Qt
from qtpy.QtGui import QBrush, QColor, QPainter, QPolygonF

from meshwright.desktop.canvas.layers.base import Layer, inside, pen, polyline
from meshwright.graphics.theme import Theme
from meshwright.graphics.true_edges import TrueEdges, polygons
from meshwright.graphics.viewport import Viewport

SMALLEST = 9.0
"""Elements narrower than this in pixels get a warning sign as well."""
SLACK = 24.0
"""Pixels beside an element that its sign may reach."""
MOST = 1500
"""At most this many visible elements are hatched."""


class HatchLayer(Layer):
    """The inverted elements of a mesh; lies below the markers."""

    def __init__(self, theme: Theme) -> None:
        super().__init__(theme)
        self._corners = np.zeros((0, 3, 2))
        self._elements = np.zeros(0, np.int64)
        self._edges: TrueEdges | None = None
        self._seen: list[np.ndarray] = []  # polygons in pixels
        self._low = self._high = np.zeros((0, 2))  # boxes around what each of them paints

    @property
    def count(self) -> int:
        """Elements that are hatched where they are in view."""
        return len(self._corners)

    def show(self, corners: np.ndarray, elements: np.ndarray, edges: TrueEdges | None) -> None:
        """Hatch elements (n,) with these corners (n, k, 2) in the plane and true edges."""
        if len(corners) or len(self._corners):
            self._corners, self._elements, self._edges = corners, elements, edges
            self.look(self.viewport)
            self.changed()

    def look(self, viewport: Viewport) -> None:
        """Follow a change of the view."""
        super().look(viewport)
        corners = viewport.to_screen(self._corners)
        middles = corners.mean(axis=1) if len(corners) else np.zeros((0, 2))
        rows = np.column_stack([middles, np.arange(len(middles))])
        seen = inside(rows, viewport, 200.0)[:MOST, 2].astype(int)
        shapes = polygons(self._corners[seen], self._elements[seen], self._edges)
        self._seen = [viewport.to_screen(shape) for shape in shapes]
        self._low = np.array([shape.min(axis=0) for shape in self._seen]).reshape(-1, 2) - SLACK
        self._high = np.array([shape.max(axis=0) for shape in self._seen]).reshape(-1, 2) + SLACK

    def paint(self, painter: QPainter, rect: QRect) -> None:
        """Hatching, and a sign where the element is too small to see it."""
        low, high = (rect.left(), rect.top()), (rect.right(), rect.bottom())
        near = ((self._low <= high) & (self._high >= low)).all(axis=1)
        rows = np.flatnonzero(near).tolist()
        if rows:
            paint_hatched(painter, [self._seen[row] for row in rows], self.theme)


def paint_hatched(painter: QPainter, shapes: Sequence[np.ndarray], theme: Theme) -> None:
    """Hatch polygons, each (n, 2) in pixels; small ones also carry an exclamation mark."""
    painter.save()
    strokes = QBrush(QColor(theme.warning), Qt.BrushStyle.BDiagPattern)
    tint = QColor(theme.warning)
    tint.setAlpha(46)
    painter.setPen(pen(theme.warning, 1.5))
    for shape in shapes:
        polygon = polyline(shape)
        for brush in (QBrush(tint), strokes):
            painter.setBrush(brush)
            painter.drawPolygon(polygon)
    for shape in shapes:
        if np.ptp(shape, axis=0).min() < SMALLEST:
            _paint_sign(painter, np.mean(shape, axis=0), theme)
    painter.restore()


def _paint_sign(painter: QPainter, at: np.ndarray, theme: Theme) -> None:
    """A triangle with an exclamation mark, above and to the left of the place."""
    x, y = (at + (-11.0, -13.0)).tolist()
    sign = QPolygonF([QPointF(x, y - 8), QPointF(x + 9, y + 7), QPointF(x - 9, y + 7)])
    painter.setPen(pen(theme.background, 3.0))
    painter.setBrush(QColor(theme.warning))
    painter.drawPolygon(sign)
    painter.setPen(Qt.PenStyle.NoPen)
    painter.drawPolygon(sign)
    painter.setPen(pen(theme.background, 1.75))
    painter.drawLine(QPointF(x, y - 3), QPointF(x, y + 1.5))
    painter.drawPoint(QPointF(x, y + 4.5))
