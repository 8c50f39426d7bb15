"""The layer of hints: previews of the policy's operations, each with a clickable badge."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from qtpy.QtCore import QPointF, QRect, QRectF, Qt
from qtpy.QtGui import QColor, QFont, QFontMetricsF, QPainter, QPen

from meshwright.desktop.canvas.layers.base import Layer, inside, pen
from meshwright.desktop.canvas.layers.edge_strokes import EdgeStrokes
from meshwright.desktop.canvas.layers.ghost import DASHES, change_colour
from meshwright.document.operation_preview import Ghost
from meshwright.graphics.markers import label
from meshwright.graphics.theme import Theme
from meshwright.graphics.viewport import Viewport

HEIGHT = 22.0
GAP = 4.0
MANY = 300
"""Badges avoid irregular vertices only up to this many visible ones."""
PALE = 120
"""Opacity, of 255, of the edges of hints other than the current one."""
_DISC = np.array([(0, 0), (8, 0), (-8, 0), (0, 8), (0, -8), (4, 4), (-4, -4), (4, -4), (-4, 4)])
_AROUND = ((1, -1), (-1, -1), (1, 1), (-1, 1), (1, 0), (-1, 0), (0, -1), (0, 1))


@dataclass(frozen=True)
class Hint:
    """One hint as it is shown."""

    number: int
    title: str
    probability: float
    ghost: Ghost
    place: np.ndarray
    """(2,) the middle of its half-edge."""
    is_next: bool = False
    """Whether *Step* applies it."""
    is_known: bool = False
    """Whether it is the next operation of a level's known solution."""

    @cached_property
    def strokes(self) -> tuple[EdgeStrokes, EdgeStrokes]:
        """The edges that it adds, and those that it removes."""
        return EdgeStrokes(self.ghost.added_edges), EdgeStrokes(self.ghost.removed_edges)

    @property
    def chance(self) -> str:
        """``63 %``, or ``par`` for the known solution."""
        return "par" if self.is_known else percent(self.probability)


class HintsLayer(Layer):
    """Edges of all hints, dashed; lies below the markers. The badges are :class:`HintBadges`."""

    def __init__(self, theme: Theme, font: QFont) -> None:
        super().__init__(theme)
        self.hints: tuple[Hint, ...] = ()
        self.meant = 0
        self.badges = HintBadges(theme, font, self)

    def show(self, hints: tuple[Hint, ...], marks: np.ndarray | None = None) -> None:
        """Show ``hints``, the first one in front; badges avoid covering ``marks`` (n, 2)."""
        if hints or self.hints:
            self.hints, self.meant = hints, 0
            self.badges.marks = np.zeros((0, 2)) if marks is None else marks
            self.badges.place()
            self.changed()

    def make_current(self, index: int) -> None:
        """Make the hint ``index`` the current one, which is painted in front."""
        if index != self.meant and 0 <= index < len(self.hints):
            self.meant = index
            self.changed()

    def at(self, point: QPointF) -> int:
        """The index of the hint whose badge lies at a pixel, -1 for none."""
        boxes = self.badges.boxes
        return next((i for i, box in enumerate(boxes) if box.contains(point)), -1)

    def paint(self, painter: QPainter, rect: QRect) -> None:
        """Paint the current hint last, with the edges that it removes."""
        if not self.hints:
            return
        for index, hint in enumerate(self.hints):
            if index != self.meant:
                self._paint_added(painter, hint, 1.5, PALE)
        meant = self.hints[self.meant]
        over = QColor(self.theme.fill)
        over.setAlpha(215)
        fading = pen(self.theme.fill, 4.0)
        fading.setColor(over)
        painter.setPen(fading)
        meant.strokes[1].draw(painter, self.viewport)
        self._paint_added(painter, meant, 2.25, 255)

    def _paint_added(self, painter: QPainter, hint: Hint, width: float, alpha: int) -> None:
        colour = QColor(self.theme.accent)
        colour.setAlpha(alpha)
        dashed = QPen(colour, width, Qt.PenStyle.CustomDashLine, Qt.PenCapStyle.FlatCap)
        dashed.setDashPattern(DASHES)
        painter.setPen(dashed)
        hint.strokes[0].draw(painter, self.viewport)


class HintBadges(Layer):
    """Number, probability and change of s of each hint, beside its half-edge."""

    def __init__(self, theme: Theme, font: QFont, edges: HintsLayer) -> None:
        super().__init__(theme)
        self._edges = edges
        self._font = QFont(font)
        self._font.setPixelSize(12)
        self._font.setWeight(QFont.Weight.DemiBold)
        self.boxes: list[QRectF] = []
        """Areas of the badges in pixels; empty for hints out of view."""
        self.marks = np.zeros((0, 2))
        """(n, 2) places that badges avoid covering."""
        self._roots: list[QPointF] = []

    def look(self, viewport: Viewport) -> None:
        """Follow a change of the view."""
        super().look(viewport)
        self.place()

    def place(self) -> None:
        """Put each badge beside its half-edge, clear of other badges and of dashed edges."""
        self.boxes, self._roots = [], []
        width, height = self.viewport.size
        metrics = QFontMetricsF(self._font)
        edges = [_points(self.viewport, hint.ghost.added) for hint in self._edges.hints]
        marks = inside(self.viewport.to_screen(self.marks), self.viewport)
        if len(marks) > MANY:
            marks = marks[:0]  # they are everywhere
        busy = np.concatenate([*edges, *(marks + offset for offset in _DISC)])
        for hint in self._edges.hints:
            x, y = self.viewport.to_screen(hint.place).tolist()
            self._roots.append(QPointF(x, y))
            if not (0 <= x <= width and 0 <= y <= height):
                self.boxes.append(QRectF())
                continue
            wide = HEIGHT + metrics.horizontalAdvance(_words(hint)) + 14.0
            room = QRectF(GAP, GAP, width - wide - 2 * GAP, height - HEIGHT - 2 * GAP)
            self.boxes.append(self._free_box(QPointF(x, y), wide, room, busy))

    def _free_box(self, root: QPointF, wide: float, room: QRectF, busy: np.ndarray) -> QRectF:
        """The box around ``root`` that covers least; ``room`` bounds its corner."""
        best, least = QRectF(), np.inf
        for ring in (1.0, 1.7, 2.6):
            for dx, dy in _AROUND:
                x = (
                    root.x()
                    + dx * ring * 16.0
                    + (0.0 if dx > 0 else -wide if dx < 0 else -wide / 2)
                )
                y = root.y() + dy * ring * 26.0 - HEIGHT / 2
                x = min(max(x, room.left()), room.right())
                y = min(max(y, room.top()), room.bottom())
                box = QRectF(x, y, wide, HEIGHT)
                covered = (
                    (busy[:, 0] > x) & (busy[:, 0] < x + wide)
                    & (busy[:, 1] > y) & (busy[:, 1] < y + HEIGHT)
                ).sum()  # fmt: skip
                near = box.adjusted(-GAP, -GAP, GAP, GAP)
                clashes = sum(other.intersects(near) for other in self.boxes)
                cost = 100.0 * clashes + float(covered) + 2.0 * ring
                if cost < least:
                    best, least = box, cost
        return best

    def paint(self, painter: QPainter, rect: QRect) -> None:
        """A disc with the number, then the numbers of the hint."""
        painter.setFont(self._font)
        for index, (root, box) in enumerate(zip(self._roots, self.boxes, strict=True)):
            if not box.isEmpty():
                colour = QColor(self.theme.accent)
                colour.setAlpha(255 if index == self._edges.meant else PALE)
                painter.setPen(QPen(colour, 1.25))
                painter.drawLine(root, box.center())
                painter.setBrush(colour)
                painter.drawEllipse(root, 2.5, 2.5)
        for index, (hint, box) in enumerate(zip(self._edges.hints, self.boxes, strict=True)):
            if not box.isEmpty() and box.intersects(QRectF(rect)):
                self._paint_badge(painter, hint, box, index == self._edges.meant)

    def _paint_badge(self, painter: QPainter, hint: Hint, box: QRectF, meant: bool) -> None:
        theme = self.theme
        painter.setPen(QPen(QColor(theme.accent if meant else theme.line), 1.5 if meant else 1.0))
        painter.setBrush(QColor(theme.raised))
        painter.drawRoundedRect(box, HEIGHT / 2, HEIGHT / 2)
        disc = QRectF(box.left(), box.top(), HEIGHT, HEIGHT).adjusted(2, 2, -2, -2)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(theme.accent if meant else theme.accent_soft))
        painter.drawEllipse(disc)
        painter.setPen(QColor(theme.accent_text if meant else theme.accent))
        painter.drawText(disc, Qt.AlignmentFlag.AlignCenter, str(hint.number))
        inner = box.adjusted(HEIGHT + 2, 0, -9, 0)
        painter.setPen(QColor(theme.text))
        middle = Qt.AlignmentFlag.AlignVCenter
        painter.drawText(inner, Qt.AlignmentFlag.AlignLeft | middle, hint.chance)
        painter.setPen(QColor(change_colour(hint.ghost.change, theme)))
        painter.drawText(inner, Qt.AlignmentFlag.AlignRight | middle, label(hint.ghost.change))


def percent(probability: float) -> str:
    """``63 %``; very small ones are ``< 1 %``."""
    return "< 1 %" if probability < 0.01 else f"{probability:.0%}".replace("%", "\u2009%")


def _points(viewport: Viewport, segments: np.ndarray) -> np.ndarray:
    """Pixels (n, 2) along line segments (m, 2, 2), closer together than a badge is wide."""
    ends = viewport.to_screen(segments.reshape(-1, 2)).reshape(-1, 2, 2)
    share = np.linspace(0.0, 1.0, 13)[:, None, None]
    return (ends[:, 0] + share * (ends[:, 1] - ends[:, 0])).reshape(-1, 2)


def _words(hint: Hint) -> str:
    return f"{hint.chance}   {label(hint.ghost.change)}"
