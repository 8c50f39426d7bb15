"""Hatching of inverted elements on the canvas."""

from __future__ import annotations

import numpy as np

from meshwright.desktop.canvas.canvas import Canvas
from meshwright.desktop.canvas.layers.inverted_elements import HatchLayer
from meshwright.desktop.controller import Controller
from meshwright.desktop.quality.quality_job import QualityMonitor
from meshwright.document.document import Document
from meshwright.graphics.theme import Theme
from meshwright_core.core.arrays import ORIGIN


class InvertedController(Controller):
    """Hatches the elements that ``monitor`` has found inverted.

    While it measures a changed mesh, those that it found before stay hatched.
    """

    def __init__(
        self, document: Document, canvas: Canvas, monitor: QualityMonitor, theme: Theme
    ) -> None:
        super().__init__(theme)
        self._document, self._canvas, self._monitor = document, canvas, monitor
        self._elements = np.zeros(0, np.int64)
        self.layer = HatchLayer(theme)
        canvas.overlay.add(self.layer, below=canvas.overlay.markers)
        monitor.measured.connect(self._on_measured)
        canvas.drawn.connect(self._show)
        self._connections.add(document.replaced, self._on_replaced)

    def _on_measured(self) -> None:
        summary = self._monitor.summary
        self._elements = np.zeros(0, np.int64) if summary is None else summary.inverted
        self._show()

    def _on_replaced(self) -> None:
        self._elements = np.zeros(0, np.int64)
        self._show()

    def _show(self) -> None:
        mesh = self._document.mesh
        if mesh is None or not len(self._elements):
            self.layer.show(np.zeros((0, 3, 2)), np.zeros(0, np.int64), None)
            return
        halfedges = mesh.halfedges_of(self._elements)
        halfedges = halfedges[halfedges[:, -1] < len(mesh.arrays.edge)]
        corners = mesh.arrays.edge[halfedges, ORIGIN]
        alive = corners[:, 0] >= 0
        elements = halfedges[alive, 0] // mesh.k
        self.layer.show(mesh.points[corners[alive], :2], elements, self._canvas.edges)
