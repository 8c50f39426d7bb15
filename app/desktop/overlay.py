"""The overlay: what is drawn over the mesh without a frame of VTK's.

Markers with their numbers, the half-edge under the mouse, and small cards of text. A transparent
widget painted by QPainter: a hover repaints a few hundred pixels, at any size of mesh.
"""

import numpy as np
from qtpy.QtCore import QPoint, QPointF, QRect, QRectF, Qt, QTimer
from qtpy.QtGui import (
    QColor,
    QFont,
    QFontMetricsF,
    QPainter,
    QPainterPath,
    QPaintEvent,
    QPen,
    QPolygonF,
)
from qtpy.QtWidgets import QWidget

from app.markers import READABLE, Markers, label
from app.theme import Theme
from app.viewport import Viewport

CARD_SECONDS = 4.0
SLACK = 14
"""Pixels around the hovered element that its arrow may touch."""


class Overlay(QWidget):
    """Drawn over the canvas; mouse events fall through it."""

    def __init__(self, parent: QWidget, theme: Theme) -> None:
        super().__init__(parent)
        for attribute in (
            Qt.WidgetAttribute.WA_TransparentForMouseEvents,
            Qt.WidgetAttribute.WA_NoSystemBackground,
            Qt.WidgetAttribute.WA_TranslucentBackground,
        ):
            self.setAttribute(attribute)
        self.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._theme = theme
        self._marks: Markers | None = None
        self._viewport = Viewport()
        self._discs = np.empty((0, 5))  # x, y, radius, delta, corner? of visible irregular vertices
        self._corners = np.empty((0, 2))
        self._rings = np.empty((0, 2))
        self._outline = QPainterPath()
        self._element: QPolygonF | None = None
        self._side = 0
        self._card = ""
        self._card_at = QPoint()
        self._card_warns = False
        self._fade = QTimer(self)
        self._fade.setSingleShot(True)
        self._fade.timeout.connect(self.hide_card)

    # What to draw

    def set_theme(self, theme: Theme) -> None:
        """Draw in other colours."""
        self._theme = theme
        self.update()

    def set_markers(
        self, marks: Markers | None, viewport: Viewport, crowd: bool, outlined: bool
    ) -> None:
        """Draw these markers as seen through ``viewport``.

        Discs are VTK's where ``crowd``, the boundary is where ``outlined``.
        """
        self._marks, self._viewport = marks, viewport
        self._discs = np.empty((0, 5))
        self._corners = self._rings = np.empty((0, 2))
        self._outline = QPainterPath()
        if marks is not None:
            if not outlined:
                for loop in marks.loops:
                    points = viewport.to_screen(loop).tolist()
                    self._outline.addPolygon(QPolygonF([QPointF(x, y) for x, y in points]))
            self._rings = _inside(viewport.to_screen(marks.locked_places), viewport)
            if not crowd:
                corners = _inside(viewport.to_screen(marks.corner_places), viewport)
                self._corners = corners if len(corners) < 5000 else self._corners
                discs = np.column_stack(
                    (
                        viewport.to_screen(marks.places),
                        marks.radii(viewport),
                        marks.delta,
                        marks.corners,
                    )
                )
                self._discs = _inside(discs, viewport)
        self.update()

    def set_hover(self, corners: np.ndarray | None, side: int) -> None:
        """Show the arrow along edge ``side`` of the element with ``corners`` (k, 2) pixels."""
        before = self._hover_rect()
        self._side = side
        self._element = (
            None if corners is None else QPolygonF([QPointF(x, y) for x, y in corners.tolist()])
        )
        self.update(before.united(self._hover_rect()))

    def show_card(self, text: str, at: QPoint, warns: bool = False, fades: bool = False) -> None:
        """A small card of text near ``at``; ``warns`` for a refusal."""
        if (text, at) == (self._card, self._card_at):
            return
        before = self._card_rect()
        self._card, self._card_at, self._card_warns = text, at, warns
        self._fade.stop()
        if fades:
            self._fade.start(int(CARD_SECONDS * 1000))
        self.update(before.united(self._card_rect()).toAlignedRect())

    def hide_card(self) -> None:
        """Take the card away."""
        self._fade.stop()
        if self._card:
            before = self._card_rect()
            self._card = ""
            self.update(before.toAlignedRect())

    @property
    def card(self) -> str:
        """The text on the card, empty if there is none."""
        return self._card

    @property
    def warning(self) -> bool:
        """True while the card tells a refusal."""
        return bool(self._card) and self._card_warns

    # Drawing

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802
        """Paint what touches the region that Qt asks for."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        self._paint_element(painter)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(_pen(self._theme.boundary, 1.75))
        painter.drawPath(self._outline)
        self._paint_markers(painter, event.rect())
        self._paint_arrow(painter)
        self._paint_card(painter)
        painter.end()

    def _paint_element(self, painter: QPainter) -> None:
        if self._element is not None:
            tint = QColor(self._theme.arrow)
            tint.setAlpha(26)
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(tint)
            painter.drawPolygon(self._element)

    def _paint_markers(self, painter: QPainter, rect: QRect) -> None:
        near = QRectF(rect).adjusted(-24, -24, 24, 24)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(self._theme.corner))
        for x, y in self._corners.tolist():
            if near.contains(x, y):
                painter.drawRect(QRectF(x - 4.0, y - 4.0, 8.0, 8.0))
        plus, minus = QColor(self._theme.plus), QColor(self._theme.minus)
        halo = QPen(QColor(self._theme.background), 1.25)
        font = QFont(self.font())
        font.setWeight(QFont.Weight.DemiBold)
        for x, y, r, delta, corner in self._discs.tolist():
            if not near.contains(x, y):
                continue
            if corner:
                painter.setPen(Qt.PenStyle.NoPen)
                painter.setBrush(QColor(self._theme.corner))
                painter.drawRect(QRectF(x - r, y - r, 2 * r, 2 * r))
            painter.setPen(halo if r > 4 else Qt.PenStyle.NoPen)
            painter.setBrush(plus if delta > 0 else minus)
            painter.drawEllipse(QPointF(x, y), r, r)
            if r >= READABLE:
                font.setPixelSize(max(8, round(1.2 * r)))
                painter.setFont(font)
                painter.setPen(QColor(self._theme.marker_text))
                box = QRectF(x - 2 * r, y - 2 * r, 4 * r, 4 * r)
                painter.drawText(box, Qt.AlignmentFlag.AlignCenter, label(int(delta)))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(QColor(self._theme.boundary), 1.5))
        for x, y in self._rings.tolist():
            painter.drawEllipse(QPointF(x, y), 12.5, 12.5)

    def _paint_arrow(self, painter: QPainter) -> None:
        if self._element is None:
            return
        tail, head = arrow(self._element, self._side)
        along = head - tail
        length = float(np.hypot(along.x(), along.y()))
        if length < 1.0:
            return
        along /= length
        normal = QPointF(-along.y(), along.x())
        size = min(9.0, 0.45 * length)
        path = QPainterPath(head)
        path.lineTo(head - along * size + normal * (0.5 * size))
        path.lineTo(head - along * (0.72 * size))
        path.lineTo(head - along * size - normal * (0.5 * size))
        path.closeSubpath()
        end = head - along * (0.8 * size)
        painter.setPen(_pen(self._theme.background, 5.0))
        painter.drawLine(tail, end)
        painter.setPen(_pen(self._theme.arrow, 2.25))
        painter.drawLine(tail, end)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(self._theme.arrow))
        painter.drawPath(path)

    def _paint_card(self, painter: QPainter) -> None:
        if not self._card:
            return
        rect = self._card_rect().adjusted(2, 2, -2, -2)
        painter.setPen(QPen(QColor(self._theme.line), 1.0))
        back = self._theme.warning_soft if self._card_warns else self._theme.raised
        painter.setBrush(QColor(back))
        painter.drawRoundedRect(rect, 6.0, 6.0)
        painter.setFont(self._card_font())
        painter.setPen(QColor(self._theme.warning if self._card_warns else self._theme.text))
        inner = rect.adjusted(10, 6, -10, -6)
        painter.drawText(inner, self._flags(), self._card)

    def _flags(self) -> int:
        return int(Qt.AlignmentFlag.AlignLeft) | int(Qt.TextFlag.TextWordWrap)

    def _card_font(self) -> QFont:
        font = QFont(self.font())
        font.setPixelSize(12)
        return font

    def _card_rect(self) -> QRectF:
        """Where the card is, kept inside the canvas; empty without a card."""
        if not self._card:
            return QRectF()
        metrics = QFontMetricsF(self._card_font())
        text = metrics.boundingRect(QRectF(0, 0, 300, 400), self._flags(), self._card)
        width, height = text.width() + 26, text.height() + 18
        x = min(self._card_at.x() + 16.0, self.width() - width - 8)
        y = self._card_at.y() + 18.0
        if y + height > self.height() - 8:
            y = self._card_at.y() - height - 12
        return QRectF(max(x, 8.0), max(y, 8.0), width, height)

    def _hover_rect(self) -> QRect:
        if self._element is None:
            return QRect()
        box = self._element.boundingRect().toAlignedRect()
        return box.adjusted(-SLACK, -SLACK, SLACK, SLACK)


def arrow(element: QPolygonF, side: int) -> tuple[QPointF, QPointF]:
    """Tail and head of the arrow just inside ``element`` along its edge ``side``."""
    count = element.count()
    a, b = element.at(side), element.at((side + 1) % count)
    centre = QPointF(0.0, 0.0)
    for i in range(count):
        centre += element.at(i) / count
    # drawn in towards the centre by a tenth of the way, by 9 pixels at most
    middle = (a + b) / 2.0
    depth = float(np.hypot(centre.x() - middle.x(), centre.y() - middle.y()))
    share = min(0.22, 9.0 / max(depth, 1e-6))
    a, b = a + (centre - a) * share, b + (centre - b) * share
    trim = 0.12
    return a + (b - a) * trim, b - (b - a) * trim


def _pen(colour: str, width: float) -> QPen:
    return QPen(
        QColor(colour),
        width,
        Qt.PenStyle.SolidLine,
        Qt.PenCapStyle.RoundCap,
        Qt.PenJoinStyle.RoundJoin,
    )


def _inside(rows: np.ndarray, viewport: Viewport) -> np.ndarray:
    """The rows whose first two columns, pixels, lie in the view or just beside it."""
    x, y = rows[:, 0], rows[:, 1]
    width, height = viewport.size
    return rows[(x > -24) & (x < width + 24) & (y > -24) & (y < height + 24)]
