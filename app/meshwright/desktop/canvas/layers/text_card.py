"""A small card of text near a place: a vertex's degree, a reason."""

from qtpy.QtCore import QObject, QPoint, QRect, QRectF, Qt, QTimer
from qtpy.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPen

from meshwright.desktop.canvas.layers.base import Layer
from meshwright.graphics.theme import Theme

CARD_SECONDS = 4.0
WIDEST = 300


class CardLayer(Layer):
    """One card at a time; refusals have the warning colour and disappear after a while."""

    def __init__(self, theme: Theme, font: QFont, parent: QObject) -> None:
        super().__init__(theme)
        self._font = QFont(font)
        self._font.setPixelSize(12)
        self._text = ""
        self._at = QPoint()
        self._warns = False
        self._fade = QTimer(parent)
        self._fade.setSingleShot(True)
        self._fade.timeout.connect(self.hide)

    @property
    def text(self) -> str:
        """The text on the card, empty if there is none."""
        return self._text

    @property
    def warning(self) -> bool:
        """True while the card shows a refusal."""
        return bool(self._text) and self._warns

    def show(self, text: str, at: QPoint, warns: bool = False, fades: bool = False) -> None:
        """A card of ``text`` near ``at``; ``warns`` for a refusal."""
        if (text, at) == (self._text, self._at):
            return
        before = self._rect()
        self._text, self._at, self._warns = text, at, warns
        self._fade.stop()
        if fades:
            self._fade.start(int(CARD_SECONDS * 1000))
        self.changed(before.united(self._rect()))

    def hide(self) -> None:
        """Hide the card."""
        self._fade.stop()
        if self._text:
            before = self._rect()
            self._text = ""
            self.changed(before)

    def paint(self, painter: QPainter, rect: QRect) -> None:
        """The card, kept inside the canvas."""
        if not self._text:
            return
        card = self._rect().adjusted(2, 2, -2, -2)
        painter.setPen(QPen(QColor(self.theme.line), 1.0))
        painter.setBrush(QColor(self.theme.warning_soft if self._warns else self.theme.raised))
        painter.drawRoundedRect(card, 6.0, 6.0)
        painter.setFont(self._font)
        painter.setPen(QColor(self.theme.warning if self._warns else self.theme.text))
        painter.drawText(card.adjusted(10, 6, -10, -6), _FLAGS, self._text)

    def _rect(self) -> QRectF:
        """Where the card is; empty without a card."""
        if not self._text:
            return QRectF()
        metrics = QFontMetricsF(self._font)
        text = metrics.boundingRect(QRectF(0, 0, WIDEST, 400), _FLAGS, self._text)
        width, height = text.width() + 26, text.height() + 18
        x = min(self._at.x() + 16.0, self.viewport.size[0] - width - 8)
        y = self._at.y() + 18.0
        if y + height > self.viewport.size[1] - 8:
            y = self._at.y() - height - 12
        return QRectF(max(x, 8.0), max(y, 8.0), width, height)


_FLAGS = int(Qt.AlignmentFlag.AlignLeft) | int(Qt.TextFlag.TextWordWrap)
