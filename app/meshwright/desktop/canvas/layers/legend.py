"""The legend of what elements are coloured by, in the lower right corner of the canvas."""

from __future__ import annotations

from dataclasses import dataclass

from qtpy.QtCore import QPointF, QRect, QRectF, Qt
from qtpy.QtGui import QColor, QFont, QFontMetricsF, QLinearGradient, QPainter, QPen

from meshwright.desktop.canvas.layers.base import Layer
from meshwright.graphics.colouring import HUES, STOPS, scale
from meshwright.graphics.theme import Theme

WIDTH, BAR = 272.0, 10.0
MARGIN, INSET = 12.0, 10.0


@dataclass(frozen=True)
class Legend:
    """``title`` and ``note``; where ``scaled`` a scale from 0 to 1 with a mark at ``bound``, else
    swatches.
    """

    title: str
    note: str = ""
    bound: float | None = None
    scaled: bool = False


class LegendLayer(Layer):
    """Paints a :class:`Legend`, or nothing."""

    def __init__(self, theme: Theme, font: QFont) -> None:
        super().__init__(theme)
        self._font = QFont(font)
        self._font.setPixelSize(11)
        self.legend: Legend | None = None

    def show(self, legend: Legend | None) -> None:
        """Show ``legend``; None hides it."""
        if legend != self.legend:
            self.legend = legend
            self.changed()

    def paint(self, painter: QPainter, rect: QRect) -> None:
        """The card with title, scale or swatches, and note."""
        legend = self.legend
        if legend is None:
            return
        card = self.card
        painter.setPen(QPen(QColor(self.theme.line), 1.0))
        back = QColor(self.theme.raised)
        back.setAlpha(235)
        painter.setBrush(back)
        painter.drawRoundedRect(card, 6.0, 6.0)
        inner = card.adjusted(INSET, 7.0, -INSET, -7.0)
        left = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop
        font = QFont(self._font)
        font.setWeight(QFont.Weight.DemiBold)
        painter.setFont(font)
        painter.setPen(QColor(self.theme.text))
        painter.drawText(inner, left, legend.title)
        painter.setFont(self._font)
        painter.setPen(QColor(self.theme.muted))
        right = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignTop
        painter.drawText(inner, right, legend.note)
        bar = QRectF(inner.left(), inner.top() + 20.0, inner.width(), BAR)
        if legend.scaled:
            self._paint_scale(painter, bar, legend.bound)
        else:
            self._paint_swatches(painter, bar)

    @property
    def card(self) -> QRectF:
        """Where the legend is."""
        scaled = self.legend is not None and self.legend.scaled
        width, height = (WIDTH, 64.0) if scaled else (0.7 * WIDTH, 48.0)
        right, bottom = self.viewport.size[0] - MARGIN, self.viewport.size[1] - MARGIN
        return QRectF(right - width, bottom - height, width, height)

    @property
    def room(self) -> tuple[float, float]:
        """Width and height that the legend takes in its corner, with a margin all around."""
        if self.legend is None:
            return 0.0, 0.0
        return self.card.width() + 2.0 * MARGIN, self.card.height() + 2.0 * MARGIN

    def _paint_scale(self, painter: QPainter, bar: QRectF, bound: float | None) -> None:
        gradient = QLinearGradient(bar.topLeft(), bar.topRight())
        for at, colour in zip(STOPS, scale(self.theme), strict=True):
            gradient.setColorAt(at, QColor(colour))
        painter.setPen(QPen(QColor(self.theme.line), 1.0))
        painter.setBrush(gradient)
        painter.drawRect(bar)
        painter.setPen(QColor(self.theme.muted))
        below = bar.translated(0.0, BAR + 3.0).adjusted(0.0, 0.0, 0.0, 6.0)
        metrics = QFontMetricsF(self._font)
        for value, text in ((0.0, "0"), (0.5, ".5"), (1.0, "1")):
            width = metrics.horizontalAdvance(text)
            x = bar.left() + value * (bar.width() - width)
            painter.drawText(QPointF(x, below.bottom()), text)
        if bound is not None and bound < 1.0:
            x = bar.left() + bound * bar.width()
            painter.setPen(QPen(QColor(self.theme.text), 2.0))
            painter.drawLine(QPointF(x, bar.top() - 3.0), QPointF(x, bar.bottom() + 3.0))

    def _paint_swatches(self, painter: QPainter, bar: QRectF) -> None:
        width = bar.width() / len(HUES)
        painter.setPen(Qt.PenStyle.NoPen)
        for number, hue in enumerate(HUES):
            painter.setBrush(QColor(hue))
            painter.drawRect(QRectF(bar.left() + number * width, bar.top(), width - 2.0, BAR))
