"""What the elements on the canvas are coloured by, with its legend."""

from __future__ import annotations

import numpy as np

from meshwright.desktop.application.settings import Settings
from meshwright.desktop.canvas.canvas import Canvas
from meshwright.desktop.canvas.layers.chords import ChordsLayer
from meshwright.desktop.canvas.layers.legend import Legend, LegendLayer
from meshwright.desktop.controller import Controller
from meshwright.desktop.quality.quality_job import QualityMonitor
from meshwright.desktop.widgets.status_bar import StatusBar
from meshwright.desktop.widgets.wording import plural
from meshwright.document.document import Document
from meshwright.document.quality_summary import decimal
from meshwright.graphics.colouring import (
    BLOCK,
    CHORD,
    COLOUR_BY,
    JACOBIAN,
    MEASURES,
    PLAIN,
    TITLES,
    block_colours,
    chord_lines,
    measure_colours,
    named,
)
from meshwright.graphics.theme import Theme

QUADS = (BLOCK, CHORD)
"""Only quad meshes have them."""


class ColourController(Controller):
    """Colours elements by block, chord or a measure of their quality.

    After an edit elements keep their colours until ``monitor`` has measured the mesh again.
    """

    def __init__(
        self,
        document: Document,
        canvas: Canvas,
        monitor: QualityMonitor,
        settings: Settings,
        status: StatusBar,
        theme: Theme,
    ) -> None:
        super().__init__(theme)
        self._document, self._canvas, self._monitor = document, canvas, monitor
        self._settings, self._status = settings, status
        self.colour = settings.choice(COLOUR_BY, tuple(TITLES))
        overlay = canvas.overlay
        self.legend = LegendLayer(theme, overlay.font())
        self.chords = ChordsLayer(theme)
        overlay.add(self.chords, below=overlay.markers)
        overlay.add(self.legend, below=overlay.card)
        monitor.measured.connect(self._on_measured)
        self._connections.add(document.replaced, self._on_replaced)

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        super().set_theme(theme)
        self._on_measured()

    def use(self, colour: str) -> None:
        """Colour by a key of :data:`meshwright.graphics.colouring.TITLES`; by the one that is shown
        already: no more.
        """
        self.colour = PLAIN if colour == self.colour else colour
        self._settings.put(COLOUR_BY, self.colour)
        self._status.show_message(
            "Elements are plain." if self.colour == PLAIN else f"Coloured by {named(self.colour)}."
        )
        self._on_measured()

    @property
    def _shown(self) -> str:
        """What this mesh can be coloured by."""
        mesh = self._document.mesh
        if mesh is None or (mesh.k == 3 and self.colour in QUADS):
            return PLAIN
        return self.colour

    def _on_replaced(self) -> None:
        self._canvas.fill(None)
        self._on_measured()

    def _on_measured(self) -> None:
        """The mesh, or what is known of it, has changed."""
        mesh, summary, shown = self._document.mesh, self._monitor.summary, self._shown
        fills = legend = None
        ends, chord = np.zeros((0, 2, 2)), np.zeros(0, np.int64)
        if mesh is not None and self._monitor.fresh:
            if shown == BLOCK:
                colours, count = block_colours(mesh, self._theme)
                fills = np.zeros((int(mesh.element_ids().max(initial=-1)) + 1, 3), np.uint8)
                fills[mesh.element_ids()] = colours
                legend = Legend(TITLES[shown], plural(count, "block"))
            elif shown == CHORD:
                ends, chord = chord_lines(mesh)
                count = int(chord.max(initial=-1)) + 1
                legend = Legend(TITLES[shown], plural(count, "chord"))
            elif shown in MEASURES and summary is not None:
                values = getattr(summary.values, shown)
                fills = measure_colours(values, self._theme)
                worst = getattr(summary, shown).worst
                bound = summary.bound if shown == JACOBIAN else None
                most = f" of at most {decimal(summary.bound)}" if bound is not None else ""
                note = f"worst {decimal(worst)}{most}"
                legend = Legend(TITLES[shown], note, bound, scaled=True)
        elif mesh is not None and shown != PLAIN:
            return
        self.chords.show(ends, chord)
        self.legend.show(legend)
        self._canvas.cover(*self.legend.room)
        self._canvas.fill(fills)
