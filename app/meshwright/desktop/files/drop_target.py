"""Opening files that are dropped on the window."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from qtpy.QtCore import QEvent, QMimeData, QObject, QRectF, Qt
from qtpy.QtGui import (
    QColor,
    QDragEnterEvent,
    QDragMoveEvent,
    QDropEvent,
    QPainter,
    QPaintEvent,
    QPen,
)
from qtpy.QtWidgets import QWidget

from meshwright.graphics.theme import GRID, Theme


class DropTarget(QObject):
    """Accepts files dropped on ``window``, and calls ``open_file(path)`` with the first of them."""

    def __init__(self, window: QWidget, open_file: Callable[[str], object], theme: Theme) -> None:
        super().__init__(window)
        self._window = window
        self._open = open_file
        self.veil = DropVeil(window, theme)
        window.setAcceptDrops(True)
        window.installEventFilter(self)

    def release(self) -> None:
        """Stop accepting files."""
        self._window.removeEventFilter(self)
        self._window.setAcceptDrops(False)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        """Show the veil while a file is dragged over the window, and open it when it is dropped."""
        if isinstance(event, QDragEnterEvent):
            path = dropped(event.mimeData())
            if path:
                event.acceptProposedAction()
                self.veil.show_for(path)
            return True
        if isinstance(event, QDragMoveEvent):
            return False
        if isinstance(event, QDropEvent):
            self.veil.hide()
            path = dropped(event.mimeData())
            if path:
                event.acceptProposedAction()
                self._open(path)
            return True
        if event.type() == QEvent.Type.DragLeave:
            self.veil.hide()
            return True
        return False

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self.veil.set_theme(theme)


class DropVeil(QWidget):
    """A veil over the whole window with the name of the file that would be opened."""

    def __init__(self, window: QWidget, theme: Theme) -> None:
        super().__init__(window)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self._window = window
        self._theme = theme
        self._name = ""
        self.hide()

    @property
    def text(self) -> str:
        """The text on the veil."""
        return f"Drop to open {self._name}"

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self._theme = theme
        self.update()

    def show_for(self, path: str) -> None:
        """Cover the window with the name of this file."""
        self._name = Path(path).name
        self.setGeometry(self._window.rect())
        self.raise_()
        self.show()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802
        """Paint a dashed frame with the text in its middle."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        ground = QColor(self._theme.background)
        ground.setAlphaF(0.88)
        painter.fillRect(self.rect(), ground)
        frame = QRectF(self.rect()).adjusted(2 * GRID, 2 * GRID, -2 * GRID, -2 * GRID)
        painter.setPen(QPen(QColor(self._theme.accent), 2, Qt.PenStyle.DashLine))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawRoundedRect(frame, GRID, GRID)
        font = self.font()
        font.setPixelSize(22)
        painter.setFont(font)
        painter.setPen(QColor(self._theme.text))
        room = painter.fontMetrics().elidedText(
            self.text, Qt.TextElideMode.ElideMiddle, int(frame.width()) - 4 * GRID
        )
        painter.drawText(frame, Qt.AlignmentFlag.AlignCenter, room)
        painter.end()


def dropped(data: QMimeData) -> str:
    """The path of the first dragged file; empty if there is none."""
    return next((url.toLocalFile() for url in data.urls() if url.isLocalFile()), "")
