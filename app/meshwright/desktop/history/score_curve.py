"""The score curve: s of every state, the current state, and the branches."""

import numpy as np
from qtpy.QtCore import QPointF, QRectF, QSize, Qt, Signal
from qtpy.QtGui import (
    QColor,
    QFont,
    QFontMetricsF,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPaintEvent,
    QPen,
    QPixmap,
    QPolygonF,
    QResizeEvent,
    QWheelEvent,
)
from qtpy.QtWidgets import QSizePolicy, QWidget

from meshwright.desktop.widgets.basic import tabular
from meshwright.desktop.widgets.event_filters import OwnKeys
from meshwright.desktop.widgets.wording import branch_words, step_words
from meshwright.document import score_series
from meshwright.document.branches import Branches
from meshwright.document.history import History
from meshwright.document.score_series import ScoreSeries
from meshwright.graphics.theme import GRID, Theme

HEIGHT = 96
LEFT, RIGHT, TOP, BOTTOM = 7 * GRID, 3 * GRID, 16, 36
WALKING = (
    Qt.Key.Key_Left,
    Qt.Key.Key_Right,
    Qt.Key.Key_PageUp,
    Qt.Key.Key_PageDown,
    Qt.Key.Key_Home,
    Qt.Key.Key_End,
)
"""Keys that go back and forward by one step, by many, and to the ends."""
FORK_REACH = 7
"""Distance in pixels at which the mark of a branch counts as under the mouse."""


class ScoreCurve(QWidget):
    """Paints a history. A click or drag emits ``state_requested(state)``, a wheel turn or key
    ``step_requested(steps)``, a click on the mark of a branch ``branch_requested(index)``.

    The curve is kept in a pixmap that is drawn again only when the history, the size or the colours
    change; the cursor and what is under the mouse are painted over it.
    """

    state_requested = Signal(int)
    step_requested = Signal(int)
    branch_requested = Signal(int)

    def __init__(self, theme: Theme) -> None:
        super().__init__()
        self.setFixedHeight(HEIGHT)
        self.setMinimumWidth(160)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.setAccessibleName("Score curve of the history")
        OwnKeys(self, WALKING)
        self.cursor_state = 0
        self.hovered = -1
        self.builds = 0
        """How often the pixmap has been drawn."""
        self._theme = theme
        self._history = History(0, 0)
        self._branches: Branches = ()
        self._empty = True
        self._track = ScoreSeries()
        self._frame = score_series.frame(np.empty(0), np.empty(0), 0, 0, 1, 1)
        self._best = 0
        self._forks: list[float] = []
        self._fork = -1
        self._still: QPixmap | None = None
        self._font = tabular(QFont(self.font()))
        self._font.setPixelSize(11)

    # Content

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self._theme = theme
        self._redraw()

    def show_history(self, history: History, empty: bool) -> None:
        """Update the curve from ``history``; ``empty``: there is no mesh."""
        fresh = self._track.follow(history)
        branches = history.branches
        same = history is self._history and empty == self._empty and branches is self._branches
        self._history, self._branches, self._empty = history, branches, empty
        if self.hovered >= len(self._track.scores):
            self.hovered = -1  # the hovered state no longer exists
        if not same:
            self._fork = -1  # the marks of branches have moved
        if not same or fresh < len(self._track.scores):
            self._redraw()
        self.set_cursor(history.cursor)

    def set_cursor(self, state: int) -> None:
        """Mark ``state`` as the current one."""
        self.cursor_state = state
        self.setAccessibleDescription(self._words(state))
        self.update()

    def _redraw(self) -> None:
        self._still = None
        self.update()

    def sizeHint(self) -> QSize:  # noqa: N802
        """The preferred size."""
        return QSize(640, HEIGHT)

    # Mouse and keys

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """Go to the state under the mouse, or to the branch whose mark is there."""
        if event.button() != Qt.MouseButton.LeftButton or self._empty:
            return
        self.setFocus(Qt.FocusReason.MouseFocusReason)
        fork = self._fork_at(event.position())
        if fork >= 0 and self._branches is self._history.branches:
            self.branch_requested.emit(fork)
        elif fork < 0:
            self._ask(event.position())

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """Show what is under the mouse; with the button down go there."""
        at = event.position()
        pressed = bool(event.buttons() & Qt.MouseButton.LeftButton)
        fork = -1 if pressed else self._fork_at(at)
        hovered = -1 if self._empty or fork >= 0 else self._frame.state(at.x())
        if (hovered, fork) != (self.hovered, self._fork):
            self.hovered, self._fork = hovered, fork
            pointing = Qt.CursorShape.PointingHandCursor
            self.setCursor(pointing if fork >= 0 else Qt.CursorShape.ArrowCursor)
            self.update()
        if pressed and not self._empty:
            self._ask(at)

    def leaveEvent(self, event: object) -> None:  # noqa: N802
        """Hover nothing."""
        self.hovered = self._fork = -1
        self.update()

    def wheelEvent(self, event: QWheelEvent) -> None:  # noqa: N802
        """One step back or forward for each notch."""
        turn = event.angleDelta().y() or event.angleDelta().x()
        if turn and not self._empty:
            self.step_requested.emit(1 if turn < 0 else -1)
        event.accept()

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802
        """Arrows, page keys, Home and End walk through the history."""
        if event.key() not in WALKING or event.modifiers() or self._empty:
            super().keyPressEvent(event)
            return
        page = max(1, len(self._history) // 20)
        whole = len(self._history)
        self.step_requested.emit((-1, 1, -page, page, -whole, whole)[WALKING.index(event.key())])

    def _ask(self, at: QPointF) -> None:
        state = min(self._frame.state(at.x()), len(self._history))
        if state != self.cursor_state:
            self.set_cursor(state)  # the cursor follows the mouse at once, the mesh later
            self.state_requested.emit(state)

    def _fork_at(self, at: QPointF) -> int:
        """The branch whose mark is at this place, -1 for none."""
        if not 0 <= at.y() - (self.height() - BOTTOM) <= 18 or not self._forks:
            return -1
        distance = np.abs(np.array(self._forks) - at.x())
        nearest = int(np.argmin(distance))
        return nearest if distance[nearest] <= FORK_REACH else -1

    # Painting

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802
        """Drop the pixmap."""
        self._still = None

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802
        """Paint the pixmap, and over it the veil on undone steps, the cursor and the
        hovered state.
        """
        if self._still is None or self._still.devicePixelRatio() != self.devicePixelRatioF():
            self._still = self._draw()
        painter = QPainter(self)
        painter.drawPixmap(0, 0, self._still)
        if self._empty:
            painter.end()
            return
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setFont(self._font)
        states = len(self._track.scores)
        # the mouse may have moved after the history has become shorter, and before this frame
        self.hovered = min(self.hovered, states - 1)
        self._fork = min(self._fork, len(self._forks) - 1)
        here = min(self.cursor_state, states - 1)
        x = float(self._frame.x(here))
        if here < states - 1:
            veil = QColor(self._theme.panel)
            veil.setAlphaF(0.65)
            bottom = self.height() - BOTTOM
            painter.fillRect(QRectF(x, 2, self.width() - x, bottom), veil)
        if self.hovered >= 0:
            self._paint_mark(painter, self.hovered, self._theme.muted, 3.0)
        self._paint_mark(painter, here, self._theme.accent, 4.5)
        if self._fork >= 0:
            self._paint_words(painter, self._forks[self._fork], self._fork_words())
        elif self.hovered >= 0:
            at = float(self._frame.x(self.hovered))
            self._paint_words(painter, at, self._words(self.hovered))
        if self.hasFocus():
            painter.setPen(QPen(QColor(self._theme.accent), 1.0))
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.drawRoundedRect(QRectF(self.rect()).adjusted(1.5, 1.5, -1.5, -1.5), 4, 4)
        painter.end()

    def _paint_mark(self, painter: QPainter, state: int, colour: str, radius: float) -> None:
        x = float(self._frame.x(state))
        y = float(self._frame.y(self._track.scores[state]))
        painter.setPen(QPen(QColor(colour), 1.0))
        painter.drawLine(QPointF(x, TOP - 4), QPointF(x, self.height() - BOTTOM + 4))
        painter.setPen(QPen(QColor(self._theme.panel), 1.5))
        painter.setBrush(QColor(colour))
        painter.drawEllipse(QPointF(x, y), radius, radius)

    def _paint_words(self, painter: QPainter, x: float, words: str) -> None:
        """Paint a small card with ``words`` at the upper edge near ``x``, inside the widget."""
        width = QFontMetricsF(self._font).horizontalAdvance(words) + 2 * GRID
        left = min(max(x - width / 2, 2.0), max(self.width() - width - 2.0, 2.0))
        box = QRectF(left, 1.5, width, 18)
        painter.setPen(QPen(QColor(self._theme.line), 1.0))
        painter.setBrush(QColor(self._theme.raised))
        painter.drawRoundedRect(box, 4, 4)
        painter.setPen(QColor(self._theme.text))
        painter.drawText(box, Qt.AlignmentFlag.AlignCenter, words)

    def _draw(self) -> QPixmap:
        """Draw everything that does not depend on mouse and cursor."""
        self.builds += 1
        ratio = self.devicePixelRatioF()
        made = QPixmap(self.size() * ratio)
        made.setDevicePixelRatio(ratio)
        made.fill(QColor(self._theme.panel))
        if self._empty:
            return made
        scores, optima = self._track.scores, self._track.optima
        width, height = self.width() - LEFT - RIGHT, self.height() - TOP - BOTTOM
        self._frame = score_series.frame(scores, optima, LEFT, TOP, max(width, 1), height)
        self._best = score_series.best_state(scores, optima)
        painter = QPainter(made)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setFont(self._font)
        self._draw_levels(painter)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(
            QPen(QColor(self._theme.muted), 1.2, Qt.PenStyle.DashLine, Qt.PenCapStyle.FlatCap)
        )
        painter.drawPolyline(_polygon(score_series.steps(optima, self._frame)))
        # a wider pen is fifty times slower, and would fill the space between many steps
        thin = len(scores) > self._frame.width
        painter.setPen(QPen(QColor(self._theme.accent), 1.0 if thin else 1.8))
        painter.drawPolyline(_polygon(score_series.steps(scores, self._frame)))
        if self._frame.broken:
            painter.setPen(QPen(QColor(self._theme.muted), 1.2))
            for begin, end in score_series.break_mark(self._frame).tolist():
                painter.drawLine(QPointF(*begin), QPointF(*end))
        self._draw_best(painter)
        self._draw_forks(painter)
        painter.end()
        return made

    def _draw_levels(self, painter: QPainter) -> None:
        """Draw the highest score and the optimum beside the curve, the number of steps below it."""
        high, low = int(self._frame.high), int(self._track.optima[-1])
        painter.setPen(QPen(QColor(self._theme.line), 1.0))
        top = float(self._frame.y(high))
        painter.drawLine(QPointF(LEFT, top), QPointF(self.width() - RIGHT, top))
        painter.setPen(QColor(self._theme.muted))
        right = int(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)
        for value in (high, low):
            y = float(self._frame.y(value))
            painter.drawText(QRectF(0, y - 8, LEFT - GRID, 16), right, f"{value:,}")
        below = QRectF(LEFT, self.height() - 19, self.width() - LEFT - RIGHT, 16)
        count = len(self._history)
        steps = f"{count:,} step{'' if count == 1 else 's'}" if count else "No steps yet"
        painter.drawText(below, right, steps)
        left = int(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        painter.drawText(
            below, left, "s, and the optimum s* (dashed)" if self.width() > 520 else "s"
        )

    def _draw_best(self, painter: QPainter) -> None:
        """Draw a diamond around the best state, if there are steps."""
        if len(self._history) == 0:
            return
        x = float(self._frame.x(self._best))
        y = float(self._frame.y(self._track.scores[self._best]))
        painter.setPen(QPen(QColor(self._theme.accent), 1.5))
        painter.setBrush(QColor(self._theme.panel))
        r = 5.5
        painter.drawPolygon(
            QPolygonF([QPointF(x, y - r), QPointF(x + r, y), QPointF(x, y + r), QPointF(x - r, y)])
        )

    def _draw_forks(self, painter: QPainter) -> None:
        """Draw a small fork below the curve where each branch begins."""
        painter.setPen(QPen(QColor(self._theme.text), 1.4))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        self._forks = [float(self._frame.x(branch.at)) for branch in self._branches]
        base = self.height() - BOTTOM + 3.0
        for x in self._forks:
            painter.drawPolyline(
                QPolygonF([QPointF(x, base), QPointF(x, base + 4), QPointF(x + 5, base + 10)])
            )
            painter.drawLine(QPointF(x, base + 4), QPointF(x - 5, base + 10))

    def _fork_words(self) -> str:
        return branch_words(self._branches[self._fork].rows)

    def _words(self, state: int) -> str:
        if state == 0:
            return f"Start:  s {self._history.first[0]:,}"
        if state > len(self._history):
            return ""
        row = self._history[state - 1]
        best = "  (best)" if state == self._best else ""
        return f"{state:,}  {step_words(row)}:  s {row.after:,}{best}"


def _polygon(points: np.ndarray) -> QPolygonF:
    return QPolygonF([QPointF(x, y) for x, y in points.tolist()])
