"""The layer of chords: a line through the middles of the quads of each strip."""

from __future__ import annotations

import numpy as np
from qtpy.QtCore import QLineF
from qtpy.QtGui import QPainter

from meshwright.desktop.canvas.layers.base import pen
from meshwright.desktop.canvas.layers.cached_layer import PictureLayer
from meshwright.graphics.colouring import HUES
from meshwright.graphics.theme import Theme

MOST = 20_000
"""Segments in view that are drawn at most."""


class ChordsLayer(PictureLayer):
    """Paints the chords of a quad mesh, neighbours by number in different hues."""

    def __init__(self, theme: Theme) -> None:
        super().__init__(theme)
        self._ends = np.zeros((0, 2, 2))
        self._chord = np.zeros(0, np.int64)

    @property
    def empty(self) -> bool:
        """Whether there are no chords to draw."""
        return not len(self._ends)

    def show(self, ends: np.ndarray, chord: np.ndarray) -> None:
        """Draw segments (n, 2, 2) in the plane, each of a chord (n,)."""
        if len(ends) or len(self._ends):
            self._ends, self._chord = ends, chord
            self.forget()

    def draw(self, painter: QPainter) -> None:
        """Paint the segments that are in view, chord colour by chord colour."""
        ends = self.viewport.to_screen(self._ends)
        low, high = ends.min(axis=1), ends.max(axis=1)
        seen = ((high > 0) & (low < np.array(self.viewport.size))).all(axis=1)
        rows = np.flatnonzero(seen)[:MOST]
        for number, hue in enumerate(HUES):
            some = rows[self._chord[rows] % len(HUES) == number]
            painter.setPen(pen(hue, 2.0))
            painter.drawLines([QLineF(*one) for one in ends[some].reshape(-1, 4).tolist()])
