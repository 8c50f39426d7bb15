"""What stands left of the canvas: the operations, and below them the history."""

from qtpy.QtWidgets import QFrame, QVBoxLayout, QWidget

from meshwright.desktop.main_window.sidebar import Section
from meshwright.desktop.widgets.basic import rule
from meshwright.graphics.theme import GRID, Theme

WIDTH = 232


class LeftColumn(QFrame):
    """A section at the top; :meth:`fill` puts what takes the rest of the height below it."""

    def __init__(self, section: Section) -> None:
        super().__init__()
        self.setObjectName("LeftColumn")
        self.setFixedWidth(WIDTH)
        self.section = section
        head = QWidget()
        inner = QVBoxLayout(head)
        inner.setContentsMargins(2 * GRID, 12, 2 * GRID, 12)
        inner.addWidget(section)
        self._layout = QVBoxLayout(self)
        self._layout.setContentsMargins(0, 0, 0, 0)
        self._layout.setSpacing(0)
        self._layout.addWidget(head)
        self._layout.addWidget(rule())
        self._layout.addStretch(1)  # where nothing else takes the room

    def fill(self, widget: QWidget) -> None:
        """Give ``widget`` the rest of the height."""
        self._layout.insertWidget(self._layout.count() - 1, widget, 100)

    def set_theme(self, theme: Theme) -> None:
        """Draw in other colours."""
        self.section.set_theme(theme)

    def reveal(self) -> None:
        """Unfold the section."""
        self.section.heading.setChecked(True)
