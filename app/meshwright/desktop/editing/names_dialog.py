"""The dialog of names: lists those of sides and regions, renames them, names what is selected."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from qtpy.QtCore import QSize, Qt
from qtpy.QtGui import QColor, QIcon, QPixmap
from qtpy.QtWidgets import (
    QAbstractItemView,
    QDialog,
    QHBoxLayout,
    QHeaderView,
    QLineEdit,
    QPushButton,
    QTableWidget,
    QTableWidgetItem,
    QVBoxLayout,
    QWidget,
)

from meshwright.desktop.widgets.basic import named
from meshwright.desktop.widgets.wording import plural
from meshwright.document.document import Document
from meshwright.document.named_parts import (
    NamedPart,
    named_parts,
    selected_regions,
    selected_sides,
)
from meshwright.graphics.theme import GRID
from meshwright_core import MeshError
from meshwright_core.core.names import clean
from meshwright_core.errors import sentence

_HINT = "Several names of one side or region are separated by semicolons."


class NamesDialog(QDialog):
    """Shows the names of ``document``; every change is one step of its history.

    ``colour_of`` returns the colour of a named side, "" for none.
    """

    def __init__(
        self, document: Document, colour_of: Callable[[str], str], parent: QWidget | None = None
    ) -> None:
        super().__init__(parent)
        self._document, self._colour_of = document, colour_of
        self._parts: list[NamedPart] = []
        self.setWindowTitle("Names")
        self.resize(480, 420)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(2 * GRID, 2 * GRID, 2 * GRID, 2 * GRID)
        layout.setSpacing(GRID)
        self.table = QTableWidget(0, 2)
        self.table.setHorizontalHeaderLabels(["Name", "Of"])
        self.table.horizontalHeader().setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        self.table.verticalHeader().hide()
        self.table.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.table.setIconSize(QSize(14, 14))
        self.table.itemChanged.connect(self._on_item_changed)
        layout.addWidget(self.table, 1)
        self.note = named("", "Label")
        self.note.setWordWrap(True)
        layout.addWidget(self.note)
        line = QHBoxLayout()
        self.name = QLineEdit()
        self.name.setPlaceholderText("Name of what is selected")
        self.name.textChanged.connect(self._on_typed)
        self.sides = QPushButton()
        self.regions = QPushButton()
        for part in (self.sides, self.regions):
            part.setAutoDefault(False)
        self.sides.clicked.connect(self._on_sides)
        self.regions.clicked.connect(self._on_regions)
        line.addWidget(self.name, 1)
        line.addWidget(self.sides)
        line.addWidget(self.regions)
        layout.addLayout(line)
        below = QHBoxLayout()
        below.addStretch(1)
        self.done_button = QPushButton("Close")
        self.done_button.setAutoDefault(False)
        self.done_button.clicked.connect(self.accept)
        below.addWidget(self.done_button)
        layout.addLayout(below)
        self.fill()
        self.name.setFocus()

    def fill(self) -> None:
        """Show the names as they are now, and what is selected."""
        mesh, selection = self._document.mesh, self._document.selection
        none = np.zeros(0, np.int64)
        self._edges = none if mesh is None else selected_sides(mesh, selection.vertices)
        self._chosen = [] if mesh is None else selected_regions(mesh, selection.elements)
        self._parts = [] if mesh is None else named_parts(mesh)
        noun = "triangle" if self._document.kind == "tri" else "quad"
        self.table.blockSignals(True)
        self.table.setRowCount(len(self._parts))
        for row, part in enumerate(self._parts):
            shown = QTableWidgetItem(part.name)
            if part.sides and (colour := self._colour_of(part.name)):
                shown.setIcon(_swatch(colour))
            what = plural(part.size, "edge" if part.sides else noun)
            numbers = ", ".join(str(number + 1) for number in part.regions)
            text = f"side, {what}" if part.sides else f"region {numbers}, {what}"
            about = QTableWidgetItem(text)
            about.setFlags(Qt.ItemFlag.ItemIsEnabled)
            self.table.setItem(row, 0, shown)
            self.table.setItem(row, 1, about)
        self.table.resizeColumnToContents(1)
        self.table.blockSignals(False)
        self.sides.setText(f"Name {plural(len(self._edges), 'edge')}")
        self.regions.setText(f"Name {plural(len(self._chosen), 'region')}")
        self._on_typed()

    def say(self, text: str) -> None:
        """A line below the table; empty for the usual one."""
        nothing = not len(self._edges) and not self._chosen
        usual = "Select vertices along a side, or of a region, to name it." if nothing else _HINT
        self.note.setText(text or usual)

    def _on_typed(self) -> None:
        self.sides.setEnabled(len(self._edges) > 0)
        self.regions.setEnabled(len(self._chosen) > 0)
        self.say("")

    def _on_sides(self) -> None:
        edges = self._edges
        self._change(lambda: self._document.name_sides(edges, self.name.text()))

    def _on_regions(self) -> None:
        chosen = self._chosen
        self._change(lambda: self._document.name_regions(chosen, self.name.text()))

    def _on_item_changed(self, item: QTableWidgetItem) -> None:
        part, wanted = self._parts[item.row()], clean(item.text())
        if wanted == part.name:
            self.fill()
        elif part.name:
            self._change(lambda: self._document.rename(part.name, wanted))
        else:
            self._change(lambda: self._document.name_regions(part.regions, wanted))

    def _change(self, work: Callable[[], None]) -> None:
        try:
            work()
        except MeshError as error:
            self.fill()
            self.say(sentence(str(error)))
        else:
            self.fill()


def _swatch(colour: str) -> QIcon:
    picture = QPixmap(14, 14)
    picture.fill(QColor(colour))
    return QIcon(picture)
