"""The table of a sketch's coordinates and radii, which can be edited and follows the drawing."""

from __future__ import annotations

from qtpy.QtCore import QSignalBlocker, Qt, Signal
from qtpy.QtWidgets import QAbstractItemView, QHeaderView, QTableWidget, QTableWidgetItem, QWidget

from meshwright.desktop.widgets.basic import tabular
from meshwright.graphics.theme import GRID
from meshwright.sources.arc_edges import Place, bulge_of_radius, circle_of
from meshwright.sources.drawing_tools import short
from meshwright.sources.polygon_sketch import Sketch
from meshwright_core.errors import sentence

WIDTH = 34 * GRID
NEW = "New"
RADIUS = 3
"""The column of the radii."""
NOT_A_NUMBER = "{text!r} is not a number."


class CoordinateTable(QTableWidget):
    """The corners of a :class:`meshwright.sources.polygon_sketch.Sketch`, one per row, and an empty
    row for the next corner while a loop is open. The fourth column is the radius of the arc that
    begins at the corner.

    ``picked(loop, corner)`` when a row is selected; ``message(sentence)`` for the status line.
    """

    picked = Signal(int, int)
    message = Signal(str)

    def __init__(self, sketch: Sketch, parent: QWidget | None = None) -> None:
        super().__init__(0, 4, parent)
        self.setObjectName("Table")
        self.setFixedWidth(WIDTH)  # always the same, or the drawing beside it would jump
        self.setAccessibleName("Coordinates of the corners")
        self.verticalHeader().hide()
        self.verticalHeader().setDefaultSectionSize(28)
        header = self.horizontalHeader()
        header.setSectionResizeMode(QHeaderView.ResizeMode.Stretch)
        header.setSectionResizeMode(0, QHeaderView.ResizeMode.Fixed)
        header.resizeSection(0, 10 * GRID)
        header.setHighlightSections(False)
        left, right = Qt.AlignmentFlag.AlignLeft, Qt.AlignmentFlag.AlignRight
        titles = (("Corner", left), ("x", right), ("y", right), ("R", right))
        for column, (title, side) in enumerate(titles):
            item = QTableWidgetItem(title)
            item.setTextAlignment(side | Qt.AlignmentFlag.AlignVCenter)
            self.setHorizontalHeaderItem(column, item)
        self.setShowGrid(False)
        self.setFont(tabular(self.font()))
        self.setSelectionMode(QAbstractItemView.SelectionMode.SingleSelection)
        self.setTabKeyNavigation(True)
        self.setEditTriggers(
            QAbstractItemView.EditTrigger.DoubleClicked
            | QAbstractItemView.EditTrigger.SelectedClicked
            | QAbstractItemView.EditTrigger.EditKeyPressed
            | QAbstractItemView.EditTrigger.AnyKeyPressed
        )
        self.sketch = sketch
        self._rows: list[tuple[int, int]] = []
        self._began: list[float | None] = [None, None]
        sketch.changed.connect(self._fill)
        # later: the table must not change while a cell is being edited
        self.cellChanged.connect(self._on_typed, Qt.ConnectionType.QueuedConnection)
        self.currentCellChanged.connect(self._on_current_changed)
        self._fill()

    def release(self) -> None:
        """Disconnect from the sketch."""
        self.sketch.changed.disconnect(self._fill)

    def select(self, loop: int, corner: int) -> None:
        """Select the row of a corner."""
        if (loop, corner) in self._rows:
            with QSignalBlocker(self):
                self.setCurrentCell(self._rows.index((loop, corner)), 1)

    def _fill(self) -> None:
        corners = self.sketch.corners()
        self._rows = [(i, j) for i, j, _ in corners]
        with QSignalBlocker(self):
            self.setRowCount(len(corners) + (1 if self.sketch.open else 0))
            for row, (i, j, place) in enumerate(corners):
                self._put(row, _title(i, j), [*(_text(n) for n in place), self._radius(i, j)])
            if self.sketch.open:
                began = ["" if n is None else _text(n) for n in self._began]
                self._put(len(corners), NEW, [*began, ""])
        if self.currentRow() < 0:
            self.scrollToBottom()

    def _put(self, row: int, title: str, values: list[str]) -> None:
        for column, text in enumerate([title, *values]):
            item = self.item(row, column)
            if item is None:
                item = QTableWidgetItem()
                self.setItem(row, column, item)
            item.setText(text)
            if column == 0:
                item.setFlags(Qt.ItemFlag.ItemIsEnabled)
            else:
                item.setTextAlignment(Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter)

    def _on_typed(self, row: int, column: int) -> None:
        item, axis = self.item(row, column), column - 1
        if axis < 0 or item is None:
            return
        text = item.text().strip()
        number = _number(text)
        if number is None:
            if text:
                self.message.emit(NOT_A_NUMBER.format(text=text[:20]))
            self._fill()
            return
        self.message.emit("")
        if row < len(self._rows):
            loop, corner = self._rows[row]
            if column == RADIUS:
                self._bend(loop, corner, number)
                return
            self.sketch.set(loop, corner, _with(self._place(loop, corner), axis, number))
            return
        if column == RADIUS:
            self._fill()
            return
        self._began[axis] = number
        x, y = self._began
        if x is not None and y is not None:
            self._began = [None, None]
            self.sketch.add((x, y))
            with QSignalBlocker(self):
                self.setCurrentCell(self.rowCount() - 1, 1)
        else:
            self._fill()

    def _radius(self, loop: int, corner: int) -> str:
        """The radius of the edge that begins at a corner; empty for a segment."""
        one = self.sketch.loops[loop]
        if corner not in one.edges or not one.bulge(corner):
            return ""
        return short(circle_of(*one.ends(corner), one.bulge(corner))[1])

    def _bend(self, loop: int, corner: int, radius: float) -> None:
        """Give the edge at a corner another radius; a circle keeps its centre."""
        one = self.sketch.loops[loop]
        bulge = one.bulge(corner) if corner in one.edges else 0.0
        try:
            if radius <= 0.0 or not bulge:
                raise ValueError("only arcs have a radius, and it is positive")
            if one.bulges == (1.0, 1.0):
                self.sketch.scale_circle(loop, radius)
            else:
                ends = one.ends(corner)
                bent = bulge_of_radius(*ends, radius, left=bulge < 0.0, large=abs(bulge) > 1.0)
                self.sketch.bend(loop, corner, bent)
        except ValueError as error:
            self.message.emit(sentence(str(error)))
        self._fill()

    def _place(self, loop: int, corner: int) -> Place:
        return self.sketch.loops[loop].corners[corner]

    def _on_current_changed(self, row: int, *_: int) -> None:
        if 0 <= row < len(self._rows):
            self.picked.emit(*self._rows[row])


def _with(place: Place, axis: int, number: float) -> Place:
    return (number, place[1]) if axis == 0 else (place[0], number)


def _title(loop: int, corner: int) -> str:
    return f"{corner + 1}" if loop == 0 else f"Hole {loop}.{corner + 1}"


def _text(number: float) -> str:
    return f"{number:.10g}".replace("-", "\u2212")


def _number(text: str) -> float | None:
    """The number in ``text``, with decimal point or comma; None if it is not a number."""
    try:
        number = float(text.replace("\u2212", "-").replace(",", "."))
    except ValueError:
        return None
    return number if abs(number) < 1e12 else None
