"""Removable global lines: highlighted while the switch is on, removed by a click."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from qtpy.QtCore import QPointF, Qt, QTimer

from meshwright.desktop.application.readiness import Readiness
from meshwright.desktop.application.settings import Settings
from meshwright.desktop.canvas.canvas import Canvas
from meshwright.desktop.canvas.layers.cleanable_lines import LinesLayer
from meshwright.desktop.canvas.mouse import Click
from meshwright.desktop.controller import Controller
from meshwright.desktop.editing.edit_controller import EditController
from meshwright.desktop.editing.hover_controller import HoverController
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.document.document import Document
from meshwright.graphics.theme import Theme
from meshwright_core.operations.catalogue import Operation

if TYPE_CHECKING:
    from meshwright_core.analysis.cleanable_lines import CleanableLine

LINES = "editing/lines"
"""The setting that shows removable lines."""
PAUSE = 60
"""Milliseconds between a change and the search for lines."""
REACH = 7.0
"""Distance in pixels at which a line counts as under the mouse."""


class CleanableLinesController(Controller):
    """Finds the lines shortly after an edit, so that operations do not wait for the search."""

    def __init__(
        self,
        document: Document,
        canvas: Canvas,
        settings: Settings,
        readiness: Readiness,
        hover: HoverController,
        editing: EditController,
        status: StatusBar,
        theme: Theme,
    ) -> None:
        super().__init__(theme)
        self._document, self._canvas, self._settings = document, canvas, settings
        self._readiness, self._hover, self._editing = readiness, hover, editing
        self._status = status
        self._lines: list[CleanableLine] = []
        self._edges = np.zeros(0, np.int64)  # sorted: ends of every edge on a line as one number
        self._line_of = np.zeros(0, np.int64)
        self._pause = QTimer(canvas)
        self._pause.setSingleShot(True)
        self._pause.setInterval(PAUSE)
        self._pause.timeout.connect(self.find)
        self.layer = LinesLayer(theme)
        canvas.overlay.add(self.layer, below=canvas.overlay.markers)
        canvas.hovered.connect(self._on_hovered)
        self._connections.add(document.replaced, self._on_changed)
        self._connections.add(document.changed, self._on_changed)
        self._connections.add(settings.changed, self._on_settings_changed)
        self._connections.add(readiness.changed, self.find)
        self._on_changed()

    def close(self) -> None:
        """Disconnect, and stop the timer."""
        super().close()
        self._pause.stop()

    @property
    def shown(self) -> bool:
        """Whether removable lines are shown."""
        return self._settings.flag(LINES, False)

    def toggle(self) -> None:
        """Show or hide the removable lines."""
        self._settings.put(LINES, not self.shown)
        if not self.shown:
            self._status.show_message("Removable lines hidden.")
            return
        self.find()
        if self._document.kind == "quad" and not self._lines:
            self._status.show_message("No line of this mesh can be removed.")
        elif self._lines:
            self._status.show_message("Click a highlighted line to remove it, or use Clean all.")

    def find(self) -> None:
        """Find and show the lines of the current mesh."""
        self._pause.stop()
        mesh = self._document.mesh
        self._lines = []
        if mesh is not None and mesh.k == 4 and self.shown and self._readiness.editing:
            from meshwright_core.analysis.cleanable_lines import cleanable_lines

            self._lines = cleanable_lines(mesh)
        self._index()
        points = mesh.points[:, :2] if mesh is not None else np.zeros((0, 2))
        self.layer.show([points[line.vertices] for line in self._lines])

    def _index(self) -> None:
        ends = [
            np.column_stack(
                [line.vertices[:-1], line.vertices[1:], np.full(len(line.vertices) - 1, i)]
            )
            for i, line in enumerate(self._lines)
        ]
        rows = np.concatenate(ends) if ends else np.zeros((0, 3), np.int64)
        keys = _key(rows[:, 0], rows[:, 1])
        order = np.argsort(keys)
        self._edges, self._line_of = keys[order], rows[order, 2]

    def click(self, click: Click) -> bool:
        """Remove the highlighted line under a click; False if there is none."""
        current = self.layer.current
        if current < 0 or click.button != Qt.MouseButton.LeftButton:
            return False
        self._editing.submit(Operation.CLEANUP, self._lines[current].halfedge)
        return True

    def _on_hovered(self, at: QPointF | None) -> None:
        if self._lines:
            self.layer.highlight(self._line_at(at))

    def _line_at(self, at: QPointF | None) -> int:
        """The line near pixel ``at`` that contains the hovered edge; -1 for none."""
        mesh, halfedge = self._document.mesh, self._document.hover
        if mesh is None or at is None or halfedge < 0 or self._pause.isActive():
            return -1
        if self._hover.armed is not None:
            return -1
        a, b = mesh.origin(halfedge), mesh.target(halfedge)
        key = int(_key(np.array([a]), np.array([b]))[0])
        place = int(np.searchsorted(self._edges, key))
        if place == len(self._edges) or self._edges[place] != key:
            return -1
        ends = self._canvas.viewport.to_screen(mesh.points[[a, b]])
        along, to = ends[1] - ends[0], np.array((at.x(), at.y())) - ends[0]
        length = max(float(np.hypot(*along)), 1e-9)
        away = abs(float(along[0] * to[1] - along[1] * to[0])) / length
        return int(self._line_of[place]) if away <= REACH else -1

    def _on_changed(self) -> None:
        if self._lines:
            self._lines = []
            self.layer.show([])
        if self.shown and not self._pause.isActive():
            self._pause.start()

    def _on_settings_changed(self, key: str) -> None:
        if key == LINES:
            self.find()


def _key(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    low, high = np.minimum(a, b).astype(np.int64), np.maximum(a, b).astype(np.int64)
    return low << 32 | high
