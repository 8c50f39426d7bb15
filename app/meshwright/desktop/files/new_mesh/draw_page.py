"""The page on which a shape is drawn."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from qtpy.QtCore import Qt
from qtpy.QtGui import QKeySequence, QShortcut
from qtpy.QtWidgets import QCheckBox, QHBoxLayout, QPushButton, QVBoxLayout

from meshwright.desktop.files.new_mesh.controls import SegmentedButtons
from meshwright.desktop.files.new_mesh.coordinate_table import CoordinateTable
from meshwright.desktop.files.new_mesh.drawing_area import DrawingArea
from meshwright.desktop.files.new_mesh.page_base import Page
from meshwright.desktop.widgets import icons
from meshwright.desktop.widgets.basic import named
from meshwright.desktop.widgets.number_box import DecimalBox
from meshwright.graphics.theme import GRID, Theme
from meshwright.sources.drawing_tools import ARC, LINE
from meshwright.sources.polygon_sketch import Sketch
from meshwright.sources.snapping import Snapper

CORNER_ANGLE = 1.0
"""Degrees by which the boundary turns at a corner where a side is an arc."""
TOOLS = (
    ("line", "Line"),
    ("arc", "Arc"),
    ("rectangle", "Rectangle"),
    ("circle", "Circle"),
    ("measure", "Measure"),
)
HINT_LINES = 2
HINTS = {
    "line": "Click to add a corner, or type its distance or \u201cx y\u201d. Drag a corner to move "
    "it, click an edge to insert one. Right click or Backspace undoes.",
    "arc": "Click where the arc ends, then a point on it, or type its radius. Right click or "
    "Backspace undoes.",
    "rectangle": "Click a corner, or type it (\u201cx y\u201d); then the opposite one, or "
    "\u201cwidth height\u201d. Inside the outline it is a hole.",
    "circle": "Click the centre, or type it (\u201cx y\u201d); then a point on the circle, or its "
    "radius. Inside the outline it is a hole.",
    "measure": "Click two points: the distance between them is shown.",
}
"""How each tool works."""


class DrawPage(Page):
    """A drawing area with its tools, and the table of coordinates beside it."""

    def __init__(self, theme: Theme) -> None:
        super().__init__()
        self.sketch = Sketch()
        self.area = DrawingArea(self.sketch, theme)
        self.table = CoordinateTable(self.sketch)
        self.tools = SegmentedButtons(TOOLS, "Tool")
        for (name, title), key in zip(TOOLS, "LARCM", strict=True):
            self.tools.buttons[name].setToolTip(f"{title}  ({key}): {HINTS[name]}")
        self.hint = named("", "Hint")
        self.hint.setWordWrap(True)
        self.hint.setAlignment(Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop)
        # always the same height, or the drawing above it would jump
        self.hint.setFixedHeight(HINT_LINES * self.hint.fontMetrics().lineSpacing())
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
        self.to_middles = _tick("Middles", "The mouse snaps to the middles of edges and arcs")
        self._ticks = (self.to_grid, self.to_points, self.to_angles, self.to_middles)
        self._arrange()
        self._connect()
        self.set_theme(theme)
        self._on_snapping()
        self._on_tool_picked("line")
        self._refresh()

    def _arrange(self) -> None:
        tools = QHBoxLayout()
        tools.setSpacing(GRID)
        tools.addWidget(self.tools)
        tools.addStretch(1)
        for button in (self.undo, self.redo):
            tools.addWidget(button)
        snapping = QHBoxLayout()
        snapping.setSpacing(GRID)
        snapping.addWidget(named("Snap to", "Label"))
        for part in (
            self.to_grid, self.step, self.to_points, self.to_middles, self.to_angles
        ):  # fmt: skip
            snapping.addWidget(part)
        snapping.addStretch(1)
        for_all = QHBoxLayout()
        for_all.setSpacing(GRID)
        for button in (self.hole, self.clear, self.fit):
            for_all.addWidget(button)
        beside = QVBoxLayout()
        beside.setSpacing(GRID)
        beside.addWidget(self.table, 1)
        beside.addLayout(for_all)
        both = QHBoxLayout()
        both.setSpacing(GRID)
        both.addWidget(self.area, 1)
        both.addLayout(beside)
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(GRID)
        layout.addLayout(tools)
        layout.addLayout(both, 1)
        layout.addLayout(snapping)
        layout.addWidget(self.hint)

    def _connect(self) -> None:
        self.sketch.changed.connect(self._on_sketch_changed)
        self.tools.changed.connect(self._on_tool)
        self.area.tool_picked.connect(self._on_tool_picked)
        self.area.hinted.connect(self._on_hinted)
        self.area.message.connect(self.message.emit)
        self.table.message.connect(self.message.emit)
        self.area.picked.connect(self.table.select)
        self.table.picked.connect(self._on_row_picked)
        self.hole.clicked.connect(self._on_hole)
        self.undo.clicked.connect(self.sketch.undo)
        self.redo.clicked.connect(self.sketch.redo)
        self.clear.clicked.connect(self.sketch.clear)
        self.fit.clicked.connect(self.area.fit)
        for tick in self._ticks:
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
        """The shape, once it is closed and nothing is wrong with it."""
        if not self.sketch.complete:
            return None
        return {"domain": self.sketch.domain(), "corner_angle": CORNER_ANGLE}

    @property
    def state(self) -> dict[str, Any]:
        """The drawing and how it snaps, for :meth:`restore`."""
        return {
            "loops": self.sketch.to_json(),
            "grid": self.step.value(),
            "snaps": [tick.isChecked() for tick in self._ticks],
        }

    def restore(self, state: Mapping[str, Any]) -> None:
        """Show a drawing again."""
        self.sketch.put_json(state["loops"])
        self.step.setValue(float(state["grid"]))
        for tick, on in zip(self._ticks, state["snaps"], strict=False):
            tick.setChecked(bool(on))
        self.area.fit()

    @property
    def words(self) -> str:
        """What is wrong with the shape, or what to do next. How a rectangle or circle begins the
        hint tells.
        """
        if self.tools.key not in (LINE, ARC) and not self.sketch.loops[-1].corners:
            return ""
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

    def _on_tool(self, name: str) -> None:
        self.area.use(name)
        self.area.setFocus()
        self.changed.emit()

    def _on_tool_picked(self, name: str) -> None:
        self.tools.key = name
        self._on_hinted("")
        self.changed.emit()

    def _on_hinted(self, words: str) -> None:
        self.hint.setText(words or HINTS[self.tools.key])

    def _on_row_picked(self, loop: int, corner: int) -> None:
        self.area.select((loop, corner))

    def _on_snapping(self) -> None:
        self.step.setEnabled(self.to_grid.isChecked())
        snapper = Snapper(
            self.step.value() if self.to_grid.isChecked() else 0.0,
            self.to_points.isChecked(),
            self.to_angles.isChecked(),
            self.to_middles.isChecked(),
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
