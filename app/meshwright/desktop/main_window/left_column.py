"""The column left of the canvas: operations, and below them the history."""

from qtpy.QtWidgets import QFrame, QVBoxLayout, QWidget

from meshwright.desktop.main_window.sidebar import Section
from meshwright.desktop.widgets.basic import rule
from meshwright.graphics.theme import GRID, Theme

WIDTH = 240


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
        layout.addWidget(head)
        layout.addWidget(rule())
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
