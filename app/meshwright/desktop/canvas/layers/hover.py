"""The half-edge under the mouse: an arrow on its own side of the edge, its element tinted."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from qtpy.QtCore import QRect, QRectF, Qt
from qtpy.QtGui import QColor, QPainter, QPainterPath, QPolygonF

from meshwright.desktop.canvas.layers.base import Layer, pen, polyline
from meshwright.graphics.theme import Theme

SLACK = 14
"""Pixels around the hovered element that its arrow may touch."""
TRIM = 0.12
"""Share of an edge that its arrow leaves free at either end."""

Sides = Sequence[np.ndarray]
"""The sides of an element in pixels, each (n, 2) from corner to corner."""


class ElementLayer(Layer):
    """The tint of the element under the mouse; lies below the markers."""

    def __init__(self, theme: Theme) -> None:
        super().__init__(theme)
        self._element: QPolygonF | None = None

    def show(self, sides: Sides | None) -> None:
        """Tint an element, or nothing."""
        before = _around(self._element)
        self._element = None if sides is None else outline(sides)
        self.changed(before.united(_around(self._element)))

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
        self._sides: Sides | None = None
        self._side = 0

    @property
    def line(self) -> np.ndarray:
        """(n, 2) the arrow in pixels, from tail to tip; (0, 2) without one."""
        return np.zeros((0, 2)) if self._sides is None else arrow(self._sides, self._side)

    def show(self, sides: Sides | None, side: int) -> None:
        """The arrow along one of the sides of an element, or none."""
        before = self._rect()
        self._sides, self._side = sides, side
        self.changed(before.united(self._rect()))

    def paint(self, painter: QPainter, rect: QRect) -> None:
        """Line and head, with a halo."""
        if self._sides is None:
            return
        line = self.line
        length = lengths(line)[-1]
        if length < 1.0:
            return
        size = min(9.0, 0.45 * float(length))
        shaft = polyline(part(line, 0.0, length - 0.8 * size))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        for colour, width in ((self.theme.background, 5.0), (self.theme.arrow, 2.25)):
            painter.setPen(pen(colour, width))
            painter.drawPolyline(shaft)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(self.theme.arrow))
        painter.drawPath(head(line, size, 0.72))

    def _rect(self) -> QRectF:
        return _around(None if self._sides is None else outline(self._sides))


def outline(sides: Sides) -> QPolygonF:
    """An element as Qt's polygon."""
    return polyline(np.concatenate([side[:-1] for side in sides]))


def arrow(sides: Sides, side: int) -> np.ndarray:
    """(n, 2) the arrow just inside an element along one of its sides, from tail to tip."""
    line = sides[side]
    centre = np.mean([one[0] for one in sides], axis=0)
    # drawn in towards the centre by a fifth of the way, by 9 pixels at most
    middle = part(line, 0.0, 0.5 * lengths(line)[-1])[-1]
    depth = float(np.hypot(*(centre - middle)))
    line = line + min(0.22, 9.0 / max(depth, 1e-6)) * (centre - line)
    length = lengths(line)[-1]
    return part(line, TRIM * length, (1.0 - TRIM) * length)


def head(line: np.ndarray, size: float, notch: float = 1.0) -> QPainterPath:
    """The head of an arrow along ``line`` (n, 2), ``size`` pixels long; ``notch`` is the share of
    it at its middle.
    """
    tip = line[-1]
    length = lengths(line)[-1]
    along = tip - part(line, 0.0, length - min(size, 0.5 * length))[-1]
    along /= max(float(np.hypot(*along)), 1e-9)
    normal = np.array((-along[1], along[0]))
    corners = [
        tip,
        tip - size * along + 0.5 * size * normal,
        tip - notch * size * along,
        tip - size * along - 0.5 * size * normal,
    ]
    path = QPainterPath()
    path.addPolygon(polyline(np.array(corners)))
    path.closeSubpath()
    return path


def lengths(line: np.ndarray) -> np.ndarray:
    """(n,) the length of a polyline (n, 2) up to each of its points."""
    return np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])


def part(line: np.ndarray, start: float, stop: float) -> np.ndarray:
    """(m, 2) the part of a polyline (n, 2) from one length along it to another."""
    along = lengths(line)
    ends = np.array((start, stop))
    places = np.column_stack([np.interp(ends, along, line[:, c]) for c in (0, 1)])
    inner = line[(along > start) & (along < stop)]
    return np.concatenate([places[:1], inner, places[1:]])


def _around(element: QPolygonF | None) -> QRectF:
    if element is None:
        return QRectF()
    return element.boundingRect().adjusted(-SLACK, -SLACK, SLACK, SLACK)
