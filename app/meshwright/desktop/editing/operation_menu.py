"""The context menu of a half-edge: its operations, and why some are not allowed."""

from qtpy.QtCore import QPoint, Qt, Signal
from qtpy.QtGui import QCloseEvent, QKeyEvent, QMouseEvent
from qtpy.QtWidgets import QFrame, QHBoxLayout, QLabel, QVBoxLayout, QWidget

from meshwright.desktop.canvas.layers.ghost import change_colour
from meshwright.desktop.widgets.basic import tabular
from meshwright.desktop.widgets.event_filters import OwnKeys
from meshwright.document.operation_preview import OperationOffer
from meshwright.graphics.markers import label
from meshwright.graphics.theme import GRID, Theme
from meshwright_core import Operation
from meshwright_core.errors import sentence

WIDTH = 296


class OperationMenu(QFrame):
    """A popup with a row for each operation; rows of refused operations are grey and show the
    reason.

    ``chosen(operation)``: an allowed operation was chosen by mouse, arrows and Return, or its key;
    ``hovered(operation)``: the row of an allowed operation is current, None for any other row;
    ``closed()``: the menu has closed.
    """

    chosen = Signal(object)
    hovered = Signal(object)
    closed = Signal()

    def __init__(
        self,
        title: str,
        offers: tuple[OperationOffer, ...],
        theme: Theme,
        parent: QWidget,
    ) -> None:
        super().__init__(parent, Qt.WindowType.Popup | Qt.WindowType.FramelessWindowHint)
        self._frame = parent.window()
        OwnKeys(self)
        self.setObjectName("OperationMenu")
        self.setAttribute(Qt.WidgetAttribute.WA_DeleteOnClose)
        self.setFixedWidth(WIDTH)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(GRID // 2, GRID // 2, GRID // 2, GRID // 2)
        layout.setSpacing(0)
        head = QLabel(title)
        head.setObjectName("Hint")
        head.setContentsMargins(GRID, GRID // 2, GRID, GRID // 2)
        layout.addWidget(head)
        self.rows: list[OperationRow] = []
        for choice in offers:
            row = OperationRow(choice, theme, self)
            row.taken.connect(self._take)
            row.entered.connect(self._make_current)
            layout.addWidget(row)
            self.rows.append(row)
        self._current: OperationRow | None = None

    def popup(self, at: QPoint) -> None:
        """Show the menu beside the point ``at`` of the screen, within the window if it can be."""
        self.adjustSize()
        room = self._frame.geometry()
        x = min(at.x() + 3 * GRID, room.right() - self.width())
        y = min(at.y() - GRID, room.bottom() - self.height())
        self.move(max(x, room.left()), max(y, room.top()))
        self.show()

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802
        """Arrows and Return select and apply a row; the key of an operation applies it."""
        if event.key() in (Qt.Key.Key_Down, Qt.Key.Key_Up):
            self._walk(1 if event.key() == Qt.Key.Key_Down else -1)
        elif event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self._current:
            self._take(self._current.info.operation)
        else:
            for row in self.rows:
                if event.text() and event.text().upper() == row.info.key.upper():
                    self._make_current(row)
                    self._take(row.info.operation)
                    return
            super().keyPressEvent(event)

    def closeEvent(self, event: QCloseEvent) -> None:  # noqa: N802
        """Emit ``closed``."""
        super().closeEvent(event)
        self.closed.emit()

    def _walk(self, step: int) -> None:
        allowed = [row for row in self.rows if row.allowed]
        if not allowed:
            return
        at = allowed.index(self._current) if self._current in allowed else (-1 if step > 0 else 0)
        self._make_current(allowed[(at + step) % len(allowed)])

    def _make_current(self, row: "OperationRow") -> None:
        if self._current is not None:
            self._current.set_current(False)
        self._current = row
        row.set_current(True)
        self.hovered.emit(row.info.operation if row.allowed else None)

    def _take(self, operation: Operation) -> None:
        row = next(row for row in self.rows if row.info.operation == operation)
        if row.allowed:
            self.close()
            self.chosen.emit(operation)


class OperationRow(QFrame):
    """One operation: title, change of s, key, and the reason if it is not allowed."""

    taken = Signal(object)
    entered = Signal(object)

    def __init__(self, choice: OperationOffer, theme: Theme, parent: QWidget) -> None:
        super().__init__(parent)
        self.setObjectName("Row")
        self.info = info = choice.info
        self.allowed = choice.allowed
        self.reason = "" if choice.allowed else choice.verdict.reason
        self.change = "" if choice.change is None else label(choice.change)
        self.setAttribute(Qt.WidgetAttribute.WA_Hover)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(GRID, 6, GRID, 6)
        layout.setSpacing(2)
        line = QHBoxLayout()
        title = QLabel(info.title)
        title.setObjectName("RowTitle")
        key = QLabel(info.key.upper())
        key.setObjectName("Key")
        line.setSpacing(GRID)
        line.addWidget(title)
        line.addStretch(1)
        if choice.change is not None:
            change = QLabel(self.change)
            change.setFont(tabular(change.font()))
            change.setStyleSheet(f"color: {change_colour(choice.change, theme)}; font-weight: 600;")
            line.addWidget(change)
        line.addWidget(key)
        layout.addLayout(line)
        title.setEnabled(self.allowed)
        key.setEnabled(self.allowed)
        if self.reason:
            reason = QLabel(sentence(self.reason))
            reason.setObjectName("Reason")
            reason.setWordWrap(True)
            layout.addWidget(reason)
        else:
            self.setToolTip(sentence(info.summary))

    def set_current(self, current: bool) -> None:
        """Mark the row that Return would apply."""
        self.setProperty("current", current and self.allowed)
        self.style().unpolish(self)
        self.style().polish(self)

    def enterEvent(self, event: object) -> None:  # noqa: N802
        """The mouse makes a row the current one."""
        self.entered.emit(self)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """A click applies the row's operation."""
        if self.rect().contains(event.position().toPoint()):
            self.taken.emit(self.info.operation)
