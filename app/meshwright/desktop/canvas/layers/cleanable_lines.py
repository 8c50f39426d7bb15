"""The layer of removable global lines, highlighted; the one under the mouse more strongly."""

import numpy as np
from qtpy.QtCore import QPointF, QRect, QRectF, Qt
from qtpy.QtGui import QColor, QPainter, QPen, QPolygonF

from meshwright.desktop.canvas.layers.base import pen
from meshwright.desktop.canvas.layers.cached_layer import PictureLayer
from meshwright.graphics.theme import Theme

STEP = 6.0
"""Pixels between the points that a line is drawn by: finer ones are left out."""
COARSE = 24.0
"""Likewise where there are more lines than :data:`MANY`."""
MANY = 120


class LinesLayer(PictureLayer):
    """Polylines in the plane; lies below the markers."""

    def __init__(self, theme: Theme) -> None:
        super().__init__(theme)
        self._lines: list[np.ndarray] = []
        self._current = -1

    @property
    def count(self) -> int:
        """Number of lines that are shown."""
        return len(self._lines)

    @property
    def current(self) -> int:
        """The number of the line under the mouse, -1 for none."""
        return self._current

    def show(self, lines: list[np.ndarray]) -> None:
        """Show these polylines (n, 2)."""
        if lines or self._lines:
            self._lines, self._current = lines, -1
            self.forget()

    def highlight(self, current: int) -> None:
        """Highlight line ``current`` more strongly; -1 for none."""
        if current != self._current:
            before = self._rect()
            self._current = current
            self.changed(before.united(self._rect()))

    @property
    def empty(self) -> bool:
        """Whether there are no lines."""
        return not self._lines

    def paint(self, painter: QPainter, rect: QRect) -> None:
        """Paint the cached image of all lines, then the current line once more."""
        super().paint(painter, rect)
        if 0 <= self._current < len(self._lines):
            self._stroke(painter, self._lines[self._current], 110, 11.0, 3.0)

    def draw(self, painter: QPainter) -> None:
        """Paint all lines; thin ones if there are very many."""
        if len(self._lines) <= MANY:
            for line in self._lines:
                self._stroke(painter, line, 56, 8.0, 1.75)
            return
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
        painter.setPen(QPen(QColor(self.theme.accent), 1.0))
        for line in self._lines:
            painter.drawPolyline(self._shape(line, COARSE))

    def _stroke(
        self, painter: QPainter, line: np.ndarray, alpha: int, halo: float, core: float
    ) -> None:
        """A wide soft line under a thin one, with a dot at either end."""
        shape = self._shape(line, STEP)
        soft = QColor(self.theme.accent)
        soft.setAlpha(alpha)
        painter.setPen(QPen(soft, halo, Qt.PenStyle.SolidLine, Qt.PenCapStyle.FlatCap))
        painter.drawPolyline(shape)
        painter.setPen(pen(self.theme.accent, core, Qt.PenStyle.DotLine))
        painter.drawPolyline(shape)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(self.theme.accent))
        for end in (shape.first(), shape.last()):
            painter.drawEllipse(end, core + 1.75, core + 1.75)

    def _shape(self, line: np.ndarray, step: float) -> QPolygonF:
        """The line in pixels, with no more than a point every ``step`` of them."""
        at = self.viewport.to_screen(line)
        mean = float(np.hypot(*np.diff(at, axis=0).T).mean())
        stride = max(1, int(step / max(mean, 1e-9)))
        at = np.concatenate([at[:-1:stride], at[-1:]])
        return QPolygonF([QPointF(x, y) for x, y in at.tolist()])

    def _rect(self) -> QRectF:
        if not 0 <= self._current < len(self._lines):
            return QRectF()
        at = self.viewport.to_screen(self._lines[self._current])
        low, high = at.min(axis=0) - 8.0, at.max(axis=0) + 8.0
        return QRectF(QPointF(*low.tolist()), QPointF(*high.tolist()))
