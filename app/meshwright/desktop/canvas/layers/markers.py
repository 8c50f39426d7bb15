"""The layer of boundary, corners, irregular vertices with their numbers, locks and pins."""

import numpy as np
from qtpy.QtCore import QPointF, QRect, QRectF, Qt
from qtpy.QtGui import QColor, QFont, QPainter, QPainterPath, QPen

from meshwright.desktop.canvas.layers.base import Layer, inside, pen, polyline
from meshwright.graphics.markers import PIN, READABLE, Markers, label
from meshwright.graphics.theme import Theme
from meshwright.graphics.true_edges import TrueEdges
from meshwright.graphics.viewport import Viewport

MOST_CORNERS = 5000
"""Corners are not drawn if more than this are visible."""
CORNER, ANCHOR = 8.0, 5.5
"""Sides in pixels of the full square of a corner, and of the hollow one of an anchor."""


class MarkersLayer(Layer):
    """Paints :class:`meshwright.graphics.markers.Markers`."""

    def __init__(self, theme: Theme, font: QFont) -> None:
        super().__init__(theme)
        self._font = QFont(font)
        self._font.setWeight(QFont.Weight.DemiBold)
        # x, y, radius, delta, corner?, anchor? of visible irregular vertices
        self._discs = np.empty((0, 6))
        self._marks: Markers | None = None  # of the discs, which are not VTK's
        self._displaced, self._places = np.empty(0, np.int64), np.empty((0, 2))
        self._numbers = True
        self._strokes = True
        self._corners = np.empty((0, 2))
        self._anchors = np.empty((0, 2))
        self._rings = np.empty((0, 2))
        self._pins = np.empty((0, 2))
        self._outline = QPainterPath()
        self._interfaces = QPainterPath()

    @property
    def numbers(self) -> bool:
        """Whether discs show their irregularity as a number, where it is legible."""
        return self._numbers

    @numbers.setter
    def numbers(self, shown: bool) -> None:
        if shown != self._numbers:
            self._numbers = shown
            self.changed()

    @property
    def strokes(self) -> bool:
        """Whether boundary and interfaces are drawn; another layer may do so in its own colours."""
        return self._strokes

    @strokes.setter
    def strokes(self, shown: bool) -> None:
        if shown != self._strokes:
            self._strokes = shown
            self.changed()

    @property
    def discs(self) -> np.ndarray:
        """(n, 4) the visible irregular vertices: x, y and radius in pixels, irregularity."""
        return self._discs[:, :4]

    def displace(
        self, vertices: np.ndarray | None = None, places: np.ndarray | None = None
    ) -> None:
        """Mark these vertices (n,), in ascending order, at other places (n, 2) of the plane: where
        another layer draws them. Without arguments all are marked where they are.
        """
        if vertices is None or places is None:
            if not len(self._displaced):
                return
            vertices, places = np.empty(0, np.int64), np.empty((0, 2))
        self._displaced, self._places = vertices, places
        self._place_discs()
        self.changed()

    def show(
        self,
        marks: Markers | None,
        edges: TrueEdges | None,
        viewport: Viewport,
        crowd: bool,
        outlined: bool,
    ) -> None:
        """Paint these markers, and the boundary and interfaces, as seen through ``viewport``.

        Discs are VTK's where ``crowd``, the boundary is where ``outlined``.
        """
        self.viewport = viewport
        self._marks = marks if edges is not None and not crowd else None
        self._corners = self._anchors = self._rings = self._pins = np.empty((0, 2))
        self._outline, self._interfaces = QPainterPath(), QPainterPath()
        if marks is not None and edges is not None:
            if not outlined:
                for loop in edges.loops():
                    self._outline.addPolygon(polyline(viewport.to_screen(loop)))
            for line in edges.interfaces():
                self._interfaces.addPolygon(polyline(viewport.to_screen(line)))
            self._rings = inside(viewport.to_screen(marks.locked_places), viewport)
            self._pins = inside(viewport.to_screen(marks.pinned_places), viewport)
            if not crowd:
                corners = inside(viewport.to_screen(marks.corner_places), viewport)
                self._corners = corners if len(corners) < MOST_CORNERS else self._corners
                anchors = inside(viewport.to_screen(marks.anchor_places), viewport)
                self._anchors = anchors if len(anchors) < MOST_CORNERS else self._anchors
        self._place_discs()

    def _place_discs(self) -> None:
        marks, viewport = self._marks, self.viewport
        if marks is None:
            self._discs = np.empty((0, 6))
            return
        places = marks.places
        if len(self._displaced):
            row = np.searchsorted(self._displaced, marks.vertices)
            row = np.minimum(row, len(self._displaced) - 1)
            moved = self._displaced[row] == marks.vertices
            places = np.where(moved[:, None], self._places[row], places)
        discs = np.column_stack(
            (
                viewport.to_screen(places),
                marks.radii(viewport),
                marks.delta,
                marks.corners,
                marks.anchors,
            )
        )
        self._discs = inside(discs, viewport)

    def paint(self, painter: QPainter, rect: QRect) -> None:
        """Paint the boundary, then the marks on vertices."""
        painter.setBrush(Qt.BrushStyle.NoBrush)
        if self._strokes:
            painter.setPen(pen(self.theme.boundary, 1.5))
            painter.drawPath(self._interfaces)
            painter.setPen(pen(self.theme.boundary, 1.75))
            painter.drawPath(self._outline)
        near = QRectF(rect).adjusted(-24, -24, 24, 24)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(self.theme.corner))
        for x, y in self._corners.tolist():
            if near.contains(x, y):
                painter.drawRect(QRectF(x - CORNER / 2, y - CORNER / 2, CORNER, CORNER))
        painter.setPen(QPen(QColor(self.theme.corner), 1.25))
        painter.setBrush(QColor(self.theme.background))
        for x, y in self._anchors.tolist():
            if near.contains(x, y):
                painter.drawRect(QRectF(x - ANCHOR / 2, y - ANCHOR / 2, ANCHOR, ANCHOR))
        self._paint_discs(painter, near)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(QColor(self.theme.boundary), 1.5))
        for x, y in self._rings.tolist():
            if near.contains(x, y):
                painter.drawEllipse(QPointF(x, y), 12.5, 12.5)
        right, up, radius = PIN
        for x, y in self._pins.tolist():
            if near.contains(x, y):
                head = QPointF(x + right, y - up)
                painter.setPen(QPen(QColor(self.theme.boundary), 1.5))
                painter.drawLine(QPointF(x, y), head)
                painter.setPen(QPen(QColor(self.theme.background), 1.0))
                painter.setBrush(QColor(self.theme.accent))
                painter.drawEllipse(head, radius, radius)

    def _paint_discs(self, painter: QPainter, near: QRectF) -> None:
        plus, minus = QColor(self.theme.plus), QColor(self.theme.minus)
        halo = QPen(QColor(self.theme.background), 1.25)
        font = QFont(self._font)
        for x, y, r, delta, corner, anchor in self._discs.tolist():
            if not near.contains(x, y):
                continue
            if corner:
                painter.setPen(Qt.PenStyle.NoPen)
                painter.setBrush(QColor(self.theme.corner))
                painter.drawRect(QRectF(x - r, y - r, 2 * r, 2 * r))
            elif anchor:
                painter.setPen(QPen(QColor(self.theme.corner), 1.25))
                painter.setBrush(QColor(self.theme.background))
                painter.drawRect(QRectF(x - r, y - r, 2 * r, 2 * r))
            painter.setPen(halo if r > 4 else Qt.PenStyle.NoPen)
            painter.setBrush(plus if delta > 0 else minus)
            painter.drawEllipse(QPointF(x, y), r, r)
            if self._numbers and r >= READABLE:
                font.setPixelSize(max(8, round(1.1 * r)))
                painter.setFont(font)
                painter.setPen(QColor(self.theme.marker_text))
                box = QRectF(x - 2 * r, y - 2 * r, 4 * r, 4 * r)
                painter.drawText(box, Qt.AlignmentFlag.AlignCenter, label(int(delta)))
