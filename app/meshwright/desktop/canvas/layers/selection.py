"""The selected vertices, and the region that they span."""

from collections.abc import Callable

import numpy as np
from qtpy.QtCore import QPointF, Qt
from qtpy.QtGui import QColor, QImage, QPainter, QPainterPath

from meshwright.desktop.canvas.layers.base import inside, pen, polyline
from meshwright.desktop.canvas.layers.cached_layer import PictureLayer
from meshwright.graphics.theme import Theme
from meshwright.graphics.true_edges import TrueEdges, polygons
from meshwright.graphics.viewport import Viewport

MANY = 1500
"""More visible vertices than this are dots of three pixels; fewer are rings."""
RADIUS = 7.5
"""Radius in pixels of the ring around a vertex without a disc."""

Radii = Callable[[Viewport], np.ndarray]


class RegionLayer(PictureLayer):
    """A tint on elements; lies below the markers."""

    def __init__(self, theme: Theme) -> None:
        super().__init__(theme)
        self._corners = np.zeros((0, 4, 2))
        self._elements = np.zeros(0, np.int64)
        self._edges: TrueEdges | None = None

    @property
    def empty(self) -> bool:
        """Whether there is no region."""
        return not len(self._corners)

    def show(self, corners: np.ndarray, elements: np.ndarray, edges: TrueEdges | None) -> None:
        """Tint elements (m,) with these corners (m, k, 2) and true edges."""
        if len(corners) or not self.empty:
            self._corners, self._elements, self._edges = corners, elements, edges
            self.forget()

    def draw(self, painter: QPainter) -> None:
        """All elements in view as one path."""
        first = self.viewport.to_screen(self._corners[:, 0])
        rows = np.column_stack([first, np.arange(len(first))])
        seen = inside(rows, self.viewport, 200.0)[:, 2].astype(int)
        if len(seen) > MANY:
            return
        path = QPainterPath()
        for polygon in polygons(self._corners[seen], self._elements[seen], self._edges):
            path.addPolygon(polyline(self.viewport.to_screen(polygon)))
            path.closeSubpath()
        tint = QColor(self.theme.accent)
        tint.setAlpha(38)
        painter.fillPath(path, tint)


class SelectionLayer(PictureLayer):
    """Rings around vertices; lies above the markers."""

    def __init__(self, theme: Theme) -> None:
        super().__init__(theme)
        self._places = np.zeros((0, 2))
        self._radii: Radii = lambda viewport: np.zeros(0)

    @property
    def empty(self) -> bool:
        """Whether nothing is selected."""
        return not len(self._places)

    @property
    def count(self) -> int:
        """Vertices that are shown."""
        return len(self._places)

    def show(self, places: np.ndarray, radii: Radii) -> None:
        """Show vertices at ``places`` (n, 2); ``radii`` gives the radius (n,) of each ring."""
        if len(places) or not self.empty:
            self._places, self._radii = places, radii
            self.forget()

    def draw(self, painter: QPainter) -> None:
        """Rings on a halo, or dots where there are very many."""
        rows = np.column_stack([self.viewport.to_screen(self._places), self._radii(self.viewport)])
        rows = inside(rows, self.viewport)
        if len(rows) > MANY:
            painter.drawImage(0, 0, _dots(rows[:, :2], self.viewport.size, self.theme.accent))
            return
        painter.setBrush(Qt.BrushStyle.NoBrush)
        for colour, width in ((self.theme.background, 4.5), (self.theme.accent, 2.25)):
            painter.setPen(pen(colour, width))
            for x, y, radius in rows.tolist():
                painter.drawEllipse(QPointF(x, y), radius, radius)


def _dots(places: np.ndarray, size: tuple[int, int], colour: str) -> QImage:
    """A picture of ``size`` with three by three pixels at each of the places (n, 2)."""
    width, height = size
    mask = np.zeros((height + 2, width + 2), bool)
    x = np.clip(np.round(places[:, 0]).astype(int), 0, width - 1)
    y = np.clip(np.round(places[:, 1]).astype(int), 0, height - 1)
    for right in range(3):
        for down in range(3):
            mask[y + down, x + right] = True
    pixels = np.where(mask[1:-1, 1:-1], np.uint32(QColor(colour).rgba()), np.uint32(0))
    pixels = np.ascontiguousarray(pixels)
    argb = QImage.Format.Format_ARGB32_Premultiplied
    return QImage(pixels.data, width, height, 4 * width, argb).copy()
