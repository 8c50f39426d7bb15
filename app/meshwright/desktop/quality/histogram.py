"""The histogram of a quality measure over the elements, with the inverted ones apart."""

from qtpy.QtCore import QPointF, QRectF, Qt
from qtpy.QtGui import QBrush, QColor, QFont, QPainter, QPaintEvent, QPen, QPolygonF
from qtpy.QtWidgets import QSizePolicy, QWidget

from meshwright.desktop.quality.irregularity_chart import short
from meshwright.desktop.widgets.basic import tabular
from meshwright.desktop.widgets.event_filters import OwnTooltips
from meshwright.document.quality_summary import Spread
from meshwright.graphics.theme import Theme

HEIGHT = 72
_AXIS = 18
"""Pixels below the columns for the mark of the worst element and the numbers."""
_ASIDE = 22
"""Pixels at the left for the column of inverted elements."""


class Histogram(QWidget):
    """Columns of a :class:`~meshwright.document.quality_summary.Spread`; a triangle points at the
    worst value.

    Inverted elements are a hatched column of their own at the left. ``stale`` values are pale.
    """

    def __init__(self, theme: Theme) -> None:
        super().__init__()
        OwnTooltips(self, lambda at: self.words(at.x()))
        self._theme = theme
        self._spread: Spread | None = None
        self._inverted = 0
        self._unit = ""
        self._stale = False
        self._font = tabular(QFont(self.font()))
        self._font.setPixelSize(10)
        self.setFixedHeight(HEIGHT)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setMouseTracking(True)
        self.setAccessibleName("Quality histogram")

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self._theme = theme
        self.update()

    @property
    def stale(self) -> bool:
        """Whether the values are those of an earlier state of the mesh."""
        return self._stale

    @stale.setter
    def stale(self, stale: bool) -> None:
        if stale != self._stale:
            self._stale = stale
            self.update()

    def show_spread(self, spread: Spread | None, inverted: int = 0, unit: str = "") -> None:
        """Show ``spread``, or an empty axis; ``unit`` follows the numbers."""
        self._spread, self._inverted, self._unit = spread, inverted, unit
        self.update()

    def words(self, x: float) -> str:
        """The description of the column at pixel ``x``."""
        if self._spread is None:
            return ""
        if x < _ASIDE:
            noun = "element" if self._inverted == 1 else "elements"
            return f"{self._inverted:,} inverted {noun}"
        bins = len(self._spread.counts)
        number = int((x - _ASIDE) / max(self.width() - _ASIDE, 1) * bins)
        number = min(max(number, 0), bins - 1)
        count = int(self._spread.counts[number])
        low, high = (self._number(value) for value in self._spread.edges(number))
        return f"{low} to {high}: {count:,} {'element' if count == 1 else 'elements'}"

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802
        """Paint the columns, the axis and the mark."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setFont(self._font)
        base = self.height() - _AXIS
        across = QRectF(_ASIDE, 0.0, self.width() - _ASIDE, base)
        if self._spread is not None:
            painter.setOpacity(0.35 if self._stale else 1.0)
            self._paint_columns(painter, across, self._spread)
            self._paint_inverted(painter, base)
            painter.setOpacity(1.0)
        painter.setPen(QColor(self._theme.line))
        painter.drawLine(QPointF(_ASIDE, base + 0.5), QPointF(self.width(), base + 0.5))
        if self._spread is not None:
            self._paint_axis(painter, across, self._spread)
        painter.end()

    def _paint_columns(self, painter: QPainter, across: QRectF, spread: Spread) -> None:
        most = max(int(spread.counts.max(initial=0)), self._inverted, 1)
        width = across.width() / len(spread.counts)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(self._theme.edge))
        for number, count in enumerate(spread.counts.tolist()):
            if count:
                height = max(2.0, (across.height() - 2.0) * count / most)
                left = across.x() + number * width
                painter.drawRect(QRectF(left + 0.5, across.height() - height, width - 1, height))

    def _paint_inverted(self, painter: QPainter, base: float) -> None:
        if not self._inverted or self._spread is None:
            return
        most = max(int(self._spread.counts.max(initial=0)), self._inverted, 1)
        height = max(6.0, (base - 14.0) * self._inverted / most)
        bar = QRectF(1.0, base - height, _ASIDE - 10.0, height)
        warning = QColor(self._theme.warning)
        painter.setPen(QPen(warning, 1.0))
        painter.setBrush(QBrush(warning, Qt.BrushStyle.BDiagPattern))
        painter.drawRect(bar)
        painter.setPen(warning)
        box = QRectF(0.0, bar.y() - 13.0, _ASIDE + 20.0, 12.0)
        painter.drawText(box, Qt.AlignmentFlag.AlignLeft, short(self._inverted))

    def _paint_axis(self, painter: QPainter, across: QRectF, spread: Spread) -> None:
        painter.setPen(QColor(self._theme.muted))
        base = across.height()
        sides = (
            (0.0, Qt.AlignmentFlag.AlignLeft),
            (0.5, Qt.AlignmentFlag.AlignHCenter),
            (1.0, Qt.AlignmentFlag.AlignRight),
        )
        for share, side in sides:
            value = self._number(spread.low + share * (spread.high - spread.low))
            box = QRectF(across.x(), base + 5.0, across.width(), _AXIS - 5.0)
            painter.drawText(box, side | Qt.AlignmentFlag.AlignVCenter, value)
        if spread.low <= spread.worst <= spread.high:
            share = (spread.worst - spread.low) / (spread.high - spread.low)
            x = across.x() + share * across.width()
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(QColor(self._theme.text))
            tip = (QPointF(x, base + 1), QPointF(x - 3.5, base + 6), QPointF(x + 3.5, base + 6))
            painter.drawPolygon(QPolygonF(list(tip)))

    def _number(self, value: float) -> str:
        return f"{value:g}{self._unit}" if self._unit else f"{value:.3g}"
