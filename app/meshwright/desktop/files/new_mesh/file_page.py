"""The page that opens a mesh file or a geometry file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from qtpy.QtCore import Qt
from qtpy.QtGui import QDragEnterEvent, QDragLeaveEvent, QDropEvent
from qtpy.QtWidgets import (
    QDoubleSpinBox,
    QFileDialog,
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QLineEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from meshwright.desktop.files.new_mesh.page_base import Page
from meshwright.desktop.widgets.basic import named
from meshwright.desktop.widgets.number_box import DecimalBox
from meshwright.graphics.theme import GRID, Theme
from meshwright_core.domains.domain import CORNER_ANGLE
from meshwright_core.io import drawings, mesh_files

NO_FILE = "Choose a file, or drop one here."
MESH_WORDS = "A mesh is opened unchanged."
SHAPE_WORDS = "The shape in the file is meshed."


class FilePage(Page):
    """A file, and options for reading its corners and curves."""

    def __init__(self, theme: Theme) -> None:
        super().__init__()
        self.setAcceptDrops(True)
        self.path = QLineEdit()
        self.path.setPlaceholderText("Path of the file")
        self.path.setAccessibleName("Path of the file")
        self.choose = QPushButton("Choose\u2026")
        self.choose.setAutoDefault(False)
        self.corner_angle = _angle(CORNER_ANGLE, 0.0, 180.0, 2, "Corner angle")
        self.curve_step = _angle(0.0, 0.0, 90.0, 1, "Curve step")
        self.curve_step.setSpecialValueText("automatic")
        self.words_label = named(NO_FILE, "Hint")
        self.words_label.setWordWrap(True)
        self._arrange()
        self.path.editingFinished.connect(self._on_path)
        self.choose.clicked.connect(self._ask)
        for field in (self.corner_angle, self.curve_step):
            field.valueChanged.connect(self._on_reading)
        self._asked = ""
        self._refresh()

    def _arrange(self) -> None:
        self.zone = QFrame()
        self.zone.setObjectName("DropZone")
        inner = QVBoxLayout(self.zone)
        inner.setContentsMargins(3 * GRID, 3 * GRID, 3 * GRID, 3 * GRID)
        inner.setSpacing(GRID)
        line = QHBoxLayout()
        line.setSpacing(GRID)
        line.addWidget(self.path, 1)
        line.addWidget(self.choose)
        inner.addLayout(line)
        inner.addWidget(self.words_label)
        shapes, meshes = drawings.endings(), mesh_files.endings()
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(3 * GRID)
        layout.addWidget(self.zone)
        layout.addWidget(self._readings())
        layout.addWidget(_kinds("Shapes, to be meshed", shapes))
        layout.addWidget(_kinds("Meshes, opened unchanged", meshes))
        layout.addStretch(1)

    def _readings(self) -> QWidget:
        readings = QWidget()
        grid = QGridLayout(readings)
        grid.setContentsMargins(0, 0, 0, 0)
        grid.setHorizontalSpacing(2 * GRID)
        grid.setVerticalSpacing(GRID)
        rows = (
            (
                "Corners turn by more than",
                self.corner_angle,
                "Increase it if curved sides are drawn as short straight pieces.",
            ),
            (
                "Curves turn at each point by",
                self.curve_step,
                "Decrease it to follow arcs and splines more closely.",
            ),
        )
        for row, (title, field, hint) in enumerate(rows):
            grid.addWidget(named(title, "Label"), row, 0)
            grid.addWidget(field, row, 1)
            words = named(hint, "Hint")
            words.setWordWrap(True)
            grid.addWidget(words, row, 2)
        grid.setColumnStretch(2, 1)
        return readings

    @property
    def source(self) -> dict[str, Any] | None:
        """The file and the options for reading it."""
        if not self._asked:
            return None
        return {
            "file": self._asked,
            "corner_angle": self.corner_angle.value(),
            "curve_step": self.curve_step.value() or None,
        }

    @property
    def words(self) -> str:
        """A request to choose a file; empty once there is one."""
        return "" if self._asked else NO_FILE

    @property
    def takes_settings(self) -> bool:
        """False for mesh files, which are opened unchanged."""
        return not self._asked or drawings.is_geometry(self._asked)

    def take(self, path: str) -> None:
        """Read this file."""
        self.path.setText(path)
        self._on_path()

    def _on_path(self) -> None:
        asked = self.path.text().strip()
        if asked != self._asked:
            self._asked = asked
            self._refresh()
            self.changed.emit()

    def _on_reading(self) -> None:
        self.changed.emit()

    def _refresh(self) -> None:
        is_shape = bool(self._asked) and self.takes_settings
        words = SHAPE_WORDS if is_shape else MESH_WORDS if self._asked else NO_FILE
        self.words_label.setText(words)
        self.curve_step.setEnabled(is_shape)
        self.corner_angle.setEnabled(bool(self._asked))

    def _ask(self) -> None:
        shapes = " ".join(f"*{ending}" for ending in drawings.endings())
        meshes = " ".join(f"*{ending}" for ending in mesh_files.endings())
        kinds = f"Shapes and meshes ({shapes} {meshes});;Shapes ({shapes});;Meshes ({meshes})"
        folder = str(Path(self._asked).parent) if self._asked else ""
        path, _ = QFileDialog.getOpenFileName(
            self, "Open a shape or a mesh", folder, f"{kinds};;All files (*)"
        )
        if path:
            self.take(path)

    def dragEnterEvent(self, event: QDragEnterEvent) -> None:  # noqa: N802
        """Accept the drag of one file."""
        urls = event.mimeData().urls()
        if len(urls) == 1 and urls[0].isLocalFile():
            event.acceptProposedAction()
            self._light(True)

    def dragLeaveEvent(self, event: QDragLeaveEvent) -> None:  # noqa: N802
        """Reset the look of the drop zone."""
        self._light(False)

    def dropEvent(self, event: QDropEvent) -> None:  # noqa: N802
        """Read the dropped file."""
        self._light(False)
        self.take(event.mimeData().urls()[0].toLocalFile())

    def _light(self, on: bool) -> None:
        self.zone.setProperty("over", on)
        self.zone.style().unpolish(self.zone)
        self.zone.style().polish(self.zone)


def _angle(value: float, low: float, high: float, decimals: int, name: str) -> QDoubleSpinBox:
    made = DecimalBox()
    made.setDecimals(decimals)
    made.setRange(low, high)
    made.setValue(value)
    made.setSuffix("\u00b0")
    made.setAlignment(Qt.AlignmentFlag.AlignRight)
    made.setFixedWidth(10 * GRID)
    made.setKeyboardTracking(False)
    made.setAccessibleName(name)
    return made


def _kinds(title: str, endings: tuple[str, ...]) -> QWidget:
    made = QWidget()
    layout = QVBoxLayout(made)
    layout.setContentsMargins(0, 0, 0, 0)
    layout.setSpacing(GRID // 2)
    layout.addWidget(named(title, "Label"))
    names = named("  ".join(endings), "Hint")
    names.setWordWrap(True)
    names.setTextInteractionFlags(Qt.TextInteractionFlag.NoTextInteraction)
    layout.addWidget(names)
    return made
