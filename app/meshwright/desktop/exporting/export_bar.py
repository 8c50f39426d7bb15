"""The bar below the canvas while a file is written."""

from __future__ import annotations

from qtpy.QtCore import Signal
from qtpy.QtWidgets import QFrame, QHBoxLayout, QProgressBar, QPushButton

from meshwright.desktop.widgets.basic import named
from meshwright.graphics.theme import GRID


class ExportBar(QFrame):
    """One line between canvas and timeline while a file is written; ``cancelled()``."""

    cancelled = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.setObjectName("ExportBar")
        self._words = named("", "Label")
        self.progress = QProgressBar()
        self.progress.setTextVisible(False)
        self.progress.setFixedHeight(6)
        self.progress.setAccessibleName("Progress of the export")
        self.cancel = QPushButton("Cancel")
        self.cancel.clicked.connect(self.cancelled)
        layout = QHBoxLayout(self)
        layout.setContentsMargins(2 * GRID, GRID // 2, 2 * GRID, GRID // 2)
        layout.setSpacing(2 * GRID)
        layout.addWidget(self._words)
        layout.addWidget(self.progress, 1)
        layout.addWidget(self.cancel)
        self.hide()

    @property
    def words(self) -> str:
        """The text of the bar."""
        return str(self._words.text())

    def show_progress(self, name: str, done: int, total: int) -> None:
        """Show how many frames of the file ``name`` are written."""
        count = f", frame {done:,} of {total:,}" if total > 1 else ""
        self.show_stage(f"Writing {name}{count}", done, total)

    def show_stage(self, words: str, done: int = 0, total: int = 0) -> None:
        """Show a text and how much is done; of 0 in total it is not known."""
        self._words.setText(words)
        self.progress.setMaximum(total)
        self.progress.setValue(done)
        self.show()
