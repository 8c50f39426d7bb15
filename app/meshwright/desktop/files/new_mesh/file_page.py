"""The page that opens a mesh file or a geometry file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from qtpy.QtCore import Qt
from qtpy.QtGui import QDragEnterEvent, QDragLeaveEvent, QDropEvent, QResizeEvent
from qtpy.QtWidgets import (
    QDoubleSpinBox,
    QFileDialog,
    QFrame,
    QGridLayout,
    QHBoxLayout,
    QLabel,
    QLineEdit,
    QPushButton,
    QVBoxLayout,
    QWidget,
)

from meshwright.desktop.files.new_mesh.controls import SegmentedButtons
from meshwright.desktop.files.new_mesh.found_regions import NONE_CHOSEN, FoundRegions
from meshwright.desktop.files.new_mesh.page_base import Page
from meshwright.desktop.widgets.basic import named
from meshwright.desktop.widgets.number_box import DecimalBox
from meshwright.graphics.theme import GRID, Theme
from meshwright.sources.new_mesh import DrawingContents
from meshwright_core.domains.domain import CORNER_ANGLE
from meshwright_core.io import drawings, mesh_files

NO_FILE = "Choose a file, or drop one here."
MESH_WORDS = "A mesh is opened unchanged."
SHAPE_WORDS = "The shape in the file is meshed, between its true curves."
ROOM_FOR_HINTS = 600
"""Width of the page, in pixels, from which on options have their hints beside them."""
FITS = (("", "As drawn"), ("arcs", "Arcs"), ("splines", "Splines"))
"""What polylines are taken for."""


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
        self.fit = SegmentedButtons(FITS, "Polylines")
        self.found = FoundRegions(theme)
        self.words_label = named(NO_FILE, "Hint")
        self.words_label.setWordWrap(True)
        self._hints: list[QLabel] = []
        self._arrange()
        self.path.editingFinished.connect(self._on_path)
        self.choose.clicked.connect(self._ask)
        for field in (self.corner_angle, self.curve_step):
            field.valueChanged.connect(self._on_reading)
        self.fit.changed.connect(self._on_reading)
        self.found.changed.connect(self._on_reading)
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
        self.kinds = QWidget()
        kinds = QVBoxLayout(self.kinds)
        kinds.setContentsMargins(0, 0, 0, 0)
        kinds.setSpacing(3 * GRID)
        kinds.addWidget(_kinds("Shapes, to be meshed", drawings.endings()))
        kinds.addWidget(_kinds("Meshes, opened unchanged", mesh_files.endings()))
        layout = QVBoxLayout(self)
        layout.setContentsMargins(0, 0, 0, 0)
        layout.setSpacing(3 * GRID)
        layout.addWidget(self.zone)
        layout.addWidget(self._readings())
        layout.addWidget(self.kinds)
        layout.addWidget(self.found)
        layout.addStretch(1)

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802
        """Leave the hints to the tooltips where there is no room for them."""
        super().resizeEvent(event)
        for words in self._hints:
            words.setVisible(self.width() >= ROOM_FOR_HINTS)

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
                "Edges turn along a curve by",
                self.curve_step,
                "At most; automatic is as much as the shape allows.",
            ),
            (
                "Polylines are read",
                self.fit,
                "Arcs or splines are found in polylines that stand for curves.",
            ),
        )
        for row, (title, field, hint) in enumerate(rows):
            grid.addWidget(named(title, "Label"), row, 0)
            grid.addWidget(field, row, 1)
            words = named(hint, "Hint")
            words.setWordWrap(True)
            field.setToolTip(hint)
            self._hints.append(words)
            grid.addWidget(words, row, 2)
        grid.setColumnStretch(2, 1)
        return readings

    @property
    def chosen(self) -> str:
        """The path of the file; empty if there is none."""
        return self._asked

    @property
    def source(self) -> dict[str, Any] | None:
        """The file and the options for reading it."""
        if not self._asked or self.found.choice == "":
            return None
        return {
            "file": self._asked,
            "corner_angle": self.corner_angle.value(),
            "curve_step": self.curve_step.value() or None,
            "fit": self.fit.key or None,
            "region": self.found.choice,
        }

    @property
    def state(self) -> dict[str, Any]:
        """The file, and the options for reading it."""
        return {
            "path": self._asked,
            "corner_angle": self.corner_angle.value(),
            "curve_step": self.curve_step.value(),
            "fit": self.fit.key,
        }

    def restore(self, state: Mapping[str, Any]) -> None:
        """Read the same file again, if it is still there."""
        self.corner_angle.setValue(state["corner_angle"])
        self.curve_step.setValue(state["curve_step"])
        self.fit.key = state["fit"]
        if state["path"] and Path(state["path"]).is_file():
            self.take(state["path"])

    @property
    def words(self) -> str:
        """A request to choose a file, or regions in it; empty once there are some."""
        if not self._asked:
            return NO_FILE
        return NONE_CHOSEN if self.found.choice == "" else ""

    @property
    def takes_settings(self) -> bool:
        """False for mesh files, which are opened unchanged."""
        return not self._asked or drawings.is_geometry(self._asked)

    def show_contents(self, contents: DrawingContents | None) -> None:
        """Show what was found in the file; None if it is no drawing, or cannot be read."""
        self.found.show_contents(contents)

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self.found.set_theme(theme)

    def take(self, path: str) -> None:
        """Read this file."""
        self.path.setText(path)
        self._on_path()

    def _on_path(self) -> None:
        asked = self.path.text().strip()
        if asked != self._asked:
            self._asked = asked
            self.found.show_contents(None)
            self._refresh()
            self.changed.emit()

    def _on_reading(self) -> None:
        self.changed.emit()

    def _refresh(self) -> None:
        is_shape = bool(self._asked) and self.takes_settings
        words = SHAPE_WORDS if is_shape else MESH_WORDS if self._asked else NO_FILE
        self.words_label.setText(words)
        self.kinds.setVisible(not self._asked)
        self.curve_step.setEnabled(is_shape)
        self.fit.setEnabled(is_shape)
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
    made.setFixedWidth(14 * GRID)
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
