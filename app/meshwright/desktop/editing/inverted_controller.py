"""Inverted elements in plain sight: hatched on the canvas."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from meshwright.desktop.canvas.layers.inverted_elements import HatchLayer
from meshwright_core.core.arrays import ORIGIN

if TYPE_CHECKING:
    from meshwright.desktop.main_window.window import MainWindow


class Inverted:
    """Shows what the dashboard's gauge has found; until it has measured again, what is left of
    that.
    """

    def __init__(self, window: MainWindow) -> None:
        self._window = window
        self._elements = np.zeros(0, np.int64)
        self.layer = HatchLayer(window.theme)

    def connect(self) -> None:
        """Follow gauge and canvas."""
        window = self._window
        window.canvas.overlay.add(self.layer, below=window.canvas.overlay.markers)
        window.dashboard.gauge.measured.connect(self._on_measured)
        window.document.replaced.connect(self._on_replaced)
        window.canvas.drawn.connect(self._show)

    def release(self) -> None:
        """Let go of the document."""
        self._window.document.replaced.disconnect(self._on_replaced)

    def _on_measured(self) -> None:
        summary = self._window.dashboard.gauge.summary
        self._elements = np.zeros(0, np.int64) if summary is None else summary.inverted
        self._show()

    def _on_replaced(self) -> None:
        self._elements = np.zeros(0, np.int64)
        self._show()

    def _show(self) -> None:
        mesh = self._window.document.mesh
        if mesh is None or not len(self._elements):
            self.layer.show(np.zeros((0, 3, 2)))
            return
        halfedges = mesh.halfedges_of(self._elements)
        halfedges = halfedges[halfedges[:, -1] < len(mesh.arrays.edge)]
        corners = mesh.arrays.edge[halfedges, ORIGIN]
        self.layer.show(mesh.points[corners[corners[:, 0] >= 0], :2])
