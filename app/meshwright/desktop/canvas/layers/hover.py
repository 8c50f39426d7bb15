"""The half-edge under the mouse: an arrow on its own side of the edge, its element tinted."""

import numpy as np
from qtpy.QtCore import QPointF, QRect, QRectF, Qt
from qtpy.QtGui import QColor, QPainter, QPainterPath, QPolygonF

from meshwright.desktop.canvas.layers.base import Layer, pen
from meshwright.graphics.theme import Theme

SLACK = 14
"""Pixels around the hovered element that its arrow may touch."""


class ElementLayer(Layer):
    """The tint of the element under the mouse; lies below the markers."""

    def __init__(self, theme: Theme) -> None:
        super().__init__(theme)
        self._element: QPolygonF | None = None

    def show(self, element: QPolygonF | None) -> None:
        """Tint ``element`` (pixels), or nothing."""
        before = _around(self._element)
        self._element = element
        self.changed(before.united(_around(element)))

    def paint(self, painter: QPainter, rect: QRect) -> None:
        """Fill the element lightly."""
        if self._element is not None:
            tint = QColor(self.theme.arrow)
            tint.setAlpha(26)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(tint)
            painter.drawPolygon(self._element)


class ArrowLayer(Layer):
    """The arrow of the half-edge under the mouse; lies above the markers."""

    def __init__(self, theme: Theme) -> None:
        super().__init__(theme)
        self._element: QPolygonF | None = None
        self._side = 0

    def show(self, element: QPolygonF | None, side: int) -> None:
        """The arrow along edge ``side`` of ``element`` (pixels), or none."""
        before = _around(self._element)
        self._element, self._side = element, side
        self.changed(before.united(_around(element)))

    def paint(self, painter: QPainter, rect: QRect) -> None:
        """Line and head, with a halo."""
        if self._element is None:
            return
        tail, head = arrow(self._element, self._side)
        along = head - tail
        length = float(np.hypot(along.x(), along.y()))
        if length < 1.0:
            return
        along /= length
        normal = QPointF(-along.y(), along.x())
        size = min(9.0, 0.45 * length)
        path = QPainterPath(head)
        path.lineTo(head - along * size + normal * (0.5 * size))
        path.lineTo(head - along * (0.72 * size))
        path.lineTo(head - along * size - normal * (0.5 * size))
        path.closeSubpath()
        end = head - along * (0.8 * size)
        painter.setPen(pen(self.theme.background, 5.0))
        painter.drawLine(tail, end)
        painter.setPen(pen(self.theme.arrow, 2.25))
        painter.drawLine(tail, end)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(self.theme.arrow))
        painter.drawPath(path)


def polygon(corners: np.ndarray) -> QPolygonF:
    """``corners`` (k, 2) in pixels as Qt's polygon."""
    return QPolygonF([QPointF(x, y) for x, y in corners.tolist()])


def arrow(element: QPolygonF, side: int) -> tuple[QPointF, QPointF]:
    """Tail and head of the arrow just inside ``element`` along its edge ``side``."""
    count = element.count()
    a, b = element.at(side), element.at((side + 1) % count)
    centre = QPointF(0.0, 0.0)
    for i in range(count):
        centre += element.at(i) / count
    # drawn in towards the centre by a tenth of the way, by 9 pixels at most
    middle = (a + b) / 2.0
    depth = float(np.hypot(centre.x() - middle.x(), centre.y() - middle.y()))
    share = min(0.22, 9.0 / max(depth, 1e-6))
    a, b = a + (centre - a) * share, b + (centre - b) * share
    trim = 0.12
    return a + (b - a) * trim, b - (b - a) * trim


def _around(element: QPolygonF | None) -> QRectF:
    if element is None:
        return QRectF()
    return element.boundingRect().adjusted(-SLACK, -SLACK, SLACK, SLACK)
