"""The layer of named sides, each in the colour of its name, and their legend."""

from __future__ import annotations

import numpy as np
from qtpy.QtCore import QPointF, QRectF, Qt
from qtpy.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPen, QPolygonF

from meshwright.desktop.canvas.layers.cached_layer import PictureLayer
from meshwright.graphics.theme import Theme, name_colours

_ROWS = 12
"""Names in the legend; of more the last row says how many."""
_WIDEST = 200
_PAD, _ROW, _SWATCH = 8.0, 18.0, 14.0


class SideNamesLayer(PictureLayer):
    """Strokes along named sides, and a legend in the lower left corner; below the markers."""

    def __init__(self, theme: Theme, font: QFont) -> None:
        super().__init__(theme)
        self._font = QFont(font)
        self._font.setPixelSize(12)
        self._sides: dict[str, list[np.ndarray]] = {}

    @property
    def names(self) -> tuple[str, ...]:
        """The names that are shown."""
        return tuple(self._sides)

    @property
    def empty(self) -> bool:
        """Whether no side has a name."""
        return not self._sides

    def colours(self) -> dict[str, str]:
        """The colour of each name."""
        return dict(zip(self._sides, name_colours(self.theme, len(self._sides)), strict=True))

    def show(self, sides: dict[str, list[np.ndarray]]) -> None:
        """Show the polylines (n, 2) of each side by its name."""
        if sides or self._sides:
            self._sides = sides
            self.forget()

    def draw(self, painter: QPainter) -> None:
        """Paint the strokes, then the legend."""
        colours = self.colours()
        for name, lines in self._sides.items():
            painter.setPen(
                QPen(QColor(colours[name]), 4.5, Qt.PenStyle.SolidLine, Qt.PenCapStyle.FlatCap)
            )
            for line in lines:
                places = self.viewport.to_screen(line)
                painter.drawPolyline(QPolygonF([QPointF(x, y) for x, y in places.tolist()]))
        self._draw_legend(painter, colours)

    def _draw_legend(self, painter: QPainter, colours: dict[str, str]) -> None:
        shown = list(colours)[:_ROWS]
        metrics = QFontMetricsF(self._font)
        words = [metrics.elidedText(one, Qt.TextElideMode.ElideRight, _WIDEST) for one in shown]
        more = len(colours) - len(shown)
        rows = [*words, f"and {more} more"] if more else words
        width = max(metrics.horizontalAdvance(row) for row in rows) + _SWATCH + 3 * _PAD
        height = _ROW * len(rows) + 2 * _PAD
        box = QRectF(_PAD, self.viewport.size[1] - height - _PAD, width, height)
        ground = QColor(self.theme.raised)
        ground.setAlpha(225)
        painter.setPen(QPen(QColor(self.theme.line), 1.0))
        painter.setBrush(ground)
        painter.drawRoundedRect(box, 6.0, 6.0)
        painter.setFont(self._font)
        for number, row in enumerate(rows):
            middle = box.top() + _PAD + (number + 0.5) * _ROW
            left = box.left() + _PAD
            if number < len(shown):
                painter.setPen(QPen(QColor(colours[shown[number]]), 4.5))
                painter.drawLine(QPointF(left, middle), QPointF(left + _SWATCH, middle))
            painter.setPen(QColor(self.theme.text))
            place = QRectF(left + _SWATCH + _PAD, middle - 0.5 * _ROW, _WIDEST + 20.0, _ROW)
            painter.drawText(place, int(Qt.AlignmentFlag.AlignVCenter), row)
