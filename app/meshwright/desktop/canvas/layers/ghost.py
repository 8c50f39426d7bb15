"""The preview of an operation: new edges dashed, removed edges faded, new vertices, new
irregularities, change of s.
"""

import numpy as np
from qtpy.QtCore import QPointF, QRect, QRectF, QSizeF, Qt
from qtpy.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPen

from meshwright.desktop.canvas.layers.base import Layer, pen
from meshwright.desktop.canvas.layers.edge_strokes import EdgeStrokes
from meshwright.document.operation_preview import Ghost
from meshwright.graphics.markers import label
from meshwright.graphics.theme import Theme

DASHES = [4.0, 2.5]
SLACK = 48.0
"""Pixels around the edges of a preview that its numbers may cover."""
ROOM = 26.0
"""Numbers are written where the edges at the half-edge are longer than this, in pixels."""
CROSS = 5.0
"""Half the size in pixels of the cross on a vertex that would be removed."""
RING = 3.5
"""Radius in pixels of the ring at a vertex that would be made."""
GAP = 14.0
"""Pixels between the tag and the hovered element."""
HIDES = 60.0
"""Cost of a hidden mark, as a distance in pixels, when the tag is placed."""
MOST = 24
"""No numbers are written if there are more than this, so that the mesh stays visible."""


class GhostLayer(Layer):
    """Edges of the previewed operation; lies below the markers, its :class:`GhostNumbers` above."""

    def __init__(self, theme: Theme, font: QFont) -> None:
        super().__init__(theme)
        self.ghost: Ghost | None = None
        self._added, self._removed = EdgeStrokes(), EdgeStrokes()
        self.numbers = GhostNumbers(theme, font, self)

    def show(
        self,
        ghost: Ghost | None,
        title: str = "",
        around: np.ndarray | None = None,
        marks: np.ndarray | None = None,
    ) -> None:
        """Show ``ghost``, or none, its ``title`` beside the places ``around`` (n, 2): the first two
        are the ends of the half-edge. The title keeps off ``marks`` (m, 2).
        """
        if ghost is None and self.ghost is None:
            return
        before = self.rect().united(self.numbers.rect())
        self.ghost = ghost
        self._added = EdgeStrokes(ghost.added_edges if ghost is not None else None)
        self._removed = EdgeStrokes(ghost.removed_edges if ghost is not None else None)
        self.numbers.show(title if ghost is not None else "", around, marks)
        self.changed(before.united(self.rect()).united(self.numbers.rect()))

    def rect(self) -> QRectF:
        """The area that is painted, in pixels; empty without a preview."""
        if self.ghost is None:
            return QRectF()
        low_x, low_y, high_x, high_y = self.ghost.bounds
        corners = self.viewport.to_screen(np.array([(low_x, high_y), (high_x, low_y)]))
        box = QRectF(QPointF(*corners[0].tolist()), QPointF(*corners[1].tolist()))
        width, height = self.viewport.size
        seen = QRectF(0.0, 0.0, width, height)
        return box.adjusted(-SLACK, -SLACK, SLACK, SLACK).intersected(seen)

    def paint(self, painter: QPainter, rect: QRect) -> None:
        """Paint removed edges in the colour of the elements, and new edges dashed."""
        if self.ghost is None or not self.rect().intersects(QRectF(rect)):
            return
        over = QColor(self.theme.fill)
        over.setAlpha(215)
        fading = pen(self.theme.fill, 4.0)
        fading.setColor(over)
        painter.setPen(fading)
        self._removed.draw(painter, self.viewport)
        halo = QColor(self.theme.background)
        halo.setAlpha(200)
        under = QPen(halo, 4.0, Qt.PenStyle.SolidLine, Qt.PenCapStyle.FlatCap)
        dashed = QPen(QColor(self.theme.arrow), 1.75, Qt.PenStyle.CustomDashLine)
        dashed.setCapStyle(Qt.PenCapStyle.FlatCap)
        dashed.setDashPattern(DASHES)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        for each in (under, dashed):
            painter.setPen(each)
            self._added.draw(painter, self.viewport)
        self._paint_fresh(painter, self.ghost)

    def _paint_fresh(self, painter: QPainter, ghost: Ghost) -> None:
        """Paint a small ring where a vertex would be made."""
        if len(ghost.fresh) > MOST:
            return
        painter.setPen(pen(self.theme.arrow, 1.5))
        painter.setBrush(QColor(self.theme.background))
        for x, y in self.viewport.to_screen(ghost.fresh).tolist():
            painter.drawEllipse(QPointF(x, y), RING, RING)


class GhostNumbers(Layer):
    """The irregularities that vertices would have, and a tag with the operation and the change of
    s.
    """

    def __init__(self, theme: Theme, font: QFont, edges: GhostLayer) -> None:
        super().__init__(theme)
        self._edges = edges
        self._font = QFont(font)
        self._font.setWeight(QFont.Weight.DemiBold)
        self._title = ""
        self._around = np.zeros((2, 2))
        self._marks = np.zeros((0, 2))

    @property
    def text(self) -> str:
        """The text of the tag, empty without a preview."""
        ghost = self._edges.ghost
        return "" if ghost is None else f"{self._title}  {label(ghost.change)}"

    def show(self, title: str, around: np.ndarray | None, marks: np.ndarray | None) -> None:
        """Take over the arguments of :meth:`GhostLayer.show`."""
        self._title = title
        self._around = np.zeros((2, 2)) if around is None else around
        self._marks = np.zeros((0, 2)) if marks is None else marks

    def rect(self) -> QRectF:
        """The area of the tag, in pixels."""
        return self._tag().adjusted(-2, -2, 2, 2) if self._edges.ghost is not None else QRectF()

    def paint(self, painter: QPainter, rect: QRect) -> None:
        """Small pills beside the vertices, then the tag."""
        ghost = self._edges.ghost
        if ghost is None:
            return
        size = np.ptp(self.viewport.to_screen(self._around), axis=0).max()
        if size > ROOM and len(ghost.places) <= MOST:
            self._paint_numbers(painter, ghost)
            self._paint_gone(painter, ghost)
        self._paint_tag(painter, ghost)

    def _paint_gone(self, painter: QPainter, ghost: Ghost) -> None:
        """Paint a cross on every vertex that would be removed."""
        at = self.viewport.to_screen(ghost.gone).tolist() if len(ghost.gone) <= MOST else []
        for colour, width in ((self.theme.background, 6.0), (self.theme.text, 2.25)):
            painter.setPen(pen(colour, width))
            for x, y in at:
                painter.drawLine(QPointF(x - CROSS, y - CROSS), QPointF(x + CROSS, y + CROSS))
                painter.drawLine(QPointF(x - CROSS, y + CROSS), QPointF(x + CROSS, y - CROSS))

    def _paint_numbers(self, painter: QPainter, ghost: Ghost) -> None:
        font = QFont(self._font)
        font.setPixelSize(11)
        painter.setFont(font)
        metrics = QFontMetricsF(font)
        at = self.viewport.to_screen(ghost.places).tolist()
        for (x, y), delta in zip(at, ghost.delta.tolist(), strict=True):
            text = label(delta)
            width = metrics.horizontalAdvance(text) + 8.0
            pill = QRectF(x + 9.0, y - 23.0, width, 15.0)
            colour = self.theme.plus if delta > 0 else self.theme.minus
            rim = QPen(QColor(colour if delta else self.theme.faint), 1.25)
            painter.setPen(rim)
            painter.setBrush(QColor(self.theme.raised))
            painter.drawRoundedRect(pill, 7.5, 7.5)
            painter.setPen(QColor(self.theme.text))
            painter.drawText(pill, Qt.AlignmentFlag.AlignCenter, text)

    def _paint_tag(self, painter: QPainter, ghost: Ghost) -> None:
        tag = self._tag()
        painter.setPen(QPen(QColor(self.theme.line), 1.0))
        painter.setBrush(QColor(self.theme.raised))
        painter.drawRoundedRect(tag, 6.0, 6.0)
        painter.setFont(self._tag_font())
        painter.setPen(QColor(self.theme.text))
        inner = tag.adjusted(8, 0, -8, 0)
        left = Qt.AlignmentFlag.AlignLeft | Qt.AlignmentFlag.AlignVCenter
        right = Qt.AlignmentFlag.AlignRight | Qt.AlignmentFlag.AlignVCenter
        painter.drawText(inner, left, self._title)
        painter.setPen(QColor(change_colour(ghost.change, self.theme)))
        painter.drawText(inner, right, label(ghost.change))

    def _tag_font(self) -> QFont:
        font = QFont(self._font)
        font.setPixelSize(12)
        return font

    def _tag(self) -> QRectF:
        """The area of the tag beside the hovered element, where it hides least of the preview."""
        at = self.viewport.to_screen(self._around)
        size = QSizeF(QFontMetricsF(self._tag_font()).horizontalAdvance(self.text) + 24.0, 24.0)
        width, height = self.viewport.size
        room = QRectF(8.0, 8.0, width - 16.0 - size.width(), height - 16.0 - size.height())
        (left, top), (right, bottom) = at.min(axis=0).tolist(), at.max(axis=0).tolist()
        x, y = ((at[0] + at[1]) / 2.0).tolist()
        wide, high = size.width(), size.height()
        corners = (
            (right + GAP, y - high / 2),
            (left - GAP - wide, y - high / 2),
            (x - wide / 2, top - GAP - high),
            (x - wide / 2, bottom + GAP),
        )
        tags = [QRectF(_within(*corner, room), size) for corner in corners]
        middle = QPointF(x, y)
        return min(tags, key=lambda tag: self._cost(tag, middle))

    def _cost(self, tag: QRectF, middle: QPointF) -> float:
        """The cost of a position of the tag: distance from the half-edge plus marks that
        it hides.
        """
        ghost = self._edges.ghost
        away = tag.center() - middle
        cost = float(np.hypot(away.x(), 2.0 * away.y()))
        if ghost is None or len(ghost.added) > MOST:
            return cost
        added = ghost.added[:, None] if len(ghost.added) else np.zeros((0, 1, 2, 2))
        shares = np.array([0.15, 0.5, 0.85])[None, :, None]
        along = added[:, :, 0] * (1.0 - shares) + added[:, :, 1] * shares
        hidden = np.concatenate([along.reshape(-1, 2), ghost.places, self._marks])
        at = self.viewport.to_screen(hidden)
        wide = tag.adjusted(-8, -8, 8, 24)
        inside = (at[:, 0] > wide.left()) & (at[:, 0] < wide.right())
        inside &= (at[:, 1] > wide.top()) & (at[:, 1] < wide.bottom())
        return cost + HIDES * float(inside.sum())


def _within(x: float, y: float, room: QRectF) -> QPointF:
    return QPointF(
        min(max(x, room.left()), max(room.right(), room.left())),
        min(max(y, room.top()), max(room.bottom(), room.top())),
    )


def change_colour(change: int, theme: Theme) -> str:
    """The colour of a change of s: the accent colour for a decrease, the warning colour for an
    increase.
    """
    if change == 0:
        return theme.muted
    return theme.accent if change < 0 else theme.warning
