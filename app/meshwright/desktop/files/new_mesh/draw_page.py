"""The page on which a polygon is drawn."""

from __future__ import annotations

from typing import Any

from qtpy.QtCore import Qt
from qtpy.QtGui import QKeySequence, QShortcut
from qtpy.QtWidgets import QCheckBox, QHBoxLayout, QPushButton, QVBoxLayout

from meshwright.desktop.files.new_mesh.coordinate_table import CoordinateTable
from meshwright.desktop.files.new_mesh.drawing_area import DrawingArea
from meshwright.desktop.files.new_mesh.page_base import Page
from meshwright.desktop.widgets import icons
from meshwright.desktop.widgets.basic import named
from meshwright.desktop.widgets.number_box import DecimalBox
from meshwright.graphics.theme import GRID, Theme
from meshwright.sources.polygon_sketch import Sketch
from meshwright.sources.snapping import Snapper


class DrawPage(Page):
    """A drawing area with its tools, and the table of coordinates beside it."""

    def __init__(self, theme: Theme) -> None:
        super().__init__()
        self.sketch = Sketch()
        self.area = DrawingArea(self.sketch, theme)
        self.table = CoordinateTable(self.sketch)
        self.hole = _button("Add hole", "Start a hole: click its corners inside the outline")
        self.undo = _button("", "Undo the last change (Ctrl+Z)")
        self.redo = _button("", "Redo the change that was undone last (Ctrl+Shift+Z)")
        self.clear = _button("Clear", "Clear the drawing; this can be undone")
        self.fit = _button("Fit", "Fit the view to the drawing")
        self.to_grid = _tick("Grid", "Corners snap to grid points")
        self.step = DecimalBox()
        self.step.setDecimals(3)
        self.step.setRange(0.001, 1000.0)
        self.step.setSingleStep(0.05)
        self.step.setValue(0.1)
        self.step.setAlignment(Qt.AlignmentFlag.AlignRight)
        self.step.setFixedWidth(10 * GRID)
        self.step.setAccessibleName("Grid spacing")
        self.to_points = _tick("Points", "The mouse snaps to existing corners")
        self.to_angles = _tick("Right angles", "Edges snap to the axes and to right angles")
        self._arrange()
        self._connect()
        self.set_theme(theme)
        self._on_snapping()
        self._refresh()

    def _arrange(self) -> None:
        tools = QHBoxLayout()
        tools.setSpacing(GRID)
        for button in (self.hole, self.undo, self.redo, self.clear, self.fit):
            tools.addWidget(button)
        tools.addStretch(1)
        tools.addWidget(named("Snap to", "Label"))
        for part in (self.to_grid, self.step, self.to_points, self.to_angles):
            tools.addWidget(part)
        both = QHBoxLayout()
        both.setSpacing(GRID)
        both.addWidget(self.area, 1)
        both.addWidget(self.table)
        hint = named(
            "Click to add a corner, or type it in the table. Drag a corner to move it, click an "
            "edge to insert one. Right click or Backspace undoes.",
            "Hint",
        )
        hint.setWordWrap(True)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(GRID)
        layout.addLayout(tools)
        layout.addLayout(both, 1)
        layout.addWidget(hint)

    def _connect(self) -> None:
        self.sketch.changed.connect(self._on_sketch_changed)
        self.area.message.connect(self.message.emit)
        self.table.message.connect(self.message.emit)
        self.area.picked.connect(self.table.select)
        self.table.picked.connect(self._on_row_picked)
        self.hole.clicked.connect(self._on_hole)
        self.undo.clicked.connect(self.sketch.undo)
        self.redo.clicked.connect(self.sketch.redo)
        self.clear.clicked.connect(self.sketch.clear)
        self.fit.clicked.connect(self.area.fit)
        for tick in (self.to_grid, self.to_points, self.to_angles):
            tick.toggled.connect(self._on_snapping)
        self.step.valueChanged.connect(self._on_snapping)
        self._shortcuts = []
        for keys, run in (
            (QKeySequence.StandardKey.Undo, self.sketch.undo),
            (QKeySequence.StandardKey.Redo, self.sketch.redo),
        ):
            shortcut = QShortcut(QKeySequence(keys), self)
            shortcut.activated.connect(run)
            self._shortcuts.append(shortcut)

    @property
    def source(self) -> dict[str, Any] | None:
        """The polygon, once it is closed and nothing is wrong with it."""
        return {"domain": self.sketch.domain()} if self.sketch.complete else None

    @property
    def words(self) -> str:
        """What is wrong with the polygon, or what to do next."""
        return self.sketch.words

    @property
    def is_wrong(self) -> bool:
        """Whether loops cross, lie outside or have no area."""
        return self.sketch.problem is not None

    def fill(self) -> None:
        """Give the drawing area the keyboard focus."""
        self.area.setFocus()

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self.area.set_theme(theme)
        self.undo.setIcon(icons.icon("undo", theme))
        self.redo.setIcon(icons.icon("redo", theme))

    def release(self) -> None:
        """Disconnect from the sketch."""
        self.sketch.changed.disconnect(self._on_sketch_changed)
        self.area.release()
        self.table.release()

    def _refresh(self) -> None:
        self.hole.setEnabled(not self.sketch.open)
        self.undo.setEnabled(self.sketch.can_undo)
        self.redo.setEnabled(self.sketch.can_redo)
        self.clear.setEnabled(not self.sketch.empty)

    def _on_sketch_changed(self) -> None:
        self._refresh()
        self.changed.emit()

    def _on_hole(self) -> None:
        self.sketch.add_hole()
        self.area.setFocus()

    def _on_row_picked(self, loop: int, corner: int) -> None:
        self.area.select((loop, corner))

    def _on_snapping(self) -> None:
        self.step.setEnabled(self.to_grid.isChecked())
        snapper = Snapper(
            self.step.value() if self.to_grid.isChecked() else 0.0,
            self.to_points.isChecked(),
            self.to_angles.isChecked(),
        )
        self.area.set_snapping(self.step.value(), snapper)


def _button(title: str, tip: str) -> QPushButton:
    made = QPushButton(title)
    made.setToolTip(tip)
    made.setAccessibleName(title or tip)
    made.setAutoDefault(False)
    return made


def _tick(title: str, tip: str) -> QCheckBox:
    made = QCheckBox(title)
    made.setToolTip(tip)
    made.setChecked(True)
    return made
