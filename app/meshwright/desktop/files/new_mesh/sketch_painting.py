"""Painting of a sketch and of what its tools would add next."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence

import numpy as np
from qtpy.QtCore import QPointF, QRectF, Qt
from qtpy.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPainterPath, QPen, QPolygonF

from meshwright.desktop.files.new_mesh.painting import polygon
from meshwright.desktop.widgets.basic import tabular
from meshwright.graphics.theme import Theme
from meshwright.graphics.viewport import Viewport
from meshwright.sources.arc_edges import Place, points_of
from meshwright.sources.drawing_tools import Draft
from meshwright.sources.polygon_checks import PolygonLoop, PolygonProblem
from meshwright.sources.snapping import Snap

CORNER = 8.0
_CLOSEST_GRID = 7.0
"""Pixels between grid lines below which only every fifth or tenth is drawn."""
_STEP = math.radians(2.0)
"""Angle between neighbours in the polyline of an arc."""


class SketchPainting:
    """Paints with ``painter`` what is seen through ``view`` in the colours of ``theme``."""

    def __init__(self, painter: QPainter, view: Viewport, theme: Theme, font: QFont) -> None:
        self._painter, self._view, self._theme = painter, view, theme
        self._width, self._height = view.size
        self._font = tabular(QFont(font))
        self._font.setPixelSize(11)

    def _at(self, place: Place) -> QPointF:
        x, y = self._view.to_screen(np.array(place)).tolist()
        return QPointF(x, y)

    # The grid

    def grid(self, step: float) -> None:
        """Lines of this spacing, or of a multiple where they would be too close."""
        painter, view = self._painter, self._view
        step = step or 10.0 ** math.floor(math.log10(60.0 / view.pixels))
        for factor in (1, 5, 10, 50, 100, 500, 1000, 10_000, 100_000):
            if step * factor * view.pixels >= _CLOSEST_GRID:
                step *= factor
                break
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
        low = view.to_plane(0, self._height)
        high = view.to_plane(self._width, 0)
        for axis in (0, 1):
            for k in range(math.floor(low[axis] / step), math.ceil(high[axis] / step) + 1):
                self._grid_line(axis, k, step)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)

    def _grid_line(self, axis: int, k: int, step: float) -> None:
        painter, pixels = self._painter, self._view.pixels
        strong = k % 5 == 0 or step * pixels > 60
        colour = QColor(self._theme.edge if k == 0 else self._theme.line)
        colour.setAlphaF(0.55 if k == 0 else 0.9 if strong else 0.4)
        painter.setPen(QPen(colour, 1))
        at = self._at((k * step, 0.0) if axis == 0 else (0.0, k * step))
        x, y = at.x(), at.y()
        if axis == 0:
            painter.drawLine(round(x), 0, round(x), self._height)
        else:
            painter.drawLine(0, round(y), self._width, round(y))
        if strong and k % 5 == 0 and step * pixels * 5 > 40:
            painter.setPen(QColor(self._theme.faint))
            painter.setFont(self._font)
            text = f"{k * step:.6g}".replace("-", "\u2212")
            if axis == 0:
                painter.drawText(QPointF(x + 3, self._height - 5), text)
            elif k != 0:
                painter.drawText(QPointF(6, y - 3), text)

    # The sketch

    def loops(self, loops: Sequence[PolygonLoop]) -> None:
        """The area between the closed loops, and all edges."""
        painter = self._painter
        lines = [(loop.closed, self._rim(loop)) for loop in loops if len(loop.corners) > 1]
        area = QPainterPath()
        for closed, line in lines:
            if closed:
                area.addPolygon(polygon(line))
                area.closeSubpath()
        fill = QColor(self._theme.accent_soft)
        fill.setAlphaF(0.55)
        painter.fillPath(area, fill)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(QColor(self._theme.boundary), 1.75))
        for closed, line in lines:
            if closed:
                painter.drawPolygon(polygon(line))
            else:
                painter.drawPolyline(polygon(line))

    def _rim(self, loop: PolygonLoop) -> np.ndarray:
        points: list[Place] = []
        for edge in loop.edges:
            points += points_of(*loop.ends(edge), loop.bulge(edge), _STEP)[:-1]
        if not loop.closed:
            points.append(loop.corners[-1])
        pixels: np.ndarray = self._view.to_screen(np.array(points))
        return pixels

    def corners(
        self,
        corners: Iterable[tuple[int, int, Place]],
        first: tuple[int, int] | None,
        selected: tuple[int, int] | None,
    ) -> None:
        """Squares at the corners, a larger one at ``first``, a frame around the selected one."""
        painter = self._painter
        for i, j, p in corners:
            side = CORNER + (4 if (i, j) == first else 0)
            at = self._at(p)
            box = QRectF(at.x() - side / 2, at.y() - side / 2, side, side)
            painter.setPen(QPen(QColor(self._theme.background), 1.5))
            painter.setBrush(QColor(self._theme.accent if (i, j) == first else self._theme.corner))
            painter.drawRect(box)
            if (i, j) == selected:
                painter.setPen(QPen(QColor(self._theme.accent), 2))
                painter.setBrush(Qt.BrushStyle.NoBrush)
                painter.drawRect(box.adjusted(-3.5, -3.5, 3.5, 3.5))

    def problem(self, problem: PolygonProblem, loops: Sequence[PolygonLoop]) -> None:
        """The edges and points of a problem."""
        painter, colour = self._painter, QColor(self._theme.warning)
        painter.setPen(QPen(colour, 3, Qt.PenStyle.DashLine))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        for i, j in problem.edges:
            if j in loops[i].edges:
                points = np.array(loops[i].edge_points(j))
                painter.drawPolyline(polygon(self._view.to_screen(points)))
        painter.setPen(QPen(colour, 2.5))
        for spot in problem.places:
            at = self._at(spot)
            x, y = at.x(), at.y()
            painter.drawLine(QPointF(x - 7, y - 7), QPointF(x + 7, y + 7))
            painter.drawLine(QPointF(x - 7, y + 7), QPointF(x + 7, y - 7))

    # What is drawn next

    def draft(self, draft: Draft, measures: bool, wrong: bool) -> None:
        """What a click would add; ``measures``: a distance, with ticks at its ends; ``wrong``: it
        would be a problem.
        """
        painter = self._painter
        style = Qt.PenStyle.SolidLine if measures else Qt.PenStyle.DashLine
        colour = QColor(self._theme.warning if wrong else self._theme.accent)
        painter.setPen(QPen(colour, 1.75, style))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        for line in draft.lines:
            painter.drawPolyline(polygon(self._view.to_screen(np.array(line))))
            if measures:
                self._ticks(*line)

    def _ticks(self, start: Place, end: Place) -> None:
        p, q = self._view.to_screen(np.array([start, end]))
        length = float(np.hypot(*(q - p)))
        if length == 0.0:
            return
        x, y = (6.0 * (q - p) / length).tolist()
        for place in (p, q):
            at = QPointF(*place.tolist())
            self._painter.drawLine(at + QPointF(-y, x), at + QPointF(y, -x))

    def guides(self, snap: Snap) -> None:
        """The lines that a place snapped to, across the whole area."""
        self._painter.setPen(QPen(QColor(self._theme.accent), 1, Qt.PenStyle.DotLine))
        for start, end in snap.guides:
            p, q = self._view.to_screen(np.array([start, end]))
            along = q - p
            length = float(np.hypot(*along))
            if length > 0:
                reach = (self._width + self._height) * along / length
                self._painter.drawLine(
                    QPointF(*(p - reach).tolist()), QPointF(*(p + reach).tolist())
                )

    def target(self, place: Place, middle: bool = False) -> None:
        """A ring where the next corner would be; a triangle in the middle of an edge."""
        self._painter.setPen(QPen(QColor(self._theme.accent), 1.75))
        self._painter.setBrush(QColor(self._theme.background))
        at = self._at(place)
        if middle:
            corners = [QPointF(-6, 4.5), QPointF(6, 4.5), QPointF(0, -6)]
            self._painter.drawPolygon(QPolygonF([at + corner for corner in corners]))
        else:
            self._painter.drawEllipse(at, 5, 5)

    def label(self, place: Place, lines: Sequence[str], typed: str = "") -> None:
        """A box with lines of text beside a place; ``typed`` stands above them, with a caret."""
        painter, font = self._painter, self._font
        metrics = QFontMetricsF(font)
        rows = [*([f"{typed}\u2502"] if typed else []), *(line for line in lines if line)]
        if not rows:
            return
        width = max(metrics.horizontalAdvance(row) for row in rows) + 14
        box = QRectF(0, 0, width, metrics.height() * len(rows) + 6)
        at = self._at(place)
        box.moveTopLeft(at + QPointF(12, 12))
        if box.right() > self._width - 4:
            box.moveRight(at.x() - 12)
        if box.bottom() > self._height - 4:
            box.moveBottom(at.y() - 12)
        painter.setPen(QPen(QColor(self._theme.accent if typed else self._theme.line), 1))
        painter.setBrush(QColor(self._theme.raised))
        painter.drawRoundedRect(box, 4, 4)
        painter.setFont(font)
        for number, row in enumerate(rows):
            painter.setPen(QColor(self._theme.text if number == 0 else self._theme.muted))
            line = QRectF(box.left() + 7, box.top() + 3 + number * metrics.height(), width, 99)
            painter.drawText(line, Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignTop, row)
