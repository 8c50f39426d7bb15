"""A callout: a small card with an arrow to a place in the window."""

from collections.abc import Sequence

from qtpy.QtCore import QPoint, QPointF, QRect, QRectF, Qt, Signal
from qtpy.QtGui import QColor, QPainter, QPainterPath, QPaintEvent, QPen
from qtpy.QtWidgets import QHBoxLayout, QPushButton, QVBoxLayout, QWidget

from meshwright.desktop.widgets.basic import named
from meshwright.desktop.widgets.event_filters import PanelInput
from meshwright.graphics.theme import GRID, Theme

WIDTH = 320
TIP = 12
"""Length and half width of the arrow in pixels."""
_GAP = 6
"""Pixels between the arrow's tip and what it points at."""
_SHADE = 3


class Callout(QWidget):
    """Heading, text and the buttons of a tour. It does not take the keyboard focus.

    ``step_requested(step)`` with -1 for *Back* and 1 for *Next*; ``ended()`` for *Skip* and the
    last *Done*.
    """

    step_requested = Signal(int)
    ended = Signal()

    def __init__(self, theme: Theme, parent: QWidget) -> None:
        super().__init__(parent)
        self._theme = theme
        self._window = parent
        self._side = "left"
        self._tip = QPointF()
        self.setObjectName("Callout")
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.count = named("", "Hint")
        self.heading = named("", "CalloutTitle")
        self.text = named("", "CalloutText")
        self.text.setWordWrap(True)
        self.done = named("", "CalloutDone")
        self.done.setWordWrap(True)
        self.skip = self._button("Sk&ip", "Chip", "End the tour (Alt+I); Help shows it again")
        self.back = self._button("Bac&k", "", "The previous step (Alt+K)")
        self.next = self._button("&Next", "Primary", "The next step (Alt+N)")
        self.skip.clicked.connect(lambda checked=False: self.ended.emit())
        self.back.clicked.connect(lambda checked=False: self.step_requested.emit(-1))
        self.next.clicked.connect(lambda checked=False: self.step_requested.emit(1))
        self._card = QWidget(self)
        self._card.setFixedWidth(WIDTH)
        layout = QVBoxLayout(self._card)
        layout.setContentsMargins(2 * GRID, 12, 2 * GRID, 2 * GRID)
        layout.setSpacing(6)
        line = QHBoxLayout()
        line.addWidget(self.count, 1)
        line.addWidget(self.skip)
        layout.addLayout(line)
        layout.addWidget(self.heading)
        layout.addWidget(self.text)
        layout.addWidget(self.done)
        layout.addSpacing(6)
        buttons = QHBoxLayout()
        buttons.setSpacing(GRID)
        buttons.addStretch(1)
        buttons.addWidget(self.back)
        buttons.addWidget(self.next)
        layout.addLayout(buttons)
        self._keys = PanelInput(self)
        self.hide()

    def _button(self, text: str, name: str, tooltip: str) -> QPushButton:
        made = QPushButton(text)
        made.setObjectName(name)
        made.setToolTip(tooltip)
        made.setFocusPolicy(Qt.FocusPolicy.TabFocus)  # a click leaves the focus with the canvas
        return made

    @property
    def buttons(self) -> tuple[QPushButton, ...]:
        """Its buttons in the order of Tab."""
        return self.next, self.back, self.skip

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self._theme = theme
        self.update()

    def show_step(self, number: int, total: int, heading: str, text: str, done: str = "") -> None:
        """Show step ``number`` of ``total``, from 1; ``done`` confirms that it was done."""
        self.count.setText(f"{number} of {total}")
        self.heading.setText(heading)
        self.text.setText(text)
        self.done.setText(f"\u2713 {done}" if done else "")
        self.done.setVisible(bool(done))
        self.back.setEnabled(number > 1)
        self.next.setText("Do&ne" if number == total else "&Next")
        self.setAccessibleName(heading)
        self.setAccessibleDescription(text)

    def point_at(self, target: QRect, sides: Sequence[str], within: QRect) -> None:
        """Move beside ``target``, a rectangle in the parent's pixels: to the first of ``sides``
        ("left", "right", "above", "below") with enough room in the rectangle ``within``; where none
        has, in the whole parent, and there at last to the side with most room.
        """
        self._card.adjustSize()
        width, height = self._card.width() + 2 * TIP, self._card.height() + 2 * TIP
        self.resize(width, height)
        for room in (within, self._window.rect()):
            across = room.width() >= width + 2 * GRID
            along = room.height() >= height + 2 * GRID
            rooms = {
                "left": target.left() - room.left() - width if along else 0,
                "right": room.right() - target.right() - width if along else 0,
                "above": target.top() - room.top() - height if across else 0,
                "below": room.bottom() - target.bottom() - height if across else 0,
            }
            fitting = [side for side in sides if rooms[side] >= _GAP]
            if fitting:
                break
        self._side = fitting[0] if fitting else max(rooms, key=lambda side: rooms[side])
        middle = target.center()
        if self._side in ("left", "right"):
            tip_x = target.left() - _GAP if self._side == "left" else target.right() + _GAP
            tip_y = min(max(middle.y(), room.top() + 40), room.bottom() - 40)
            x = tip_x - width if self._side == "left" else tip_x
            y = min(max(tip_y - height // 3, room.top() + GRID), room.bottom() - height - GRID)
        else:
            tip_y = target.top() - _GAP if self._side == "above" else target.bottom() + _GAP
            tip_x = min(max(middle.x(), room.left() + 40), room.right() - 40)
            y = tip_y - height if self._side == "above" else tip_y
            x = min(max(tip_x - width // 2, room.left() + GRID), room.right() - width - GRID)
        self.move(x, y)
        self._tip = QPointF(QPoint(tip_x, tip_y) - QPoint(x, y))
        self._card.move(TIP, TIP)
        self.show()
        self.raise_()
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802
        """Paint the card, its arrow and a soft shadow."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        card = QRectF(self._card.geometry())
        outline = QPainterPath()
        outline.addRoundedRect(card, GRID, GRID)
        outline = outline.united(self._arrow(card))
        shade = QColor(0, 0, 0)
        painter.setPen(Qt.PenStyle.NoPen)
        for step in range(_SHADE, 0, -1):
            shade.setAlpha(10)
            painter.setBrush(shade)
            around = card.adjusted(-step, -step + 1, step, step + 1)
            painter.drawRoundedRect(around, GRID + step, GRID + step)
        painter.setPen(QPen(QColor(self._theme.accent), 1.5))
        painter.setBrush(QColor(self._theme.raised))
        painter.drawPath(outline)
        painter.end()

    def _arrow(self, card: QRectF) -> QPainterPath:
        tip, path = self._tip, QPainterPath()
        if self._side in ("left", "right"):
            x = card.right() - 2 if self._side == "left" else card.left() + 2
            y = min(max(tip.y(), card.top() + 2 * TIP), card.bottom() - 2 * TIP)
            ends = (QPointF(x, y - TIP), QPointF(x, y + TIP))
            tip = QPointF(tip.x(), y)
        else:
            y = card.bottom() - 2 if self._side == "above" else card.top() + 2
            x = min(max(tip.x(), card.left() + 2 * TIP), card.right() - 2 * TIP)
            ends = (QPointF(x - TIP, y), QPointF(x + TIP, y))
            tip = QPointF(x, tip.y())
        path.moveTo(tip)
        path.lineTo(ends[0])
        path.lineTo(ends[1])
        path.closeSubpath()
        return path
