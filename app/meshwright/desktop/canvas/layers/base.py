"""What all layers of the overlay have in common."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from qtpy.QtCore import QRect, QRectF, Qt
from qtpy.QtGui import QColor, QPainter, QPen

from meshwright.graphics.theme import Theme
from meshwright.graphics.viewport import Viewport


class Layer:
    """Something painted over the mesh in pixels of the canvas, without a frame of VTK's.

    ``repaint(rect)`` is put in by the overlay: it asks for a part of the canvas, or all of it for
    None, to be painted again.
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
        """Paint ``rect`` again soon, or everything."""
        if self._visible:
            self.repaint(None if rect is None else QRectF(rect))

    def set_theme(self, theme: Theme) -> None:
        """Paint in other colours."""
        self.theme = theme

    def look(self, viewport: Viewport) -> None:
        """The view has moved; whoever moved it repaints everything."""
        self.viewport = viewport

    def paint(self, painter: QPainter, rect: QRect) -> None:
        """Paint what touches ``rect``; the painter's state is restored afterwards."""
        raise NotImplementedError


def pen(colour: str, width: float, style: Qt.PenStyle = Qt.PenStyle.SolidLine) -> QPen:
    """A pen with round ends and corners."""
    cap, join = Qt.PenCapStyle.RoundCap, Qt.PenJoinStyle.RoundJoin
    return QPen(QColor(colour), width, style, cap, join)


def inside(rows: np.ndarray, viewport: Viewport, slack: float = 24.0) -> np.ndarray:
    """The rows whose first two columns, pixels, lie in the view or at most ``slack`` beside it."""
    x, y = rows[:, 0], rows[:, 1]
    width, height = viewport.size
    return rows[(x > -slack) & (x < width + slack) & (y > -slack) & (y < height + slack)]
