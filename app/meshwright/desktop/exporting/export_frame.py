"""The base of the export dialogs: a note and two buttons below what is chosen."""

from __future__ import annotations

from qtpy.QtWidgets import QDialog, QHBoxLayout, QPushButton, QVBoxLayout, QWidget

from meshwright.desktop.widgets.basic import named
from meshwright.graphics.theme import GRID


class ExportFrame(QDialog):
    """A dialog with *Cancel* and *Export...*; a subclass fills the layout that it is given."""

    def __init__(self, title: str, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setWindowTitle(title)
        self.note = named("", "Hint")
        self.cancel, self.export = QPushButton("Cancel"), QPushButton("Export\u2026")
        self.export.setObjectName("Primary")
        self.export.setDefault(True)
        self.cancel.clicked.connect(self.reject)
        self.export.clicked.connect(self.accept)

    def _framed(self) -> QVBoxLayout:
        """The layout of the fields, which has the note and the buttons below it."""
        buttons = QHBoxLayout()
        buttons.setSpacing(GRID)
        buttons.addWidget(self.note, 1)
        buttons.addWidget(self.cancel)
        buttons.addWidget(self.export)
        fields = QVBoxLayout()
        fields.setSpacing(2 * GRID)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(3 * GRID, 3 * GRID, 3 * GRID, 2 * GRID)
        layout.setSpacing(2 * GRID)
        layout.addLayout(fields, 1)
        layout.addLayout(buttons)
        return fields
