"""The sidebar: panels one above the other, each under a heading that folds it."""

from collections.abc import Sequence

from qtpy.QtCore import Qt
from qtpy.QtWidgets import QFrame, QHBoxLayout, QPushButton, QScrollArea, QVBoxLayout, QWidget

from meshwright.desktop.application.settings import Settings
from meshwright.desktop.widgets import icons
from meshwright.desktop.widgets.basic import rule
from meshwright.graphics.theme import GRID, Theme

WIDTH = 312


class Section(QWidget):
    """A heading with ``panel`` below it; a click on the heading folds the panel, and the setting is
    saved.

    ``beside`` is placed at the right of the heading, and is folded with the panel.
    """

    def __init__(
        self,
        title: str,
        panel: QWidget,
        settings: Settings,
        theme: Theme,
        beside: QWidget | None = None,
    ) -> None:
        super().__init__()
        self._settings = settings
        self._key = f"sidebar/{title.lower()}"
        self._panel = panel
        self._beside = beside
        self.heading = QPushButton(title.upper())
        self.heading.setObjectName("Fold")
        self.heading.setCheckable(True)
        self.heading.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.heading.setToolTip(f"Show or hide: {title}")
        self.heading.setAccessibleName(title)
        line = QHBoxLayout()
        line.addWidget(self.heading)
        line.addStretch(1)
        if beside is not None:
            line.addWidget(beside)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(GRID)
        layout.addLayout(line)
        layout.addWidget(panel)
        self.set_theme(theme)
        self.heading.toggled.connect(self._on_toggled)
        self.heading.setChecked(settings.flag(self._key, True))
        self._on_toggled(self.heading.isChecked())

    @property
    def panel(self) -> QWidget:
        """The panel under the heading."""
        return self._panel

    def set_theme(self, theme: Theme) -> None:
        """Draw the fold icon in the colours of ``theme``."""
        self.heading.setIcon(icons.fold(theme))

    def _on_toggled(self, shown: bool) -> None:
        self._panel.setVisible(shown)
        if self._beside is not None:
            self._beside.setVisible(shown)
        if self._settings.flag(self._key, True) != shown:
            self._settings.put(self._key, shown)


class Sidebar(QFrame):
    """A column of sections with thin lines between them, which scrolls if it does not fit."""

    def __init__(self, sections: Sequence[Section]) -> None:
        super().__init__()
        self.sections = {section.panel: section for section in sections}
        body = QWidget()
        body.setObjectName("SidebarBody")
        self._column = column = QVBoxLayout(body)
        column.setContentsMargins(3 * GRID, 12, 3 * GRID, 2 * GRID)
        column.setSpacing(12)
        for number, section in enumerate(sections):
            if number:
                column.addWidget(rule())
            column.addWidget(section)
        column.addStretch(1)
        self._area = QScrollArea()
        self._area.setWidgetResizable(True)
        self._area.setFrameShape(QFrame.Shape.NoFrame)
        self._area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self._area.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._area.setWidget(body)
        self._area.viewport().setAutoFillBackground(False)
        self.setObjectName("Sidebar")
        self.setFixedWidth(WIDTH)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.addWidget(self._area)

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        for section in self.sections.values():
            section.set_theme(theme)

    def reveal(self, panel: QWidget) -> None:
        """Unfold ``panel`` and scroll to it."""
        section = self.sections[panel]
        section.heading.setChecked(True)
        self._column.activate()
        self._area.ensureWidgetVisible(section, 0, GRID)
