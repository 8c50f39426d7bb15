"""The history panel: the list of steps; a click goes to a state or branch."""

from typing import Any

from qtpy.QtCore import (
    QEvent,
    QModelIndex,
    QPersistentModelIndex,
    QPointF,
    QRectF,
    QSize,
    Qt,
    Signal,
)
from qtpy.QtGui import (
    QColor,
    QFont,
    QFontMetricsF,
    QKeyEvent,
    QPainter,
    QPen,
    QPolygonF,
    QResizeEvent,
)
from qtpy.QtWidgets import (
    QAbstractItemView,
    QFrame,
    QHBoxLayout,
    QHeaderView,
    QStyle,
    QStyledItemDelegate,
    QStyleOptionViewItem,
    QTableView,
    QVBoxLayout,
    QWidget,
)

from meshwright.desktop.history.history_model import HistoryLine, HistoryModel
from meshwright.desktop.widgets.basic import named, tabular
from meshwright.desktop.widgets.event_filters import OwnKeys
from meshwright.document.history import YOU, History
from meshwright.graphics.markers import label
from meshwright.graphics.theme import GRID, Theme

WIDTH = 224
ROW = 26
WALKING = (
    Qt.Key.Key_Up,
    Qt.Key.Key_Down,
    Qt.Key.Key_PageUp,
    Qt.Key.Key_PageDown,
    Qt.Key.Key_Home,
    Qt.Key.Key_End,
    Qt.Key.Key_Return,
    Qt.Key.Key_Enter,
)
GLYPH, CHANGE = 18, 26
"""Widths of two columns in pixels; numbers take what they need, the title has the rest."""


class HistoryDelegate(QStyledItemDelegate):
    """Paints one line: number, author, title, change of the score, score."""

    def __init__(self, model: HistoryModel, theme: Theme) -> None:
        super().__init__()
        self.theme = theme
        self.cursor = 0
        self._model = model
        self._number = self._score = 0.0

    def measure(self, font: QFont) -> None:
        """Fit the widths of the columns of step and score to their longest numbers."""
        highest = max(self._model.highest, 10)
        metrics = QFontMetricsF(_font(font, 12))
        self._number = metrics.horizontalAdvance(_widest(self._model.rowCount())) + 4.0
        self._score = metrics.horizontalAdvance(_widest(highest)) + GRID + 2.0

    def sizeHint(self, option: QStyleOptionViewItem, index: Any) -> QSize:  # noqa: N802
        """The size of a line; all have the same height."""
        return QSize(WIDTH - 2 * GRID, ROW)

    def paint(
        self,
        painter: QPainter,
        option: QStyleOptionViewItem,
        index: QModelIndex | QPersistentModelIndex,
    ) -> None:
        """Paint a line: the current one highlighted, undone ones pale, branches indented behind a
        fork.
        """
        line = self._model.line(index.row())
        box = QRectF(option.rect)
        current = line.branch < 0 and line.state == self.cursor
        painter.save()
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        hovered = bool(option.state & QStyle.StateFlag.State_MouseOver)
        focused = bool(option.state & QStyle.StateFlag.State_HasFocus)
        if current or hovered:
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(QColor(self.theme.accent_soft if current else self.theme.hover))
            painter.drawRoundedRect(box.adjusted(0, 1, 0, -1), 4, 4)
        if focused:
            painter.setPen(QPen(QColor(self.theme.accent), 1.0))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRoundedRect(box.adjusted(0.5, 1.5, -0.5, -1.5), 4, 4)
        if line.branch >= 0:
            self._paint_branch(painter, box, line, option.font)
        else:
            self._paint_state(painter, box, line, option.font)
        painter.restore()

    def _paint_state(self, painter: QPainter, box: QRectF, line: HistoryLine, font: QFont) -> None:
        theme, row = self.theme, line.row
        undone = line.state > self.cursor
        ink = QColor(theme.faint if undone else theme.text)
        small = _font(font, 11)
        x = box.left()
        right = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        left = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
        painter.setFont(small)
        painter.setPen(QColor(theme.faint if undone else theme.muted))
        number = QRectF(x, box.top(), self._number, box.height())
        painter.drawText(number, right, f"{line.state:,}" if line.state else "")
        edge = box.right() - GRID
        score = self._model.history.first[0] if row is None else row.after
        painter.setFont(_font(font, 12))
        painter.setPen(ink)
        place = QRectF(edge - self._score, box.top(), self._score, box.height())
        painter.drawText(place, right, f"{score:,}")
        edge -= self._score
        if row is not None and row.halfedge >= 0:
            better = row.change < 0 and not undone
            painter.setFont(_font(font, 12, bold=row.change < 0))
            painter.setPen(
                QColor(theme.accent) if better else QColor(theme.faint if undone else theme.muted)
            )
            place = QRectF(edge - CHANGE, box.top(), CHANGE, box.height())
            painter.drawText(place, right, label(row.change))
        edge -= CHANGE
        if row is not None:
            middle = QPointF(x + self._number + GLYPH / 2, box.center().y())
            _draw_author(painter, middle, row.by, ink if undone else QColor(theme.muted))
        painter.setFont(_font(font, 13))
        painter.setPen(ink)
        begin = x + self._number + GLYPH
        title = "Start" if row is None else row.title
        place = QRectF(begin, box.top(), edge - begin, box.height())
        painter.drawText(place, left, _elided(painter, title, place.width()))

    def _paint_branch(self, painter: QPainter, box: QRectF, line: HistoryLine, font: QFont) -> None:
        branch = self._model.branches[line.branch]
        ink = QColor(self.theme.accent)
        x, y = box.left() + self._number + GLYPH / 2, box.center().y()
        painter.setPen(QPen(ink, 1.4))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawPolyline(
            QPolygonF([QPointF(x, y - 7), QPointF(x, y + 1), QPointF(x + 5, y + 6)])
        )
        painter.drawLine(QPointF(x, y - 1), QPointF(x - 5, y + 4))
        painter.setFont(_font(font, 12))
        count = len(branch.rows)
        right = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        left = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
        edge = box.right() - GRID
        place = QRectF(edge - self._score, box.top(), self._score, box.height())
        painter.drawText(place, right, f"{branch.rows[-1].after:,}")
        begin = x + GLYPH / 2
        place = QRectF(begin, box.top(), edge - self._score - begin, box.height())
        words = f"Branch, {count:,} step{'' if count == 1 else 's'}"
        painter.drawText(place, left, _elided(painter, words, place.width()))


class HistoryList(QTableView):
    """The list; ``activated_at(row)`` when a row is clicked or Return is pressed.

    It is a QTableView of one column, because QListView queries every line whenever one is added.
    """

    activated_at = Signal(int)
    left = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("History")
        self.setShowGrid(False)
        self.setWordWrap(False)
        self.setTabKeyNavigation(False)
        self.setMouseTracking(True)
        across, down = self.horizontalHeader(), self.verticalHeader()
        across.hide()
        across.setSectionResizeMode(QHeaderView.ResizeMode.Stretch)
        down.hide()
        down.setMinimumSectionSize(ROW)
        down.setDefaultSectionSize(ROW)
        down.setSectionResizeMode(QHeaderView.ResizeMode.Fixed)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setSelectionMode(QAbstractItemView.SelectionMode.NoSelection)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        # by lines: a line that is cut at the top cannot be read
        self.setVerticalScrollMode(QAbstractItemView.ScrollMode.ScrollPerItem)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.setAccessibleName("History")
        OwnKeys(self, WALKING)
        self.clicked.connect(self._on_clicked)

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802
        """Return activates the focused line; other keys are handled by Qt."""
        if event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self.currentIndex().isValid():
            self.activated_at.emit(self.currentIndex().row())
        else:
            super().keyPressEvent(event)

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802
        """Keep the current state visible."""
        super().resizeEvent(event)
        self.scrollTo(self.currentIndex())

    def leaveEvent(self, event: QEvent) -> None:  # noqa: N802
        """Report that the mouse has left."""
        super().leaveEvent(event)
        self.left.emit()

    def _on_clicked(self, index: QModelIndex) -> None:
        self.activated_at.emit(index.row())


class _WholeLines(QWidget):
    """Holds ``view`` as high as its lines fill: none is cut at either end."""

    def __init__(self, view: QWidget) -> None:
        super().__init__()
        self._view = view
        view.setParent(self)

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802
        """Resize the view."""
        self._view.setGeometry(0, 0, self.width(), self.height() // ROW * ROW)


class HistoryPanel(QFrame):
    """The list with its heading; a click emits ``state_requested(state)`` or
    ``branch_requested(index)``. ``state_hovered(state)`` when the mouse is over the line of a
    state, -1 when it has left.
    """

    state_requested = Signal(int)
    branch_requested = Signal(int)
    state_hovered = Signal(int)

    def __init__(self, theme: Theme) -> None:
        super().__init__()
        self.setObjectName("HistoryPanel")
        self.model = HistoryModel()
        self.list = HistoryList()
        self.list.setModel(self.model)
        self._delegate = HistoryDelegate(self.model, theme)
        self.list.setItemDelegate(self._delegate)
        self.list.activated_at.connect(self._on_activated)
        self.list.entered.connect(self._on_entered)
        self.list.left.connect(self._on_left)
        self.count = named("", "Label")
        head = QHBoxLayout()
        head.setContentsMargins(2 * GRID, 0, 2 * GRID, 0)
        head.addWidget(named("HISTORY", "Heading"), 1)
        head.addWidget(self.count)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 2 * GRID, 0, GRID)
        layout.setSpacing(GRID)
        layout.addLayout(head)
        body = QHBoxLayout()
        body.setContentsMargins(GRID, 0, GRID // 2, 0)
        body.addWidget(_WholeLines(self.list))
        layout.addLayout(body, 1)

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self._delegate.theme = theme
        self.list.viewport().update()

    def show_history(self, history: History, empty: bool) -> None:
        """Update the list from ``history``, and scroll to the current state."""
        self.model.follow(history, empty)
        count = len(history)
        self.count.setText(f"{history.cursor:,} of {count:,}" if count else "")
        moved = self._delegate.cursor != history.cursor
        self._delegate.cursor = history.cursor
        self._delegate.measure(self.list.font())
        if not empty:
            place = self.model.index(self.model.place(history.cursor))
            self.list.setCurrentIndex(place)
            if moved:
                self.list.scrollTo(place)
        self.list.viewport().update()

    def _on_entered(self, index: QModelIndex) -> None:
        line = self.model.line(index.row())
        self.state_hovered.emit(line.state if line.branch < 0 else -1)

    def _on_left(self) -> None:
        self.state_hovered.emit(-1)

    def _on_activated(self, place: int) -> None:
        line = self.model.line(place)
        if line.branch >= 0 and self.model.current:
            self.branch_requested.emit(line.branch)
        elif line.branch < 0:
            self.state_requested.emit(line.state)


def _draw_author(painter: QPainter, middle: QPointF, by: str, ink: QColor) -> None:
    """Paint the author of a step: a ring for a person, a filled diamond for a policy."""
    if by == YOU:
        painter.setPen(QPen(ink, 1.3))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawEllipse(middle, 3.0, 3.0)
        return
    x, y, r = middle.x(), middle.y(), 4.0
    painter.setPen(Qt.PenStyle.NoPen)
    painter.setBrush(ink)
    painter.drawPolygon(
        QPolygonF([QPointF(x, y - r), QPointF(x + r, y), QPointF(x, y + r), QPointF(x - r, y)])
    )


def _widest(number: int) -> str:
    """The widest number with as many digits as ``number``."""
    return f"{10 ** len(str(number)) - 1:,}".replace("9", "0")


def _font(font: QFont, size: int, bold: bool = False) -> QFont:
    made = tabular(QFont(font))
    made.setPixelSize(size)
    if bold:
        made.setWeight(QFont.Weight.DemiBold)
    return made


def _elided(painter: QPainter, text: str, width: float) -> str:
    metrics = QFontMetricsF(painter.font())
    return str(metrics.elidedText(text, Qt.TextElideMode.ElideRight, width))
