"""Panels of score and quality, and navigation from their numbers to vertices and elements."""

from __future__ import annotations

import numpy as np

from meshwright.desktop.application.settings import Settings
from meshwright.desktop.canvas.canvas import Canvas
from meshwright.desktop.canvas.layers.highlight import SpotLayer
from meshwright.desktop.controller import Controller
from meshwright.desktop.quality.irregularity_chart import MOST
from meshwright.desktop.quality.quality_job import QualityMonitor
from meshwright.desktop.quality.quality_panel import QualityPanel
from meshwright.desktop.quality.score_panel import ScorePanel
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.document.document import Document
from meshwright.document.quality_summary import decimal
from meshwright.graphics.markers import label
from meshwright.graphics.theme import Theme


class QualityController(Controller):
    """Owns the panels ``score`` and ``quality``, and the ``monitor`` that measures for them.

    ``highlight`` marks the vertex or element that a click on a number leads to.
    """

    def __init__(
        self,
        document: Document,
        canvas: Canvas,
        settings: Settings,
        status: StatusBar,
        theme: Theme,
    ) -> None:
        super().__init__(theme)
        self._document, self._canvas, self._status = document, canvas, status
        self.monitor = QualityMonitor(document, canvas)
        self.score = ScorePanel(document, self.monitor, theme)
        self.quality = QualityPanel(self.monitor, settings, theme)
        self.highlight = SpotLayer(theme, canvas)
        self._vertex = self._element = -1
        canvas.overlay.add(self.highlight, below=canvas.overlay.card)
        self.score.delta_chosen.connect(self.go_to_next)
        self.score.inverted_chosen.connect(self.go_to_inverted)
        self.score.element_chosen.connect(self.go_to_element)
        self.quality.worst_chosen.connect(self.go_to_element)
        self._connections.add(document.changed, self.highlight.clear)

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        super().set_theme(theme)
        self.score.set_theme(theme)
        self.quality.set_theme(theme)

    def close(self) -> None:
        """Disconnect, and end the measuring thread."""
        super().close()
        self.highlight.clear()
        self.score.release()
        self.monitor.release()

    def go_to_next(self, delta: int) -> None:
        """Go to the next vertex of irregularity ``delta``, or beyond it for an outermost column."""
        mesh = self._document.mesh
        if mesh is None:
            return
        deltas = mesh.irregularity()
        if abs(delta) < MOST:
            found = np.flatnonzero(deltas == delta)
        else:
            found = np.flatnonzero(deltas >= delta if delta > 0 else deltas <= delta)
        if len(found) == 0:
            return
        self._vertex = vertex = _after(found, self._vertex)
        place = mesh.points[vertex]
        around = mesh.points[[vertex, *mesh.neighbours(vertex)]]
        reach = float(np.abs(around - place).max())
        self._look_at(place + reach * np.array([(-1.0, -1.0, 0.0), (1.0, 1.0, 0.0)]))
        self.highlight.show(place[None])
        at = int(np.searchsorted(found, vertex)) + 1
        self._status.show_message(
            f"Vertex {vertex}: \u0394 {label(int(deltas[vertex]))}, {at:,} of {len(found):,}."
        )

    def go_to_inverted(self) -> None:
        """Go to the next inverted element."""
        summary = self.monitor.summary
        if summary is not None and len(summary.inverted):
            self.go_to_element(_after(summary.inverted, self._element))

    def go_to_worst(self) -> None:
        """Go to the element with the smallest scaled Jacobian."""
        summary = self.monitor.summary
        if summary is not None and summary.jacobian.worst_element >= 0:
            self.go_to_element(summary.jacobian.worst_element)
            worst = decimal(summary.jacobian.worst)
            element = summary.jacobian.worst_element
            self._status.show_message(f"Element {element}: scaled Jacobian {worst}, the lowest.")

    def go_to_selection(self) -> None:
        """Show the selected vertices as large as they fit."""
        mesh, chosen = self._document.mesh, self._document.selection.vertices
        if mesh is not None and len(chosen):
            self._canvas.see(self._canvas.viewport.fitted(mesh.points[chosen]))

    def go_to_element(self, element: int) -> None:
        """Go to an element."""
        mesh = self._document.mesh
        if mesh is None or not mesh.live(element * mesh.k):
            return
        self._element = element
        first = element * mesh.k
        corners = mesh.points[[mesh.origin(first + side) for side in range(mesh.k)]]
        canvas = self._canvas
        self._look_at(corners)
        self.highlight.show(corners, element, canvas.edges)
        self._status.show_message(f"Element {element}.")

    def _look_at(self, places: np.ndarray) -> None:
        canvas = self._canvas
        canvas.see(canvas.viewport.around(places))


def _after(ids: np.ndarray, last: int) -> int:
    """The first of the ascending ``ids`` that is larger than ``last``, or else the first."""
    place = int(np.searchsorted(ids, last, side="right"))
    return int(ids[place % len(ids)])
