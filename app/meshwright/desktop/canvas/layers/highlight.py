"""A highlight around the element or vertex that the view was moved to, for a few seconds."""

import numpy as np
from qtpy.QtCore import QObject, QPointF, QRect, QRectF, Qt, QTimer
from qtpy.QtGui import QPainter

from meshwright.desktop.canvas.layers.base import Layer, pen, polyline
from meshwright.graphics.theme import Theme
from meshwright.graphics.true_edges import TrueEdges, polygons

SECONDS = 4.0
_RING = 20.0
_SLACK = 6.0


class SpotLayer(Layer):
    """Outlines an element, or rings a vertex."""

    def __init__(self, theme: Theme, parent: QObject) -> None:
        super().__init__(theme)
        self._places: np.ndarray | None = None
        self._element = -1
        self._edges: TrueEdges | None = None
        self._timer = QTimer(parent)
        self._timer.setSingleShot(True)
        self._timer.timeout.connect(self.clear)

    @property
    def places(self) -> np.ndarray | None:
        """(n, 2) the highlighted point, or the corners of the highlighted element, in the plane."""
        return self._places

    def show(self, places: np.ndarray, element: int = -1, edges: TrueEdges | None = None) -> None:
        """Highlight ``places`` (n, 2 or 3) in the plane: one point, or the corners of an element
        with its true edges.
        """
        before = self._rect()
        self._places = np.asarray(places, dtype=float)[:, :2]
        self._element, self._edges = element, edges
        self._timer.start(int(SECONDS * 1000))
        self.changed(before.united(self._rect()))

    def clear(self) -> None:
        """Remove the highlight."""
        self._timer.stop()
        if self._places is not None:
            before = self._rect()
            self._places = None
            self.changed(before)

    def paint(self, painter: QPainter, rect: QRect) -> None:
        """Paint a line in the accent colour on a halo."""
        if self._places is None:
            return
        painter.setBrush(Qt.BrushStyle.NoBrush)
        points = self._outline()
        for colour, width in ((self.theme.background, 6.0), (self.theme.accent, 2.5)):
            painter.setPen(pen(colour, width))
            if len(points) == 1:
                painter.drawEllipse(QPointF(*points[0].tolist()), _RING, _RING)
            else:
                painter.drawPolygon(polyline(points))

    def _outline(self) -> np.ndarray:
        """(n, 2) the point, or the polygon, in pixels."""
        assert self._places is not None
        (shape,) = polygons(self._places[None], np.array([self._element]), self._edges)
        return self.viewport.to_screen(shape)

    def _rect(self) -> QRectF:
        if self._places is None:
            return QRectF()
        at = self._outline()
        low, high = at.min(axis=0) - _RING - _SLACK, at.max(axis=0) + _RING + _SLACK
        return QRectF(QPointF(*low.tolist()), QPointF(*high.tolist()))
