"""The layer of the Blocks view: fine grid, block edges in colours of chords, counts on edges."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from qtpy.QtCore import QPointF, QRectF, Qt
from qtpy.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPen, QPolygonF

from meshwright.desktop.canvas.layers.base import pen, polyline
from meshwright.desktop.canvas.layers.cached_layer import PictureLayer
from meshwright.graphics.colouring import chord_colours
from meshwright.graphics.theme import Theme
from meshwright.graphics.true_edges import polylines
from meshwright.graphics.viewport import Viewport
from meshwright_core.geometry.edge_parts import EdgeParts

ROOM = 30.0
"""Pixels that an edge must be long to carry its number."""
HEIGHT = 17.0
"""Of a number's card, in pixels."""
MOST_LINES = 20_000
"""Lines of the fine grid that are drawn at most."""


@dataclass(frozen=True, eq=False)
class BlocksShown:
    """What the layer paints; e edges, c chords."""

    edges: EdgeParts
    """The e block edges."""
    bent: list[np.ndarray] | None
    """The same as lines (p, 2) where the fine grid has them; None where that is not known."""
    chord: np.ndarray
    """(e,) their chords."""
    counts: np.ndarray | None
    """(c,) cells across the chords; None where there are none."""
    pinned: frozenset[int] = frozenset()
    """Chords whose numbers the user has set."""
    wrong: frozenset[int] = frozenset()
    """Chords that a contradiction is about."""
    strip: Callable[[int], list[np.ndarray]] = lambda chord: []
    """The outlines (p, 2) of the blocks of a chord."""


class GridLinesLayer(PictureLayer):
    """Paints the lines of the fine grid; apart from the blocks, which change with every hover."""

    def __init__(self, theme: Theme) -> None:
        super().__init__(theme)
        self._points = np.zeros((0, 2))
        self._first = np.zeros(1, np.int64)

    @property
    def count(self) -> int:
        """How many lines are shown."""
        return len(self._first) - 1

    @property
    def empty(self) -> bool:
        """Whether there are none."""
        return not self.count

    def show(self, lines: list[np.ndarray]) -> None:
        """Show lines (p, 2) in the plane."""
        if lines or not self.empty:
            some = lines[:MOST_LINES]
            self._points = np.concatenate([np.zeros((0, 2)), *some])
            self._first = np.concatenate([[0], np.cumsum([len(line) for line in some])]).astype(int)
            self.forget()

    def look(self, viewport: Viewport) -> None:
        """Follow a change of the view; the overlay also calls this where only marks changed."""
        if viewport != self.viewport:
            super().look(viewport)

    def draw(self, painter: QPainter) -> None:
        """Paint all lines."""
        colour = QColor(self.theme.edge)
        colour.setAlpha(150)
        painter.setPen(QPen(colour, 0.8))
        for line in np.split(self.viewport.to_screen(self._points), self._first[1:-1]):
            painter.drawPolyline(polyline(line))


class BlocksLayer(PictureLayer):
    """Paints :class:`BlocksShown`; the selected chord, edge or block, and the hovered chord, are
    stronger.
    """

    def __init__(self, theme: Theme, font: QFont) -> None:
        super().__init__(theme)
        self._font = QFont(font)
        self._font.setPixelSize(11)
        self._font.setWeight(QFont.Weight.DemiBold)
        self.shown: BlocksShown | None = None
        self._selected = self._hovered = self._edge = -1
        self._block: np.ndarray | None = None
        self._lines: list[np.ndarray] = []
        self._segments = np.zeros((0, 2, 2))
        self._edge_of = np.zeros(0, np.int64)
        self._cards: list[tuple[int, QRectF]] = []
        self._drag: np.ndarray | None = None

    @property
    def empty(self) -> bool:
        """Whether there is nothing to draw."""
        return self.shown is None

    @property
    def cards(self) -> list[tuple[int, QRectF]]:
        """The edges that carry numbers, with the places of these in pixels."""
        self._place()
        return self._cards

    def show(self, shown: BlocksShown | None) -> None:
        """Show these blocks; None for none."""
        if shown is not None or self.shown is not None:
            self.shown = shown
            self._lines = []
            self.forget()

    def select(self, chord: int, edge: int = -1, block: np.ndarray | None = None) -> None:
        """Mark a chord and one of its edges, or a block by its outline (p, 2); -1 for none."""
        self._selected, self._edge, self._block = chord, edge, block
        self.forget()

    def hover(self, chord: int) -> None:
        """Mark the chord under the mouse; -1 for none."""
        if chord != self._hovered:
            self._hovered = chord
            self.forget()

    def show_drag(self, line: np.ndarray | None) -> None:
        """Show where a line (p, 2) would slide to; None for none."""
        self._drag = line
        self.forget()

    def edge_at(self, at: QPointF, reach: float) -> int:
        """The edge whose number is at pixel `at`, or the nearest one within `reach` pixels; -1 for
        none.
        """
        if self.shown is None:
            return -1
        self._place()
        for edge, card in self._cards:
            if card.contains(at):
                return edge
        place = np.array([at.x(), at.y()])
        start, along = self._segments[:, 0], self._segments[:, 1] - self._segments[:, 0]
        square = np.maximum((along**2).sum(axis=1), 1e-300)
        t = np.clip(((place - start) * along).sum(axis=1) / square, 0.0, 1.0)
        away = np.linalg.norm(start + t[:, None] * along - place, axis=1)
        nearest = int(np.argmin(away))
        return int(self._edge_of[nearest]) if away[nearest] <= reach else -1

    def look(self, viewport: Viewport) -> None:
        """Follow a change of the view; the overlay also calls this where only marks changed."""
        if viewport != self.viewport:
            super().look(viewport)
            self._lines = []

    def draw(self, painter: QPainter) -> None:
        """Paint strips, edges and numbers, in this order."""
        shown = self.shown
        if shown is None:
            return
        self._place()
        colours = chord_colours(int(shown.chord.max(initial=-1)) + 1, self.theme)
        for chord, alpha in ((self._hovered, 34), (self._selected, 62)):
            for outline in shown.strip(chord) if chord >= 0 else ():
                self._fill(painter, outline, colours[chord], alpha)
        if self._block is not None:
            self._fill(painter, self._block, self.theme.accent, 70)
        strong = {self._selected, self._hovered} - {-1}
        edges_of: dict[int, list[int]] = {}
        for edge, chord in enumerate(shown.chord.tolist()):
            edges_of.setdefault(chord, []).append(edge)
        for chord in sorted(edges_of, key=strong.__contains__):
            shapes = [polyline(self._lines[edge]) for edge in edges_of[chord]]
            if chord in shown.wrong:
                _stroke(painter, shapes, self.theme.warning, 9.0)
            if chord == self._selected:
                _stroke(painter, shapes, self.theme.raised, 7.0)
            _stroke(painter, shapes, colours[chord], 4.0 if chord in strong else 2.4)
        if self._edge >= 0:
            one = [polyline(self._lines[self._edge])]
            _stroke(painter, one, self.theme.raised, 9.0)
            _stroke(painter, one, colours[self._selected], 5.5)
        if self._drag is not None:
            painter.setPen(pen(self.theme.accent, 2.5, Qt.PenStyle.DashLine))
            painter.drawPolyline(polyline(self.viewport.to_screen(self._drag)))
        if shown.counts is not None:
            for edge, card in self._cards:
                self._draw_number(painter, card, int(shown.chord[edge]), colours, shown.counts)

    def _place(self) -> None:
        """Find the polylines of edges and the cards of their numbers, once for each view."""
        shown = self.shown
        if shown is None or self._lines:
            return
        lines = shown.bent or polylines(shown.edges, self.viewport)
        first = np.concatenate([[0], np.cumsum([len(line) for line in lines])])
        at = self.viewport.to_screen(np.concatenate(lines))
        self._lines = np.split(at, first[1:-1])
        self._edge_of = np.repeat(np.arange(len(lines)), np.diff(first))[:-1]
        within = np.ones(len(at) - 1, bool)
        within[first[1:-1] - 1] = False
        self._segments = np.stack([at[:-1], at[1:]], axis=1)[within]
        self._edge_of = self._edge_of[within]
        steps = np.linalg.norm(self._segments[:, 1] - self._segments[:, 0], axis=1)
        lengths = np.bincount(self._edge_of, steps, len(lines))
        metrics = QFontMetricsF(self._font)
        self._cards = []
        taken: list[QRectF] = []
        seen = QRectF(0.0, 0.0, *self.viewport.size)
        if shown.counts is None:
            return
        for edge in np.flatnonzero(lengths >= ROOM).tolist():
            line, length = self._lines[edge], float(lengths[edge])
            arc = np.append(0.0, np.cumsum(np.hypot(*np.diff(line, axis=0).T)))
            text = str(shown.counts[shown.chord[edge]])
            width = max(metrics.horizontalAdvance(text) + 10.0, HEIGHT)
            x, y = (float(np.interp(0.5 * length, arc, line[:, c])) for c in range(2))
            card = QRectF(x - 0.5 * width, y - 0.5 * HEIGHT, width, HEIGHT)
            if seen.intersects(card) and not any(card.intersects(other) for other in taken):
                taken.append(card)
                self._cards.append((edge, card))

    def _fill(self, painter: QPainter, outline: np.ndarray, hue: str, alpha: int) -> None:
        colour = QColor(hue)
        colour.setAlpha(alpha)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(colour)
        painter.drawPolygon(QPolygonF(polyline(self.viewport.to_screen(outline))))
        painter.setBrush(Qt.BrushStyle.NoBrush)

    def _draw_number(
        self, painter: QPainter, card: QRectF, chord: int, colours: list[str], counts: np.ndarray
    ) -> None:
        """A card: filled where the number was set, outlined where it follows from the size."""
        shown = self.shown
        assert shown is not None
        set_by_user, wrong = chord in shown.pinned, chord in shown.wrong
        colour = self.theme.warning if wrong else colours[chord]
        painter.setPen(QPen(QColor(colour), 1.4))
        painter.setBrush(QColor(colour if set_by_user else self.theme.raised))
        painter.drawRoundedRect(card, 5.0, 5.0)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setFont(self._font)
        painter.setPen(QColor(self.theme.background if set_by_user else self.theme.text))
        painter.drawText(card, int(Qt.AlignmentFlag.AlignCenter), str(counts[chord]))


def _stroke(painter: QPainter, shapes: list[QPolygonF], colour: str, width: float) -> None:
    painter.setPen(pen(colour, width))
    for shape in shapes:
        painter.drawPolyline(shape)
