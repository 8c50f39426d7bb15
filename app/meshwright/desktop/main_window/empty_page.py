"""The page shown while there is no mesh."""

from collections.abc import Callable
from functools import partial
from pathlib import Path

from qtpy.QtCore import Qt
from qtpy.QtWidgets import QHBoxLayout, QPushButton, QVBoxLayout, QWidget

from meshwright.desktop.application.settings import Settings
from meshwright.desktop.controller import Connections
from meshwright.desktop.widgets import icons
from meshwright.desktop.widgets.basic import named
from meshwright.graphics.theme import GRID

MOST = 5
"""Number of recent files that are listed."""


class EmptyPage(QWidget):
    """Shown in place of the canvas while there is no mesh.

    The buttons call ``new()`` and ``open_file()``; a click on one of the recent files, which it
    reads from ``settings``, calls ``open_recent(path)``.
    """

    def __init__(
        self,
        new: Callable[[], None],
        open_file: Callable[[], None],
        open_recent: Callable[[str], None],
        settings: Settings,
    ) -> None:
        super().__init__()
        self._settings = settings
        self._open_recent = open_recent
        self.setObjectName("Empty")
        self.setAttribute(Qt.WidgetAttribute.WA_StyledBackground)
        picture = named("", "Picture")
        picture.setPixmap(icons.app_icon().pixmap(56, 56))
        title = named("No mesh yet", "EmptyTitle")
        text = named("Mesh a shape, or open a triangle or quad mesh.", "EmptyText")
        text.setWordWrap(True)
        self.new = QPushButton("New mesh\u2026")
        self.new.setObjectName("Primary")
        self.new.setToolTip("Mesh a shape  (Ctrl+N)")
        self.open = QPushButton("Open a file\u2026")
        self.open.setToolTip("Open a mesh file  (Ctrl+O)")
        self.new.clicked.connect(lambda checked=False: new())
        self.open.clicked.connect(lambda checked=False: open_file())
        drop = named("Or drop a file here.", "Hint")
        buttons = QHBoxLayout()
        buttons.setSpacing(GRID)
        buttons.addStretch(1)
        buttons.addWidget(self.new)
        buttons.addWidget(self.open)
        buttons.addStretch(1)
        self._recent = QWidget()
        self._column = QVBoxLayout(self._recent)
        self._column.setContentsMargins(0, 0, 0, 0)
        self._column.setSpacing(0)
        layout = QVBoxLayout(self)
        layout.setSpacing(GRID)
        layout.addStretch(3)
        for part in (picture, title, text):
            part.setAlignment(Qt.AlignmentFlag.AlignHCenter)
            layout.addWidget(part)
        layout.addSpacing(2 * GRID)
        layout.addLayout(buttons)
        drop.setAlignment(Qt.AlignmentFlag.AlignHCenter)
        layout.addSpacing(GRID)
        layout.addWidget(drop)
        layout.addSpacing(2 * GRID)
        layout.addWidget(self._recent, 0, Qt.AlignmentFlag.AlignHCenter)
        layout.addStretch(4)
        self.recent: list[QPushButton] = []
        self._connections = Connections()
        self._connections.add(settings.changed, self._on_settings_changed)
        self._show_recent()

    def release(self) -> None:
        """Disconnect from the settings."""
        self._connections.close()

    def _on_settings_changed(self, key: str) -> None:
        if key == "files/recent":
            self._show_recent()

    def _show_recent(self) -> None:
        """List the recent files that still exist."""
        while (item := self._column.takeAt(0)) is not None:
            widget = item.widget()
            if widget is not None:
                widget.deleteLater()
        self.recent = []
        there = [path for path in self._settings.recent if Path(path).is_file()][:MOST]
        if not there:
            return
        heading = named("RECENT", "Heading")
        heading.setAlignment(Qt.AlignmentFlag.AlignHCenter)
        self._column.addWidget(heading)
        for path in there:
            button = QPushButton(Path(path).name)
            button.setObjectName("Link")
            button.setToolTip(path)
            button.clicked.connect(partial(self._on_recent_clicked, path))
            self._column.addWidget(button)
            self.recent.append(button)

    def _on_recent_clicked(self, path: str, checked: bool = False) -> None:
        self._open_recent(path)
