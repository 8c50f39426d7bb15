"""Small widgets of the panels."""

from qtpy.QtCore import QRectF, Qt, Signal
from qtpy.QtGui import QColor, QFont, QFontMetrics, QPainter, QPaintEvent
from qtpy.QtWidgets import (
    QFrame,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QToolButton,
    QWidget,
)

from meshwright.desktop.widgets import icons
from meshwright.graphics.theme import GRID, Theme


def tabular(font: QFont) -> QFont:
    """``font`` with digits of equal width, if Qt supports font features."""
    if hasattr(font, "setFeature") and hasattr(QFont, "Tag"):
        font.setFeature(QFont.Tag("tnum"), 1)
    return font


def named(text: str, name: str) -> QLabel:
    """A label with object name ``name``, by which the style sheet selects it."""
    made = QLabel(text)
    made.setObjectName(name)
    return made


def segment(title: str) -> QPushButton:
    """A checkable button of a segmented control, wide enough for its title in bold.

    The style sheet makes the title bold while the button is checked, which Qt's size hint ignores.
    """
    button = QPushButton(title)
    button.setObjectName("Segment")
    button.setCheckable(True)
    button.setAutoDefault(False)
    font = QFont(button.font())
    font.setPixelSize(13)
    font.setWeight(QFont.Weight.DemiBold)
    button.setMinimumWidth(QFontMetrics(font).horizontalAdvance(title) + 5 * GRID)
    return button


def rule() -> QFrame:
    """A thin line between two panels."""
    made = QFrame()
    made.setObjectName("Rule")
    made.setFixedHeight(1)
    return made


class ValueLine(QWidget):
    """One line with a title at the left and a value at the right."""

    def __init__(self, title: str, tooltip: str = "") -> None:
        super().__init__()
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        self._value = named("", "Value")
        self._value.setFont(tabular(self._value.font()))
        layout.addWidget(named(title, "Label"))
        layout.addStretch(1)
        layout.addWidget(self._value)
        self.setToolTip(tooltip)

    @property
    def text(self) -> str:
        """The text of the value."""
        return str(self._value.text())

    @text.setter
    def text(self, text: str) -> None:
        self._value.setText(text)


class ShareBar(QWidget):
    """A thin bar that is filled to ``share``, from 0 to 1."""

    def __init__(self, theme: Theme) -> None:
        super().__init__()
        self._theme = theme
        self._share = 0.0
        self.setFixedHeight(6)

    @property
    def share(self) -> float:
        """How much is filled."""
        return self._share

    @share.setter
    def share(self, share: float) -> None:
        self._share = min(max(share, 0.0), 1.0)
        self.update()

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self._theme = theme
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802
        """Paint the groove and the filled part."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(self._theme.pressed))
        whole = QRectF(self.rect())
        painter.drawRoundedRect(whole, 3, 3)
        if self._share > 0:
            painter.setBrush(QColor(self._theme.accent))
            filled = max(whole.width() * self._share, whole.height())
            painter.drawRoundedRect(QRectF(0, 0, filled, whole.height()), 3, 3)
        painter.end()


class ValueLink(QWidget):
    """One line like :class:`ValueLine` with a clickable value.

    ``clicked()`` only while the value leads somewhere.
    """

    clicked = Signal()

    def __init__(self, title: str, tooltip: str = "") -> None:
        super().__init__()
        self._title = title
        layout = QHBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        self._value = QPushButton()
        self._value.setObjectName("ValueLink")
        self._value.setFont(tabular(self._value.font()))
        self._value.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self._value.clicked.connect(lambda checked=False: self.clicked.emit())
        layout.addWidget(named(title, "Label"))
        layout.addStretch(1)
        layout.addWidget(self._value)
        for part in (self, self._value):
            part.setToolTip(tooltip)
        self.show_value("\u2013")

    @property
    def text(self) -> str:
        """The text of the value."""
        return str(self._value.text())

    @property
    def button(self) -> QPushButton:
        """The button that shows the value."""
        return self._value

    def show_value(self, text: str, leads: bool = False, warns: bool = False) -> None:
        """Show ``text``; ``leads``: it can be clicked; ``warns``: in the warning colour."""
        self._value.setText(f"\u26a0 {text}" if warns else text)
        self._value.setEnabled(leads)
        shape = Qt.CursorShape.PointingHandCursor if leads else Qt.CursorShape.ArrowCursor
        self._value.setCursor(shape)
        self._value.setAccessibleName(f"{self._title}: {text}")
        if self._value.property("warns") != warns:
            self._value.setProperty("warns", warns)
            self._value.style().polish(self._value)


class NoticeBar(QFrame):
    """A bar over the canvas with one sentence and a button that closes it."""

    def __init__(self, theme: Theme) -> None:
        super().__init__()
        self.setObjectName("Notice")
        layout = QHBoxLayout(self)
        layout.setContentsMargins(2 * GRID, GRID // 2, GRID, GRID // 2)
        self._text = named("", "NoticeText")
        self._text.setWordWrap(True)
        self._close = QToolButton()
        self._close.setObjectName("NoticeClose")
        self._close.setToolTip("Close this message")
        self._close.setAccessibleName("Close this message")
        self._close.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._close.clicked.connect(self.hide)
        layout.addWidget(self._text, 1)
        layout.addWidget(self._close)
        self.set_theme(theme)
        self.hide()

    @property
    def text(self) -> str:
        """The sentence, empty while the bar is hidden."""
        return str(self._text.text()) if not self.isHidden() else ""

    def show_message(self, sentence: str) -> None:
        """Show the sentence until it is closed or replaced."""
        self._text.setText(sentence)
        self.show()

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self._close.setIcon(icons.icon("close", theme))
