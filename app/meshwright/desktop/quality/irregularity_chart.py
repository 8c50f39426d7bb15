"""The chart of irregularities: number of vertices for each irregularity."""

import numpy as np
from qtpy.QtCore import QPointF, QRectF, Qt, Signal
from qtpy.QtGui import QColor, QFont, QMouseEvent, QPainter, QPaintEvent
from qtpy.QtWidgets import QSizePolicy, QWidget

from meshwright.desktop.widgets.basic import tabular
from meshwright.desktop.widgets.event_filters import OwnTooltips
from meshwright.graphics.markers import label
from meshwright.graphics.theme import Theme

FEWEST, MOST = 2, 4
"""Columns on either side of zero; the outermost ones include all vertices beyond."""
HEIGHT = 72
_LINE = 15
"""Pixels of the numbers above the columns and of the labels below them."""
_WIDEST = 28


class IrregularityChart(QWidget):
    """Columns for vertices below their desired degree at the left, above it at the right.

    ``chosen(delta)`` when a column of some vertices is clicked; the outermost column stands for
    everything beyond it too.
    """

    chosen = Signal(int)

    def __init__(self, theme: Theme) -> None:
        super().__init__()
        OwnTooltips(self, lambda at: self.words(at.x()))
        self._theme = theme
        self._counts: dict[int, int] = {}
        self._span = FEWEST
        self._font = tabular(QFont(self.font()))
        self._font.setPixelSize(11)
        self.setFixedHeight(HEIGHT)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setMouseTracking(True)
        self.setAccessibleName("Irregular vertices by irregularity")

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self._theme = theme
        self.update()

    @property
    def counts(self) -> dict[int, int]:
        """Number of vertices of each irregularity that is not zero, as the columns show it."""
        return dict(self._counts)

    @property
    def columns(self) -> list[int]:
        """The irregularities of the columns from left to right."""
        return [d for d in range(-self._span, self._span + 1) if d]

    def show_deltas(self, deltas: np.ndarray) -> None:
        """Show the irregularities (n,) of all vertices; zeros are ignored."""
        found, numbers = np.unique(deltas[deltas != 0], return_counts=True)
        furthest = int(np.abs(found).max(initial=0))
        self._span = min(max(furthest, FEWEST), MOST)
        self._counts = {}
        for delta, number in zip(found.tolist(), numbers.tolist(), strict=True):
            column = min(max(delta, -self._span), self._span)
            self._counts[column] = self._counts.get(column, 0) + number
        self.setAccessibleDescription(
            ", ".join(f"{self._name(d)}: {n:,}" for d, n in sorted(self._counts.items())) or "none"
        )
        self.update()

    def clear(self) -> None:
        """Show no columns."""
        self.show_deltas(np.empty(0, dtype=int))

    def column(self, delta: int) -> QRectF:
        """The area of the column of ``delta``, with its number and label."""
        columns = self.columns
        width = self.width() / len(columns)
        return QRectF(columns.index(delta) * width, 0.0, width, self.height())

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802
        """Paint numbers, columns and labels."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setFont(self._font)
        room = self.height() - 2 * _LINE
        base = self.height() - _LINE
        most = max(self._counts.values(), default=1)
        for delta in self.columns:
            place, number = self.column(delta), self._counts.get(delta, 0)
            if number:
                height = max(2.0, room * number / most)
                wide = min(place.width() - 6.0, _WIDEST)
                bar = QRectF(place.center().x() - wide / 2, base - height, wide, height)
                colour = self._theme.plus if delta > 0 else self._theme.minus
                painter.setPen(Qt.PenStyle.NoPen)
                painter.setBrush(QColor(colour))
                painter.drawRoundedRect(bar, 1.5, 1.5)
                painter.setPen(QColor(self._theme.text))
                above = QRectF(place.x(), bar.y() - _LINE, place.width(), _LINE)
                painter.drawText(above, Qt.AlignmentFlag.AlignCenter, short(number))
            painter.setPen(QColor(self._theme.muted if number else self._theme.faint))
            below = QRectF(place.x(), base, place.width(), _LINE)
            painter.drawText(below, Qt.AlignmentFlag.AlignCenter, self._name(delta))
        painter.setPen(QColor(self._theme.line))
        painter.drawLine(QPointF(0, base + 0.5), QPointF(self.width(), base + 0.5))
        painter.end()

    def words(self, x: float) -> str:
        """What the column at pixel ``x`` stands for."""
        delta = self._at(x)
        number = self._counts.get(delta, 0)
        vertices = "1 vertex" if number == 1 else f"{number:,} vertices"
        words = f"{vertices} with \u0394 {self._name(delta)}"
        return f"{words}; click to go from one to the next" if number else words

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """Show the hand cursor over columns that can be clicked."""
        clickable = self._counts.get(self._at(event.position().x()), 0) > 0
        shape = Qt.CursorShape.PointingHandCursor if clickable else Qt.CursorShape.ArrowCursor
        self.setCursor(shape)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """A click chooses the column."""
        delta = self._at(event.position().x())
        if self._counts.get(delta, 0) and self.rect().contains(event.position().toPoint()):
            self.chosen.emit(delta)

    def _at(self, x: float) -> int:
        columns = self.columns
        place = int(x / max(self.width(), 1) * len(columns))
        return columns[min(max(place, 0), len(columns) - 1)]

    def _name(self, delta: int) -> str:
        """The column's label; those of the outermost ones mark that they include more."""
        if abs(delta) < MOST:
            return label(delta)
        return f"\u2264{label(delta)}" if delta < 0 else f"\u2265{label(delta)}"


def short(number: int) -> str:
    """``number`` in at most four characters: 876, 9.8k, 12k, 3.4M."""
    if number < 1000:
        return f"{number}"
    if number < 9950:
        return f"{number / 1000:.1f}k"
    if number < 1_000_000:
        return f"{number / 1000:.0f}k"
    return f"{number / 1_000_000:.1f}M"
