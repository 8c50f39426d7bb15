"""The selected vertices and the region that they span."""

import numpy as np
from qtpy.QtCore import QPointF, QRect, QRectF, Qt
from qtpy.QtGui import QColor, QImage, QPainter, QPainterPath, QPolygonF

from app.desktop.layers.layer import Layer, inside, pen
from app.theme import Theme
from app.viewport import Viewport

MANY = 1500
"""More visible vertices than this are dots of three pixels; fewer are rings."""


class SelectionLayer(Layer):
    """Paints into a picture of its own when the view moves, so that a hover copies pixels only."""

    def __init__(self, theme: Theme) -> None:
        super().__init__(theme)
        self._places = np.zeros((0, 2))
        self._elements = np.zeros((0, 4, 2))
        self._picture: QImage | None = None

    @property
    def count(self) -> int:
        """Vertices that are shown."""
        return len(self._places)

    def show(self, places: np.ndarray, elements: np.ndarray) -> None:
        """Show vertices at ``places`` (n, 2) and elements with these corners (m, k, 2)."""
        nothing = not len(places) and not len(self._places)
        self._places, self._elements, self._picture = places, elements, None
        if not nothing:
            self.changed()

    def set_theme(self, theme: Theme) -> None:
        """Paint in other colours."""
        super().set_theme(theme)
        self._picture = None

    def look(self, viewport: Viewport) -> None:
        """The view has moved."""
        super().look(viewport)
        self._picture = None

    def paint(self, painter: QPainter, rect: QRect) -> None:
        """Copy the picture, made anew where it is out of date."""
        if not len(self._places):
            return
        ratio = painter.device().devicePixelRatioF()
        if self._picture is None or self._picture.devicePixelRatio() != ratio:
            self._picture = self._draw(ratio)
        part = QRectF(rect)
        source = QRectF(part.topLeft() * ratio, part.size() * ratio)
        painter.drawImage(part, self._picture, source)

    def _draw(self, ratio: float) -> QImage:
        width, height = self.viewport.size
        format_ = QImage.Format.Format_ARGB32_Premultiplied
        image = QImage(round(width * ratio), round(height * ratio), format_)
        image.setDevicePixelRatio(ratio)
        image.fill(Qt.GlobalColor.transparent)
        painter = QPainter(image)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self._draw_region(painter)
        self._draw_vertices(painter)
        painter.end()
        return image

    def _draw_region(self, painter: QPainter) -> None:
        corners = self.viewport.to_screen(self._elements.reshape(-1, 2))
        corners = corners.reshape(self._elements.shape)
        middles = corners.mean(axis=1) if len(corners) else np.zeros((0, 2))
        rows = np.column_stack([middles, np.arange(len(middles))])
        seen = inside(rows, self.viewport)[:, 2].astype(int)
        if len(seen) > MANY:
            return
        path = QPainterPath()
        for polygon in corners[seen].tolist():
            path.addPolygon(QPolygonF([QPointF(x, y) for x, y in (*polygon, polygon[0])]))
        tint = QColor(self.theme.accent)
        tint.setAlpha(38)
        painter.fillPath(path, tint)

    def _draw_vertices(self, painter: QPainter) -> None:
        at = inside(self.viewport.to_screen(self._places), self.viewport)
        if len(at) > MANY:
            colour = QColor(self.theme.accent)
            painter.setPen(Qt.PenStyle.NoPen)
            pixels = np.unique(np.round(at).astype(int), axis=0)
            for x, y in pixels.tolist():
                painter.fillRect(x - 1, y - 1, 3, 3, colour)
            return
        painter.setBrush(Qt.BrushStyle.NoBrush)
        for colour, width in ((self.theme.background, 4.5), (self.theme.accent, 2.25)):
            painter.setPen(pen(colour, width))
            for x, y in at.tolist():
                painter.drawEllipse(QPointF(x, y), 7.5, 7.5)
