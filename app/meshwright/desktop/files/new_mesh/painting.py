"""Painting of shapes and meshes with QPainter, in the style of the canvas."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from qtpy.QtCore import QLineF, QPointF, QRectF, Qt
from qtpy.QtGui import QColor, QFont, QPainter, QPainterPath, QPen, QPolygonF

from meshwright.desktop.widgets.basic import tabular
from meshwright.graphics.markers import (
    BASE_RADIUS,
    CROWDED,
    GROWTH,
    LARGEST,
    READABLE,
    SMALLEST,
    label,
)
from meshwright.graphics.theme import Theme, region_fills
from meshwright.graphics.true_edges import polylines
from meshwright.graphics.viewport import Viewport
from meshwright.sources.new_mesh import NewMesh

LINES = 40_000
"""The area is tinted instead if more edges than this are visible."""
DISCS = 2_000
CORNER = 5.0
"""Side in pixels of the square of a corner."""
_SMALLER = 0.8
"""Size of the discs relative to those of the canvas."""
_TINT = 0.35
"""Share of the edges' colour in the tint of a mesh too fine to be drawn."""


def paint_shape(
    painter: QPainter, view: Viewport, loops: Sequence[np.ndarray], theme: Theme, width: float = 1.5
) -> None:
    """Fill the area between the loops, each (n, 2), and draw them."""
    path = QPainterPath()
    for loop in loops:
        path.addPolygon(polygon(view.to_screen(loop)))
        path.closeSubpath()
    painter.setPen(_pen(theme.boundary, width))
    painter.setBrush(QColor(theme.fill))
    painter.drawPath(path)


def paint_mesh(painter: QPainter, view: Viewport, made: NewMesh, theme: Theme) -> bool:
    """Draw a mesh with its irregular vertices; False if it is too fine for its edges to show."""
    inner = _in_sight(made, view)
    fine = len(inner) > LINES
    regions = _region_paths(made, view)
    for rim, fill in zip(regions, region_fills(theme, len(regions)), strict=True):
        painter.fillPath(rim, blend(fill, theme.edge, _TINT) if fine else QColor(fill))
    painter.setBrush(Qt.BrushStyle.NoBrush)
    if not fine:
        painter.setPen(_pen(theme.edge, 1.0))
        ends = view.to_screen(made.points[inner]).reshape(-1, 4).tolist()
        painter.drawLines([QLineF(a, b, c, d) for a, b, c, d in ends])
    painter.setPen(_pen(theme.boundary, 1.75))
    for rim in regions:
        painter.drawPath(rim)
    if not fine:
        squares(painter, view.to_screen(made.points[made.corners]), theme)
        squares(painter, view.to_screen(made.points[made.anchors]), theme, hollow=True)
        _discs(painter, made, view, theme)
    return not fine


def _region_paths(made: NewMesh, view: Viewport) -> list[QPainterPath]:
    """The regions between their curves, in pixels."""
    lines = polylines(made.rim, view)
    paths = [QPainterPath() for _ in range(int(made.owners.max(initial=-1)) + 1)]
    ends = np.cumsum(made.sizes).tolist()
    for owner, size, end in zip(made.owners.tolist(), made.sizes.tolist(), ends, strict=True):
        loop = np.concatenate([line[:-1] for line in lines[end - size : end]])
        paths[owner].addPolygon(polygon(view.to_screen(loop)))
        paths[owner].closeSubpath()
    return paths


def _in_sight(made: NewMesh, view: Viewport) -> np.ndarray:
    """(e, 2) the inner edges that may be visible; all of a large mesh, if all may be."""
    box = view.to_screen(np.array([made.low, made.high]))
    if len(made.edges) > LINES and (box >= 0).all() and (box <= view.size).all():
        return made.edges
    places = view.to_screen(made.points)
    one, other = places[made.edges[:, 0]], places[made.edges[:, 1]]
    seen = (np.maximum(one, other) >= 0) & (np.minimum(one, other) <= view.size)
    found: np.ndarray = made.edges[seen.all(axis=1)]
    return found


def squares(
    painter: QPainter,
    places: np.ndarray,
    theme: Theme,
    side: float = CORNER,
    hollow: bool = False,
) -> None:
    """Draw corners, whose places are pixels (n, 2), or anchors, which are ``hollow``."""
    painter.setPen(_pen(theme.corner, 1.0) if hollow else Qt.PenStyle.NoPen)
    painter.setBrush(QColor(theme.background if hollow else theme.corner))
    side -= 1.0 if hollow else 0.0
    for x, y in places.tolist():
        painter.drawRect(QRectF(x - side / 2, y - side / 2, side, side))


def polygon(places: np.ndarray) -> QPolygonF:
    """Pixels (n, 2) as a QPolygonF."""
    return QPolygonF([QPointF(x, y) for x, y in places.tolist()])


def _discs(painter: QPainter, made: NewMesh, view: Viewport, theme: Theme) -> None:
    vertices = np.flatnonzero(made.delta)
    places = view.to_screen(made.points[vertices])
    inside = ((places >= -LARGEST) & (places <= np.array(view.size) + LARGEST)).all(axis=1)
    vertices, places = vertices[inside], places[inside]
    if len(vertices) > DISCS:
        return
    wanted = np.minimum(BASE_RADIUS + GROWTH * (np.abs(made.delta[vertices]) - 1), LARGEST)
    room = CROWDED * made.reach[vertices] * view.pixels
    radii = np.maximum(np.minimum(_SMALLER * wanted, room), SMALLEST)
    font = tabular(QFont(painter.font()))
    font.setWeight(QFont.Weight.DemiBold)
    order = np.argsort(-radii, kind="stable")
    for i, radius in zip(order.tolist(), radii[order].tolist(), strict=True):
        delta = int(made.delta[vertices[i]])
        x, y = places[i].tolist()
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(theme.plus if delta > 0 else theme.minus))
        painter.drawEllipse(QPointF(x, y), radius, radius)
        if radius >= READABLE:
            font.setPixelSize(max(8, round(1.1 * radius)))
            painter.setFont(font)
            painter.setPen(QColor(theme.marker_text))
            box = QRectF(x - radius, y - radius, 2 * radius, 2 * radius)
            painter.drawText(box, Qt.AlignmentFlag.AlignCenter, label(delta))


def blend(one: str, other: str, share: float) -> QColor:
    """A colour between two, ``share`` of the way from the first."""
    a, b = QColor(one), QColor(other)
    return QColor.fromRgbF(
        (1 - share) * a.redF() + share * b.redF(),
        (1 - share) * a.greenF() + share * b.greenF(),
        (1 - share) * a.blueF() + share * b.blueF(),
        (1 - share) * a.alphaF() + share * b.alphaF(),
    )


def _pen(colour: str, width: float) -> QPen:
    pen = QPen(QColor(colour), width)
    pen.setCapStyle(Qt.PenCapStyle.RoundCap)
    pen.setJoinStyle(Qt.PenJoinStyle.RoundJoin)
    return pen
