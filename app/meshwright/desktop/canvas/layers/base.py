"""The base class of the overlay's layers, and helpers for painting."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from qtpy.QtCore import QPointF, QRect, QRectF, Qt
from qtpy.QtGui import QColor, QPainter, QPen, QPolygonF

from meshwright.graphics.theme import Theme
from meshwright.graphics.viewport import Viewport


class Layer:
    """Paints over the mesh in pixels of the canvas, without a new frame of VTK.

    The overlay sets ``repaint(rect)``, which requests that a part of the canvas, or all of it for
    None, be painted again.
    """

    def __init__(self, theme: Theme) -> None:
        self.theme = theme
        self.viewport = Viewport()
        self.repaint: Callable[[QRectF | None], None] = lambda rect: None
        self._visible = True

    @property
    def visible(self) -> bool:
        """Whether the layer is painted at all."""
        return self._visible

    @visible.setter
    def visible(self, visible: bool) -> None:
        if visible != self._visible:
            self._visible = visible
            self.repaint(None)

    def changed(self, rect: QRectF | QRect | None = None) -> None:
        """Request that ``rect`` be painted again; None: everything."""
        if self._visible:
            self.repaint(None if rect is None else QRectF(rect))

    def set_theme(self, theme: Theme) -> None:
        """Paint in the colours of ``theme``."""
        self.theme = theme

    def look(self, viewport: Viewport) -> None:
        """Follow a change of the view; the caller repaints everything."""
        self.viewport = viewport

    def paint(self, painter: QPainter, rect: QRect) -> None:
        """Paint the part inside ``rect``; the caller restores the painter's state."""
        raise NotImplementedError


def pen(colour: str, width: float, style: Qt.PenStyle = Qt.PenStyle.SolidLine) -> QPen:
    """A pen with round ends and corners."""
    cap, join = Qt.PenCapStyle.RoundCap, Qt.PenJoinStyle.RoundJoin
    return QPen(QColor(colour), width, style, cap, join)


def polyline(points: np.ndarray) -> QPolygonF:
    """Points (n, 2) in pixels for Qt: a polyline, or a polygon where they are filled."""
    return QPolygonF([QPointF(x, y) for x, y in points.tolist()])


def inside(rows: np.ndarray, viewport: Viewport, slack: float = 24.0) -> np.ndarray:
    """The rows of ``rows`` (n, m) whose first two columns, in pixels, lie in the view enlarged by
    ``slack``.
    """
    x, y = rows[:, 0], rows[:, 1]
    width, height = viewport.size
    return rows[(x > -slack) & (x < width + slack) & (y > -slack) & (y < height + slack)]
