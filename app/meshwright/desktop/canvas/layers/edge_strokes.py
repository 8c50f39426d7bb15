"""Edges, straight and curved, as strokes of a pen."""

from __future__ import annotations

import numpy as np
from qtpy.QtCore import QLineF
from qtpy.QtGui import QPainter, QPolygonF

from meshwright.desktop.canvas.layers.base import polyline
from meshwright.graphics.true_edges import polylines
from meshwright.graphics.viewport import Viewport
from meshwright_core.geometry.edge_parts import EdgeParts


class EdgeStrokes:
    """Draws the edges that are in view; their polylines are made once for each view."""

    def __init__(self, edges: EdgeParts | None = None) -> None:
        self._edges = edges
        self._viewport: Viewport | None = None
        self._lines: list[QLineF] = []
        self._curves: list[QPolygonF] = []

    def draw(self, painter: QPainter, viewport: Viewport) -> None:
        """Draw all edges with the painter's pen."""
        if viewport is not self._viewport:
            self._viewport = viewport
            self._fit(viewport)
        if self._lines:
            painter.drawLines(self._lines)
        for curve in self._curves:
            painter.drawPolyline(curve)

    def _fit(self, viewport: Viewport) -> None:
        self._lines, self._curves = [], []
        if self._edges is None or not len(self._edges):
            return
        bent = self._edges.curve >= 0
        ends = viewport.to_screen(self._edges.ends[~bent])
        self._lines = [
            QLineF(*line) for line in ends[_in_view(ends, viewport)].reshape(-1, 4).tolist()
        ]
        for line in polylines(self._edges.take(bent), viewport):
            places = viewport.to_screen(line)
            if _in_view(places[None], viewport)[0]:
                self._curves.append(polyline(places))


def _in_view(lines: np.ndarray, viewport: Viewport) -> np.ndarray:
    """(n,) whether the boxes around polylines (n, p, 2) in pixels meet the view."""
    low, high = lines.min(axis=1), lines.max(axis=1)
    seen: np.ndarray = ((high > 0) & (low < viewport.size)).all(axis=1)
    return seen
