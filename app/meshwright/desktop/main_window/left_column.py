"""The column left of the canvas: operations, and below them the history."""

from qtpy.QtCore import QEvent, QObject, QSize, Qt
from qtpy.QtWidgets import QFrame, QScrollArea, QSizePolicy, QVBoxLayout, QWidget

from meshwright.desktop.main_window.sidebar import Section
from meshwright.desktop.widgets.basic import rule
from meshwright.graphics.theme import GRID, Theme

WIDTH = 240
LEAST = 94
"""Pixels of height that the part below keeps where the window is low."""


class HeadArea(QScrollArea):
    """As high as ``head`` where there is room; else it scrolls."""

    def __init__(self, head: QWidget) -> None:
        super().__init__()
        self._head = head
        self.setWidgetResizable(True)
        self.setFrameShape(QFrame.Shape.NoFrame)
        self.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Maximum)
        self.setWidget(head)
        head.setObjectName("LeftHead")
        head.setMinimumWidth(1)  # the column decides, not the hints of number boxes

    def sizeHint(self) -> QSize:  # noqa: N802
        """The size of the head."""
        width, head = self.width(), self._head
        height = head.heightForWidth(width) if head.hasHeightForWidth() else -1
        return QSize(head.sizeHint().width(), max(height, head.minimumSizeHint().height()))

    def minimumSizeHint(self) -> QSize:  # noqa: N802
        """A few lines."""
        return QSize(0, LEAST)

    def eventFilter(self, watched: QObject, event: QEvent) -> bool:  # noqa: N802
        """Follow what the head shows."""
        if watched is self._head and event.type() == QEvent.Type.LayoutRequest:
            self.updateGeometry()
        return super().eventFilter(watched, event)


class LeftColumn(QFrame):
    """A section at the top, or in its place ``other``; ``rest`` takes the remaining height."""

    def __init__(self, section: Section, other: Section, rest: QWidget) -> None:
        super().__init__()
        self.setObjectName("LeftColumn")
        self.setFixedWidth(WIDTH)
        self.section, self.other = section, other
        head = QWidget()
        inner = QVBoxLayout(head)
        inner.setContentsMargins(2 * GRID, 12, 2 * GRID, 12)
        inner.addWidget(section)
        inner.addWidget(other)
        other.hide()
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(0)
        self.area = HeadArea(head)
        layout.addWidget(self.area)
        layout.addWidget(rule())
        # the head shrinks only when the rest has its least height
        rest.setSizePolicy(QSizePolicy.Policy.Preferred, QSizePolicy.Policy.Ignored)
        rest.setMinimumHeight(LEAST)
        layout.addWidget(rest, 100)
        layout.addStretch(1)  # takes the height while ``rest`` is hidden

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self.section.set_theme(theme)
        self.other.set_theme(theme)

    def show_other(self, shown: bool) -> None:
        """Show the other section in place of the first one, or the first one again."""
        self.section.setVisible(not shown)
        self.other.setVisible(shown)

    def reveal(self) -> None:
        """Unfold the section."""
        self.section.heading.setChecked(True)
