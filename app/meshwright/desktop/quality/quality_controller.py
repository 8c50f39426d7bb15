"""The dashboard: score and quality of one window, and the ways from a number to its place."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from meshwright.desktop.canvas.layers.highlight import SpotLayer
from meshwright.desktop.quality.irregularity_chart import MOST
from meshwright.desktop.quality.quality_job import Gauge
from meshwright.desktop.quality.quality_panel import QualityPanel
from meshwright.desktop.quality.score_panel import ScorePanel
from meshwright.graphics.markers import label
from meshwright.graphics.theme import Theme

if TYPE_CHECKING:
    from meshwright.desktop.main_window.window import MainWindow


class Dashboard:
    """Owns ``score`` and ``quality``, the panels, and ``gauge`` behind them."""

    def __init__(self, window: MainWindow) -> None:
        self._window = window
        self.gauge = Gauge(window.document, window)
        self.score = ScorePanel(window.document, self.gauge, window.theme)
        self.quality = QualityPanel(self.gauge, window.settings, window.theme)
        self.spot = SpotLayer(window.theme, window)
        self._vertex = self._element = -1

    def connect(self) -> None:
        """Follow panels and document."""
        overlay = self._window.canvas.overlay
        overlay.add(self.spot, below=overlay.card)
        self.score.delta_chosen.connect(self.go_to_next)
        self.score.inverted_chosen.connect(self.go_to_inverted)
        self.quality.worst_chosen.connect(self.go_to_element)
        self._window.document.changed.connect(self.spot.clear)

    def release(self) -> None:
        """Let go of the document."""
        self._window.document.changed.disconnect(self.spot.clear)
        self.spot.clear()
        self.score.release()
        self.gauge.release()

    def set_theme(self, theme: Theme) -> None:
        """Draw in other colours."""
        self.score.set_theme(theme)
        self.quality.set_theme(theme)

    def go_to_next(self, delta: int) -> None:
        """Look at the next vertex of irregularity ``delta``, or beyond it at the tally's end."""
        mesh = self._window.document.mesh
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
        self.spot.show(place[None])
        at = int(np.searchsorted(found, vertex)) + 1
        self._window.say(
            f"Vertex {vertex}: \u0394 {label(int(deltas[vertex]))}, {at:,} of {len(found):,}."
        )

    def go_to_inverted(self) -> None:
        """Look at the next inverted element."""
        summary = self.gauge.summary
        if summary is not None and len(summary.inverted):
            self.go_to_element(_after(summary.inverted, self._element))

    def go_to_element(self, element: int) -> None:
        """Look at an element."""
        mesh = self._window.document.mesh
        if mesh is None or not mesh.live(element * mesh.k):
            return
        self._element = element
        first = element * mesh.k
        corners = mesh.points[[mesh.origin(first + side) for side in range(mesh.k)]]
        self._look_at(corners)
        self.spot.show(corners)
        self._window.say(f"Element {element}.")

    def _look_at(self, places: np.ndarray) -> None:
        canvas = self._window.canvas
        canvas.see(canvas.viewport.around(places))


def _after(ids: np.ndarray, last: int) -> int:
    """The first of ``ids``, ascending, that is larger than ``last``; round to the first."""
    place = int(np.searchsorted(ids, last, side="right"))
    return int(ids[place % len(ids)])
