"""The layer of what has just changed: new edges in the accent colour, deleted ones dashed."""

from __future__ import annotations

import numpy as np
from qtpy.QtCore import QLineF, QRect, Qt
from qtpy.QtGui import QPainter

from meshwright.desktop.canvas.layers.base import Layer, pen
from meshwright.graphics.theme import Theme

NOTHING = np.zeros((0, 2, 2))


class ChangesLayer(Layer):
    """Marks edges in the plane; lies below the markers."""

    def __init__(self, theme: Theme) -> None:
        super().__init__(theme)
        self.added = self.removed = NOTHING

    def show(self, added: np.ndarray = NOTHING, removed: np.ndarray = NOTHING) -> None:
        """Mark pieces (n, 2, 2) of edges that were added and removed; none: mark nothing."""
        if len(added) or len(removed) or len(self.added) or len(self.removed):
            self.added, self.removed = added, removed
            self.changed()

    def paint(self, painter: QPainter, rect: QRect) -> None:
        """Draw the edges over those of the mesh."""
        painter.setPen(pen(self.theme.faint, 1.5, Qt.PenStyle.DashLine))
        self._draw(painter, self.removed)
        painter.setPen(pen(self.theme.accent, 3.0))
        self._draw(painter, self.added)

    def _draw(self, painter: QPainter, ends: np.ndarray) -> None:
        places = self.viewport.to_screen(ends).reshape(-1, 4)
        painter.drawLines([QLineF(*one) for one in places.tolist()])
