"""Named sides on the canvas, and the dialog that edits names."""

from __future__ import annotations

import numpy as np
from qtpy.QtWidgets import QWidget

from meshwright.desktop.canvas.canvas import Canvas
from meshwright.desktop.canvas.layers.side_names import SideNamesLayer
from meshwright.desktop.controller import Controller
from meshwright.desktop.editing.names_dialog import NamesDialog
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.document.document import Document
from meshwright.graphics.theme import Theme
from meshwright_core.core.names import groups
from meshwright_core.core.side_names import names_of, side_edges


class NamesController(Controller):
    """Shows the named sides of the mesh in colours while :attr:`shown`."""

    def __init__(
        self, document: Document, canvas: Canvas, status: StatusBar, parent: QWidget, theme: Theme
    ) -> None:
        super().__init__(theme)
        self._document, self._canvas, self._status = document, canvas, status
        self._parent = parent
        self.shown = True
        self.layer = SideNamesLayer(theme, canvas.font())
        canvas.overlay.add(self.layer, below=canvas.overlay.markers)
        canvas.drawn.connect(self._show)

    def toggle(self) -> None:
        """Show named sides in colours, or no longer."""
        self.shown = not self.shown
        self._show()
        if self.shown and self.layer.empty:
            self._status.show_message("No side has a name; Mesh > Names\u2026 gives some.")

    def edit(self) -> None:
        """Show the dialog of names."""
        dialog = NamesDialog(self._document, self.colour_of, self._parent)
        dialog.exec()
        dialog.deleteLater()

    def colour_of(self, group: str) -> str:
        """The colour of the first side that is in a group, "" if none is shown."""
        for name, colour in self.layer.colours().items():
            if group in groups(name):
                return colour
        return ""

    def _show(self) -> None:
        mesh, true_edges = self._document.mesh, self._canvas.edges
        named = mesh is not None and any(
            piece.name for pieces in mesh.boundary_info.pieces for piece in pieces
        )
        if mesh is None or true_edges is None or not self.shown or not named:
            self.layer.show({})
            return
        found = side_edges(mesh.arrays)
        names = names_of(mesh.boundary_info, found.curve, found.span)
        lines: dict[str, list[np.ndarray]] = {}
        for halfedge, name in zip(found.halfedges.tolist(), names, strict=True):
            if name:
                lines.setdefault(name, []).append(true_edges.line(halfedge))
        self.layer.show(dict(sorted(lines.items())))
