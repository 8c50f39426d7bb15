"""The layer of the policy's input and output: field of view, template, probabilities."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from qtpy.QtCore import QPointF, QRect, QRectF, Qt
from qtpy.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPen

from meshwright.desktop.canvas.layers.base import Layer, pen, polyline
from meshwright.desktop.canvas.layers.hints import percent
from meshwright.desktop.canvas.layers.hover import Sides, arrow, head, lengths, part
from meshwright.graphics.theme import Theme
from meshwright.graphics.true_edges import TrueEdges, polygons
from meshwright_core import HalfEdgeMesh

if TYPE_CHECKING:
    from meshwright_agent.policy.explanation_types import Insight

READ = 0.05
"""Probabilities of at least this value are written beside their half-edge."""
ROOM = 34.0
"""Numbers are written where the edges are longer than this, in pixels."""
NAMED = 7.5
"""Rings of at least this radius carry their slot."""
SMALL = 90.0
"""A field of view smaller than this, in pixels, is marked by a ring around it."""
FAINT = 0.004
"""Half-edges less likely than this are not drawn."""


@dataclass(frozen=True)
class PolicyLayerContent:
    """Coordinates and probabilities of an insight, for painting."""

    edges: TrueEdges | None
    """The true edges of the mesh."""
    seen: np.ndarray
    """(M,) the elements in the field of view, the nearest first."""
    field: np.ndarray
    """(M, k, 2) their corners."""
    blocks: np.ndarray
    """(M,) the convolution block that first includes each element."""
    halfedges: np.ndarray
    """(K,) the candidate half-edges, the most probable last."""
    elements: np.ndarray
    """(K, k, 2) corners of their elements."""
    weights: np.ndarray
    """(K,) their probabilities."""
    wanted: int
    """The row of the half-edge that is chosen next."""
    places: np.ndarray
    """(T, 2) the vertices of the template."""
    slots: np.ndarray
    """(T,) the slot of each."""
    rings: np.ndarray
    """(T,) the ring of each."""
    words: tuple[str, ...]
    """The legend, line by line."""


def sight(
    insight: Insight,
    mesh: HalfEdgeMesh,
    words: tuple[str, ...] = (),
    edges: TrueEdges | None = None,
) -> PolicyLayerContent:
    """What to paint for an insight about ``mesh`` in its current state, with its true edges."""
    order = np.argsort(insight.weights, kind="stable")
    halfedges = insight.halfedges[order]
    return PolicyLayerContent(
        edges=edges,
        seen=insight.field[:, 0],
        field=_corners(mesh, insight.field[:, 0]),
        blocks=insight.field[:, 1],
        halfedges=halfedges,
        elements=_corners(mesh, halfedges // mesh.k),
        weights=insight.weights[order],
        wanted=int(np.flatnonzero(halfedges == insight.wanted.halfedge)[0]),
        places=mesh.points[insight.template[:, 0], :2],
        slots=insight.template[:, 1],
        rings=insight.template[:, 2],
        words=words,
    )


def _corners(mesh: HalfEdgeMesh, elements: np.ndarray) -> np.ndarray:
    return mesh.points[mesh.corners(elements), :2]


class FieldLayer(Layer):
    """The field of view as a tint; lies below the markers. The rest is :class:`InsightLayer`."""

    def __init__(self, theme: Theme, font: QFont) -> None:
        super().__init__(theme)
        self.sight: PolicyLayerContent | None = None
        self.above = InsightLayer(theme, font, self)

    def show(self, sight: PolicyLayerContent | None) -> None:
        """Show what the policy sees, or nothing."""
        if sight is not None or self.sight is not None:
            self.sight = sight
            self.changed()

    def paint(self, painter: QPainter, rect: QRect) -> None:
        """Paint elements paler the later the convolution includes them."""
        if self.sight is None:
            return
        painter.setPen(Qt.PenStyle.NoPen)
        most = max(1, int(self.sight.blocks.max(initial=1)))
        shapes = polygons(self.sight.field, self.sight.seen, self.sight.edges)
        for shape, block in zip(shapes, self.sight.blocks.tolist(), strict=True):
            tint = QColor(self.theme.accent)
            tint.setAlpha(round(84 - 56 * block / most))
            painter.setBrush(tint)
            painter.drawPolygon(polyline(self.viewport.to_screen(shape)))


class InsightLayer(Layer):
    """Template vertices with their slots, probabilities on half-edges, and a few words."""

    def __init__(self, theme: Theme, font: QFont, below: FieldLayer) -> None:
        super().__init__(theme)
        self._below = below
        self._font = QFont(font)
        self._font.setWeight(QFont.Weight.DemiBold)

    def paint(self, painter: QPainter, rect: QRect) -> None:
        """Paint the marks in the order of their importance."""
        seen = self._below.sight
        if seen is None:
            return
        heaviest = float(seen.weights.max(initial=FAINT))
        for row, weight in enumerate(seen.weights.tolist()):
            if weight >= FAINT and row != seen.wanted:
                self._paint_halfedge(painter, self._arrow(seen, row), weight, heaviest)
        self._paint_template(painter, seen)
        weight = float(seen.weights[seen.wanted])
        line = self._arrow(seen, seen.wanted)
        self._paint_halfedge(painter, line, weight, heaviest, wanted=True)
        self._paint_place(painter, seen)
        self._paint_words(painter, seen.words)

    def _arrow(self, seen: PolicyLayerContent, row: int) -> np.ndarray:
        """(n, 2) the arrow of a candidate half-edge in pixels."""
        corners = seen.elements[row]
        element, side = divmod(int(seen.halfedges[row]), len(corners))
        straight: Sides = list(np.stack([corners, np.roll(corners, -1, axis=0)], axis=1))
        sides = seen.edges.sides(element) if seen.edges else straight
        return arrow([self.viewport.to_screen(line) for line in sides], side)

    def _paint_halfedge(
        self,
        painter: QPainter,
        line: np.ndarray,
        weight: float,
        heaviest: float,
        wanted: bool = False,
    ) -> None:
        """Paint an arrow whose width shows the probability of the half-edge, and the
        probability.
        """
        length = float(lengths(line)[-1])
        if length < 1.0:
            return
        share = float(np.sqrt(weight / heaviest))
        width = min(1.0 + 3.0 * share, 1.0 + 0.06 * length)
        size = min(5.0 + width * 1.6, 0.45 * length)
        shaft = polyline(part(line, 0.0, length - 0.8 * size))
        colour = QColor(self.theme.arrow)
        colour.setAlpha(255 if wanted else round(70 + 130 * share))
        if wanted:
            painter.setPen(pen(self.theme.background, width + 3.5))
            painter.drawPolyline(shaft)
        stroke = QPen(colour, width)
        stroke.setCapStyle(Qt.PenCapStyle.FlatCap)
        painter.setPen(stroke)
        painter.drawPolyline(shaft)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(colour)
        painter.drawPath(head(line, size))
        if (weight >= READ or wanted) and length > ROOM:
            # on the left of the arrow, which is inside the element
            middle = part(line, 0.0, 0.5 * length)[-1]
            along = (line[-1] - line[0]) / max(float(np.hypot(*(line[-1] - line[0]))), 1e-9)
            normal = QPointF(-float(along[1]), float(along[0]))
            self._paint_number(painter, QPointF(*middle.tolist()), normal, percent(weight), wanted)

    def _paint_number(
        self, painter: QPainter, at: QPointF, normal: QPointF, text: str, wanted: bool
    ) -> None:
        font = QFont(self._font)
        font.setPixelSize(11)
        width = QFontMetricsF(font).horizontalAdvance(text) + 8.0
        reach = 6.0 + 0.5 * (abs(normal.x()) * width + abs(normal.y()) * 15.0)
        middle = at - normal * reach
        pill = QRectF(middle.x() - width / 2, middle.y() - 7.5, width, 15.0)
        painter.setFont(font)
        painter.setPen(QPen(QColor(self.theme.arrow if wanted else self.theme.line), 1.0))
        painter.setBrush(QColor(self.theme.raised))
        painter.drawRoundedRect(pill, 7.5, 7.5)
        painter.setPen(QColor(self.theme.text))
        painter.drawText(pill, Qt.AlignmentFlag.AlignCenter, text)

    def _paint_template(self, painter: QPainter, seen: PolicyLayerContent) -> None:
        """Paint a ring around each vertex: solid on the element itself, dotted further out."""
        font = QFont(self._font)
        font.setPixelSize(10)
        painter.setFont(font)
        metrics = QFontMetricsF(font)
        radius = self._radius(seen)
        at = self.viewport.to_screen(seen.places).tolist()
        for (x, y), slot, ring in zip(at, seen.slots.tolist(), seen.rings.tolist(), strict=True):
            rim = QPen(QColor(self.theme.arrow), 1.75)
            rim.setStyle(Qt.PenStyle.SolidLine if ring == 0 else Qt.PenStyle.DotLine)
            painter.setBrush(Qt.BrushStyle.NoBrush)
            painter.setPen(rim)
            painter.drawEllipse(QPointF(x, y), radius, radius)
            if radius < NAMED:
                continue
            text = str(slot)
            tag = QRectF(
                x + 0.65 * radius, y + 0.5 * radius, metrics.horizontalAdvance(text) + 7.0, 14.0
            )
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(QColor(self.theme.raised))
            painter.drawRoundedRect(tag, 7.0, 7.0)
            painter.setPen(QColor(self.theme.arrow))
            painter.drawText(tag, Qt.AlignmentFlag.AlignCenter, text)

    def _paint_place(self, painter: QPainter, seen: PolicyLayerContent) -> None:
        """Paint a ring around the field of view if its elements are small."""
        corners = self.viewport.to_screen(seen.field.reshape(-1, 2))
        low, high = corners.min(axis=0), corners.max(axis=0)
        size = float((high - low).max())
        if size < SMALL:
            (x, y), radius = ((low + high) / 2.0).tolist(), size / 2.0 + 18.0
            painter.setBrush(Qt.BrushStyle.NoBrush)
            for colour, width in ((self.theme.background, 5.0), (self.theme.arrow, 2.0)):
                painter.setPen(pen(colour, width))
                painter.drawEllipse(QPointF(x, y), radius, radius)

    def _radius(self, seen: PolicyLayerContent) -> float:
        """The radius of the rings, which is smaller for small elements."""
        corners = self.viewport.to_screen(seen.elements[seen.wanted])
        edges = np.linalg.norm(corners - np.roll(corners, -1, axis=0), axis=1)
        return float(np.clip(0.3 * np.median(edges), 5.0, 12.5))

    def _paint_words(self, painter: QPainter, words: tuple[str, ...]) -> None:
        """Paint a card in the lower left corner with the numbers and the meaning of the marks."""
        if not words:
            return
        font = QFont(self._font)
        font.setPixelSize(12)
        font.setWeight(QFont.Weight.Normal)
        metrics = QFontMetricsF(font)
        width = max(metrics.horizontalAdvance(line) for line in words) + 24.0
        height = 18.0 * len(words) + 14.0
        card = QRectF(12.0, self.viewport.size[1] - height - 12.0, width, height)
        painter.setFont(font)
        painter.setPen(QPen(QColor(self.theme.line), 1.0))
        painter.setBrush(QColor(self.theme.raised))
        painter.drawRoundedRect(card, 6.0, 6.0)
        for row, line in enumerate(words):
            box = QRectF(card.left() + 12.0, card.top() + 7.0 + 18.0 * row, width - 24.0, 18.0)
            painter.setPen(QColor(self.theme.text if row == 0 else self.theme.muted))
            painter.drawText(box, Qt.AlignmentFlag.AlignVCenter, line)
