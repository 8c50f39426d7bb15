"""The box or the lasso that is being drawn with the mouse."""

from qtpy.QtCore import QPointF, QRect, QRectF, Qt
from qtpy.QtGui import QColor, QPainter, QPen, QPolygonF

from meshwright.desktop.canvas.layers.base import Layer
from meshwright.graphics.theme import Theme


class BandLayer(Layer):
    """One polygon in pixels; nothing while none is drawn."""

    def __init__(self, theme: Theme) -> None:
        super().__init__(theme)
        self._outline: list[QPointF] = []

    @property
    def outline(self) -> list[QPointF]:
        """The corners in pixels."""
        return self._outline

    def show(self, outline: list[QPointF]) -> None:
        """Show this polygon; an empty list for none."""
        before = self._rect()
        self._outline = outline
        self.changed(before.united(self._rect()))

    def paint(self, painter: QPainter, rect: QRect) -> None:
        """A light tint with a dashed rim."""
        if not self._outline:
            return
        tint = QColor(self.theme.accent)
        tint.setAlpha(28)
        painter.setBrush(tint)
        painter.setPen(QPen(QColor(self.theme.accent), 1.25, Qt.PenStyle.DashLine))
        painter.drawPolygon(QPolygonF(self._outline), Qt.FillRule.OddEvenFill)

    def _rect(self) -> QRectF:
        if not self._outline:
            return QRectF()
        return QPolygonF(self._outline).boundingRect().adjusted(-3, -3, 3, 3)
