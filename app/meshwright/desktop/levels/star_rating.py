"""A rating of up to three stars."""

import math

from qtpy.QtCore import QPointF, QSize, Qt
from qtpy.QtGui import QColor, QPainter, QPaintEvent, QPen, QPolygonF
from qtpy.QtWidgets import QWidget

from meshwright.graphics.theme import Theme
from meshwright.puzzles.progress import MOST_STARS

INNER = 0.45
"""Radius of the notches, relative to that of the tips."""


class StarRating(QWidget):
    """Three stars of ``size`` pixels, the first :attr:`count` of them filled."""

    def __init__(self, theme: Theme, size: int = 16) -> None:
        super().__init__()
        self._theme, self._size, self._count = theme, size, 0
        self.setFixedSize(self.sizeHint())
        self.count = 0

    @property
    def count(self) -> int:
        """Stars that are filled."""
        return self._count

    @count.setter
    def count(self, count: int) -> None:
        self._count = count
        words = f"{count} of {MOST_STARS} stars"
        self.setAccessibleName(words)
        self.setToolTip(words)
        self.update()

    def sizeHint(self) -> QSize:  # noqa: N802
        """The preferred size."""
        return QSize(MOST_STARS * (self._size + 2), self._size + 2)

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self._theme = theme
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802
        """Paint the stars side by side."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        for number in range(MOST_STARS):
            won = number < self._count
            colour = QColor(self._theme.accent if won else self._theme.faint)
            pen = QPen(colour, 1.25)
            pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
            painter.setPen(pen)
            painter.setBrush(colour if won else Qt.BrushStyle.NoBrush)
            middle = QPointF((number + 0.5) * (self._size + 2), 0.5 * self._size + 1.5)
            painter.drawPolygon(star(middle, 0.5 * self._size - 1))
        painter.end()


def star(middle: QPointF, radius: float) -> QPolygonF:
    """A star with five tips, one of them up."""
    points = []
    for corner in range(10):
        angle = math.pi * (corner / 5 - 0.5)
        reach = radius if corner % 2 == 0 else INNER * radius
        points.append(middle + QPointF(reach * math.cos(angle), reach * math.sin(angle)))
    return QPolygonF(points)
