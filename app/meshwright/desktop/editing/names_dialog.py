"""The dialog of names: lists those of sides and regions, renames them, names what is selected."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from qtpy.QtCore import QModelIndex, QPersistentModelIndex, QSize, Qt
from qtpy.QtGui import QColor, QIcon, QPalette, QPixmap
from qtpy.QtWidgets import (
    QAbstractItemView,
    QDialog,
    QHBoxLayout,
    QHeaderView,
    QLineEdit,
    QPushButton,
    QStyledItemDelegate,
    QStyleOptionViewItem,
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
    vertices_of,
)
from meshwright.graphics.theme import GRID
from meshwright_core import MeshError
from meshwright_core.core.names import clean
from meshwright_core.errors import sentence

_NOTHING = (
    "Choose a line to see it on the mesh, double-click it to name it; or select vertices along a"
    " side, or of a region, on the mesh."
)
_HINT = "Several names of one side or region are separated by semicolons."


_WIDEST = "Name 1,000 edges"


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
        self.resize(540, 420)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(2 * GRID, 2 * GRID, 2 * GRID, 2 * GRID)
        layout.setSpacing(GRID)
        self.table = QTableWidget(0, 2)
        self.table.setObjectName("Table")
        self.table.setShowGrid(False)
        self.table.setItemDelegate(_NoName(self.table))
        self.table.setHorizontalHeaderLabels(["Name", "Of"])
        header = self.table.horizontalHeader()
        header.setSectionResizeMode(0, QHeaderView.ResizeMode.Stretch)
        header.setDefaultAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter)
        self.table.verticalHeader().hide()
        self.table.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.table.setIconSize(QSize(14, 14))
        self.table.itemChanged.connect(self._on_item_changed)
        self.table.currentCellChanged.connect(self._on_row)
        layout.addWidget(self.table, 1)
        self.note = named("", "Label")
        self.note.setWordWrap(True)
        layout.addWidget(self.note)
        line = QHBoxLayout()
        self.name = QLineEdit()
        self.name.setPlaceholderText("Name")
        self.name.textChanged.connect(self._on_typed)
        self.name.returnPressed.connect(self._on_return)
        self.sides = QPushButton()
        self.regions = QPushButton()
        for part in (self.sides, self.regions):
            part.setAutoDefault(False)
            part.setMinimumWidth(part.fontMetrics().horizontalAdvance(_WIDEST) + 4 * GRID)
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
        mesh = self._document.mesh
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
            if not part.name:
                shown.setToolTip("Double-click to give it a name")
            self.table.setItem(row, 0, shown)
            self.table.setItem(row, 1, about)
        self.table.setCurrentCell(-1, -1)
        self.table.resizeColumnToContents(1)
        self.table.blockSignals(False)
        self._see_selection()

    def _see_selection(self) -> None:
        mesh, selection = self._document.mesh, self._document.selection
        none = np.zeros(0, np.int64)
        self._edges = none if mesh is None else selected_sides(mesh, selection.vertices)
        self._chosen = [] if mesh is None else selected_regions(mesh, selection.elements)
        self.sides.setText(_name(len(self._edges), "edge"))
        self.regions.setText(_name(len(self._chosen), "region"))
        self._on_typed()

    def say(self, text: str) -> None:
        """A line below the table; empty for the usual one."""
        nothing = not len(self._edges) and not self._chosen
        self.note.setText(text or (_NOTHING if nothing else _HINT))

    def _on_typed(self) -> None:
        self.sides.setEnabled(len(self._edges) > 0)
        self.regions.setEnabled(len(self._chosen) > 0)
        self.say("")

    def _on_row(self, row: int, *_: object) -> None:
        """Select on the mesh what the line is of."""
        mesh = self._document.mesh
        if mesh is None or not 0 <= row < len(self._parts):
            return
        self._document.selection.set(vertices_of(mesh, self._parts[row]))
        self._see_selection()

    def _on_return(self) -> None:
        """Name what the current line is of, or else what is selected, if it is of one sort."""
        row = self.table.currentRow()
        if 0 <= row < len(self._parts):
            self._name_part(self._parts[row], self.name.text())
        elif len(self._edges) and self._chosen:
            self.say("Press one of the buttons: edges and regions are selected.")
        elif len(self._edges):
            self._on_sides()
        elif self._chosen:
            self._on_regions()

    def _on_sides(self) -> None:
        edges = self._edges
        self._change(lambda: self._document.name_sides(edges, self.name.text()))

    def _on_regions(self) -> None:
        chosen = self._chosen
        self._change(lambda: self._document.name_regions(chosen, self.name.text()))

    def _on_item_changed(self, item: QTableWidgetItem) -> None:
        self._name_part(self._parts[item.row()], item.text())

    def _name_part(self, part: NamedPart, text: str) -> None:
        wanted = clean(text)
        if wanted == part.name:
            self.fill()
        elif part.name:
            self._change(lambda: self._document.rename(part.name, wanted))
        elif part.sides:
            edges = np.array(part.halfedges, np.int64)
            self._change(lambda: self._document.name_sides(edges, wanted))
        else:
            self._change(lambda: self._document.name_regions(part.regions, wanted))

    def _change(self, work: Callable[[], None]) -> None:
        try:
            work()
        except MeshError as error:
            self.fill()
            self.say(sentence(str(error)))
        else:
            self.name.clear()
            self.fill()


class _NoName(QStyledItemDelegate):
    """Shows "no name" where a name is missing."""

    def initStyleOption(  # noqa: N802
        self, option: QStyleOptionViewItem, index: QModelIndex | QPersistentModelIndex
    ) -> None:
        super().initStyleOption(option, index)
        if not option.text:
            option.text = "no name"
            muted = option.palette.color(QPalette.ColorRole.PlaceholderText)
            option.palette.setColor(QPalette.ColorRole.Text, muted)


def _name(count: int, noun: str) -> str:
    return f"Name {plural(count, noun)}" if count else f"Name {noun}s"


def _swatch(colour: str) -> QIcon:
    picture = QPixmap(14, 14)
    picture.fill(QColor(colour))
    return QIcon(picture)
