"""The command palette: every action of the table, found by a few typed letters."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby

from qtpy.QtCore import (
    QEvent,
    QModelIndex,
    QObject,
    QPersistentModelIndex,
    QRect,
    QSize,
    Qt,
    Signal,
)
from qtpy.QtGui import (
    QColor,
    QFocusEvent,
    QFont,
    QFontMetrics,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPen,
)
from qtpy.QtWidgets import (
    QApplication,
    QFrame,
    QLineEdit,
    QListWidget,
    QListWidgetItem,
    QStyle,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QVBoxLayout,
    QWidget,
)

from meshwright.desktop.help.fuzzy_match import match
from meshwright.desktop.widgets.basic import named
from meshwright.graphics.theme import GRID, Theme

WIDTH = 560
ROW = 34
ROWS = 10
"""Number of rows that are visible at once."""
_ELSEWHERE = 12.0
"""How much lower a match of menu and title is ranked than one of the title alone."""
_ENTRY = int(Qt.ItemDataRole.UserRole)
_PLACES = _ENTRY + 1


@dataclass(frozen=True)
class PaletteEntry:
    """One row: an action's id, title, menu, shortcut, and the reason if it is disabled."""

    id: str
    title: str
    menu: str
    key: str = ""
    reason: str = ""
    tooltip: str = ""


def rank(query: str, entries: Sequence[PaletteEntry]) -> list[tuple[PaletteEntry, tuple[int, ...]]]:
    """The entries that match ``query``, best first, each with the matched positions in its title.
    Disabled ones come after equally good ones.
    """
    found: list[tuple[float, int, PaletteEntry, tuple[int, ...]]] = []
    for number, entry in enumerate(entries):
        here = match(query, entry.title)
        there = match(query, f"{entry.menu} {entry.title}")
        words = query.strip().lower()
        if here is not None:
            score, places = here.score, here.places
        elif there is not None:
            score, places = there.score - _ELSEWHERE, ()
        elif len(words) > 2 and words in entry.tooltip.lower():
            score, places = 0.0, ()
        else:
            continue
        found.append((score - (2.0 if entry.reason else 0.0), -number, entry, places))
    if query.strip():
        found.sort(key=lambda row: row[:2], reverse=True)
    return [(entry, places) for _, _, entry, places in found]


class CommandPalette(QFrame):
    """A box over the window that has the keyboard focus until it is closed.

    ``chosen(id)`` for an entry that is enabled; ``closed()``. It is a child widget, not a window,
    so that it does not depend on a window manager.
    """

    chosen = Signal(str)
    closed = Signal()

    def __init__(self, entries: Sequence[PaletteEntry], theme: Theme, parent: QWidget) -> None:
        super().__init__(parent)
        self._entries = list(entries)
        self._window = parent
        self._before = QApplication.focusWidget()
        self.setObjectName("Palette")
        self.field = QLineEdit()
        self.field.setObjectName("PaletteField")
        self.field.setPlaceholderText("Search commands")
        self.field.setAccessibleName("Search for a command")
        self.list = QListWidget()
        self.list.setObjectName("PaletteList")
        self.list.setAccessibleName("Commands")
        self.list.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.list.setItemDelegate(_Row(theme, self.list))
        self.list.setMouseTracking(True)
        self.list.setUniformItemSizes(True)
        self.nothing = named("No matching command.", "Hint")
        self.nothing.setContentsMargins(GRID, GRID, GRID, GRID)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(GRID, GRID, GRID, GRID)
        layout.setSpacing(GRID)
        layout.addWidget(self.field)
        layout.addWidget(self.list)
        layout.addWidget(self.nothing)
        self.field.textChanged.connect(self._fill)
        self.list.itemClicked.connect(self._take)
        self.list.viewport().installEventFilter(self)
        self.field.installEventFilter(self)
        parent.installEventFilter(self)
        self._fill("")

    @property
    def shown(self) -> list[PaletteEntry]:
        """The entries in the list, from the top."""
        return [self.list.item(row).data(_ENTRY) for row in range(self.list.count())]

    def popup(self) -> None:
        """Show the box and give it the keyboard focus."""
        self._place()
        self.show()
        self.raise_()
        self.field.setFocus(Qt.FocusReason.PopupFocusReason)

    def dismiss(self) -> None:
        """Close the box and give the keyboard focus back."""
        if self.isHidden():
            return
        self.field.removeEventFilter(self)
        self._window.removeEventFilter(self)
        self.hide()
        if self._before is not None:
            self._before.setFocus(Qt.FocusReason.PopupFocusReason)
        self.closed.emit()
        self.deleteLater()

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        """Handle keys that select and choose; follow the window's size; close when the focus is
        lost.
        """
        if watched is self._window:
            if event.type() == QEvent.Type.Resize:
                self._place()
            return False
        kind = event.type()
        if watched is self.list.viewport():
            # rows that scroll past a resting mouse are not chosen
            if isinstance(event, QMouseEvent) and kind == QEvent.Type.MouseMove:
                self._on_hovered(event)
            return False
        if isinstance(event, QKeyEvent) and _is_ours(event):
            if kind == QEvent.Type.ShortcutOverride:
                event.accept()  # else a shortcut of the window would take it
                return True
            if kind == QEvent.Type.KeyPress:
                self._on_key(event.key())
                return True
        if (
            isinstance(event, QFocusEvent)
            and kind == QEvent.Type.FocusOut
            and event.reason() not in _ELSEWHERE_FOR_NOW
        ):
            self._before = None  # the user has moved the focus
            self.dismiss()
        return False

    def _on_hovered(self, event: QMouseEvent) -> None:
        item = self.list.itemAt(event.position().toPoint())
        if item is not None:
            self.list.setCurrentItem(item)

    def _on_key(self, key: int) -> None:
        step = _STEPS.get(key, 0)
        if key == Qt.Key.Key_Escape:
            self.dismiss()
        elif step and self.list.count():
            row = self.list.currentRow() + step
            if abs(step) == 1:
                row %= self.list.count()
            self.list.setCurrentRow(min(max(row, 0), self.list.count() - 1))
        elif not step and self.list.currentItem() is not None:
            self._take(self.list.currentItem())

    def _take(self, item: QListWidgetItem) -> None:
        entry = item.data(_ENTRY)
        if not entry.reason:
            self.dismiss()
            self.chosen.emit(entry.id)

    def _fill(self, query: str) -> None:
        self.list.clear()
        for entry, places in rank(query, self._entries):
            item = QListWidgetItem(entry.title, self.list)
            item.setSizeHint(QSize(0, ROW))
            item.setData(_ENTRY, entry)
            item.setData(_PLACES, places)
            item.setToolTip(entry.tooltip)
            item.setData(
                Qt.ItemDataRole.AccessibleDescriptionRole, entry.reason or entry.key or entry.menu
            )
        self.list.setCurrentRow(0)
        self.list.setVisible(self.list.count() > 0)
        self.nothing.setVisible(self.list.count() == 0)
        self.list.setFixedHeight(ROW * min(max(self.list.count(), 1), ROWS))
        self._place()

    def _place(self) -> None:
        """Place the box in the middle, near the top."""
        room = self._window.rect()
        self.setFixedWidth(min(WIDTH, room.width() - 4 * GRID))
        self.adjustSize()
        self.move((room.width() - self.width()) // 2, min(12 * GRID, room.height() // 6))


_STEPS = {
    int(Qt.Key.Key_Down): 1,
    int(Qt.Key.Key_Up): -1,
    int(Qt.Key.Key_PageDown): ROWS - 1,
    int(Qt.Key.Key_PageUp): 1 - ROWS,
}
_ELSEWHERE_FOR_NOW = (Qt.FocusReason.PopupFocusReason, Qt.FocusReason.ActiveWindowFocusReason)
_OTHERS = (Qt.Key.Key_Escape, Qt.Key.Key_Return, Qt.Key.Key_Enter)


def _is_ours(event: QKeyEvent) -> bool:
    return event.key() in _STEPS or event.key() in _OTHERS


class _Row(QStyledItemDelegate):
    """Title with the matched letters, menu, and at the right the shortcut or the reason."""

    def __init__(self, theme: Theme, parent: QObject) -> None:
        super().__init__(parent)
        self._theme = theme

    def paint(
        self,
        painter: QPainter,
        option: QStyleOptionViewItem,
        index: QModelIndex | QPersistentModelIndex,
    ) -> None:
        """Paint one row."""
        entry, places = index.data(_ENTRY), index.data(_PLACES)
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        box = option.rect
        if option.state & QStyle.StateFlag.State_Selected:
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(QColor(self._theme.accent_soft))
            painter.drawRoundedRect(box, 6, 6)
        inside = box.adjusted(12, 0, -12, 0)
        ink = self._theme.faint if entry.reason else self._theme.text
        x = self._paint_title(painter, inside, entry.title, places, QColor(ink), option.font)
        small = QFont(option.font)
        small.setPixelSize(12)
        painter.setFont(small)
        painter.setPen(QColor(self._theme.faint if entry.reason else self._theme.muted))
        rest = QRect(x + 12, inside.y(), max(inside.right() - x - 12, 0), inside.height())
        painter.drawText(rest, _LEFT, entry.menu)
        if entry.reason:
            painter.setPen(QColor(self._theme.muted))
            painter.drawText(rest, _RIGHT, entry.reason)
        elif entry.key:
            self._paint_key(painter, inside, entry.key, small)
        painter.restore()

    def _paint_title(
        self,
        painter: QPainter,
        box: QRect,
        title: str,
        places: tuple[int, ...],
        ink: QColor,
        font: QFont,
    ) -> int:
        """Paint the title with matched letters in bold; returns the x coordinate of its end."""
        bold = QFont(font)
        bold.setWeight(QFont.Weight.Bold)
        x = box.x()
        for is_meant, run in groupby(range(len(title)), lambda place: place in places):
            letters = "".join(title[place] for place in run)
            painter.setFont(bold if is_meant else font)
            painter.setPen(QColor(self._theme.accent) if is_meant else ink)
            painter.drawText(QRect(x, box.y(), box.width(), box.height()), _LEFT, letters)
            x += QFontMetrics(bold if is_meant else font).horizontalAdvance(letters)
        return x

    def _paint_key(self, painter: QPainter, box: QRect, key: str, font: QFont) -> None:
        width = QFontMetrics(font).horizontalAdvance(key) + 14
        chip = QRect(box.right() - width, box.center().y() - 10, width, 21)
        painter.setPen(QPen(QColor(self._theme.line), 1.0))
        painter.setBrush(QColor(self._theme.raised))
        painter.drawRoundedRect(chip, 4, 4)
        painter.setPen(QColor(self._theme.muted))
        painter.drawText(chip, Qt.AlignmentFlag.AlignCenter, key)


_LEFT = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
_RIGHT = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
