"""The drawing area: polygons drawn with the mouse, with grid, snapping and guide lines."""

from __future__ import annotations

import math

import numpy as np
from qtpy.QtCore import QPointF, QRectF, Qt, Signal
from qtpy.QtGui import (
    QColor,
    QFont,
    QFontMetricsF,
    QKeyEvent,
    QMouseEvent,
    QPainter,
    QPainterPath,
    QPaintEvent,
    QPen,
    QResizeEvent,
    QWheelEvent,
)
from qtpy.QtWidgets import QSizePolicy, QWidget

from meshwright.desktop.files.new_mesh.painting import polygon
from meshwright.desktop.widgets.basic import tabular
from meshwright.graphics.theme import GRID, Theme
from meshwright.graphics.viewport import Viewport
from meshwright.sources.polygon_checks import Place
from meshwright.sources.polygon_sketch import Sketch
from meshwright.sources.snapping import Snap, Snapper

REACH = 9.0
"""Distance in pixels at which the mouse snaps to corners and lines."""
CORNER = 8.0
CLOSED = "All loops are closed: click an edge to insert a corner, or press Add hole."
_CLOSEST_GRID = 7.0
"""Pixels between grid lines below which only every fifth or tenth is drawn."""
_DRAG = 4.0
"""Pixels that the mouse must move before a press becomes a drag."""


class DrawingArea(QWidget):
    """Draws and edits a :class:`meshwright.sources.polygon_sketch.Sketch`.

    ``hovered(x, y)``: the snapped position of the mouse; ``message(sentence)``: why a click would
    be refused; ``picked(loop, corner)`` when a corner is selected.
    """

    hovered = Signal(float, float)
    message = Signal(str)
    picked = Signal(int, int)

    def __init__(self, sketch: Sketch, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAccessibleName("Drawing area")
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMouseTracking(True)
        self.setCursor(Qt.CursorShape.CrossCursor)
        self.setMinimumSize(320, 240)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.sketch = sketch
        self.snapper = Snapper(grid=0.1)
        self.grid = 0.1
        self.view = Viewport(pixels=200.0)
        self.selected: tuple[int, int] | None = None
        self._theme = theme
        self._snap: Snap | None = None
        self._mouse: QPointF | None = None
        self._pressed: QPointF | None = None
        self._moving: tuple[int, int] | None = None
        self._recorded = False
        self._panning: QPointF | None = None
        self._touched = False
        sketch.changed.connect(self._on_changed)

    def release(self) -> None:
        """Disconnect from the sketch."""
        self.sketch.changed.disconnect(self._on_changed)

    def set_theme(self, theme: Theme) -> None:
        """Draw in the colours of ``theme``."""
        self._theme = theme
        self.update()

    def set_snapping(self, grid: float, snapper: Snapper) -> None:
        """Show a grid of this spacing, and snap by ``snapper``."""
        self.grid, self.snapper = grid, snapper
        self.update()

    def select(self, corner: tuple[int, int] | None) -> None:
        """Select a corner: (loop, corner)."""
        self.selected = corner
        self.update()

    def fit(self) -> None:
        """Fit the view to the drawing, or the square from -1 to 1."""
        places = [place for _, _, place in self.sketch.corners()]
        points = np.array(places if len(places) > 1 else [(-1.0, -1.0), (1.0, 1.0)])
        self.view = self.view.resized(self.width(), self.height()).fitted(points, 6 * GRID)
        self.update()

    def _on_changed(self) -> None:
        if self.selected is not None:
            loop, corner = self.selected
            loops = self.sketch.loops
            if loop >= len(loops) or corner >= len(loops[loop].corners):
                self.selected = None
        self.update()

    # Mouse

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """Left: grab a corner, or prepare to add one. Right: undo."""
        self.setFocus(Qt.FocusReason.MouseFocusReason)
        place = event.position()
        if event.button() == Qt.MouseButton.MiddleButton:
            self._panning = place
        elif event.button() == Qt.MouseButton.RightButton:
            self.take_back()
        elif event.button() == Qt.MouseButton.LeftButton:
            self._pressed, self._recorded = place, False
            self._moving = self._corner_at(place)
            if self._moving is None and not self.sketch.open:
                self._moving = self._insert_at(place)
            self.select(self._moving)
            if self._moving is not None:
                self.picked.emit(*self._moving)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """Pan, move a corner, or show where the next corner would be added."""
        place = event.position()
        self._mouse = place
        if self._panning is not None:
            step = place - self._panning
            self._panning, self._touched = place, True
            self.view = self.view.panned(step.x(), step.y())
        elif self._moving is not None and self._pressed is not None:
            if self._recorded or (place - self._pressed).manhattanLength() >= _DRAG:
                self._drag(place)
        else:
            self._snap = self._snapped(place)
        if self._snap is not None:
            self.hovered.emit(*self._snap.place)
        self._tell()
        self.update()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:  # noqa: N802
        """Add a corner, or close the loop at its first one; a drag just ends."""
        if event.button() == Qt.MouseButton.MiddleButton:
            self._panning = None
        if event.button() != Qt.MouseButton.LeftButton or self._pressed is None:
            return
        moved, held = self._recorded, self._moving
        was_open = self.sketch.open
        self._pressed = self._moving = None
        if not moved:
            self._clicked(event.position(), held)
        self._snap = self._snapped(event.position())
        self._tell()
        if held is None and not was_open:
            self.message.emit(CLOSED)
        self.update()

    def leaveEvent(self, event: object) -> None:  # noqa: N802
        """Hover nothing."""
        self._mouse = self._snap = None
        self.message.emit("")
        self.update()

    def wheelEvent(self, event: QWheelEvent) -> None:  # noqa: N802
        """Zoom at the mouse."""
        place = event.position()
        self._touched = True
        self.view = self.view.zoomed(1.0015 ** event.angleDelta().y(), place.x(), place.y())
        self.update()

    def _clicked(self, place: QPointF, held: tuple[int, int] | None) -> None:
        last = len(self.sketch.loops) - 1
        if held == (last, 0) and self.sketch.open and self.sketch.close():
            return
        if held is None and self.sketch.open:
            self.sketch.add(self._snapped(place).place)

    def _insert_at(self, place: QPointF) -> tuple[int, int] | None:
        """Insert a corner on the edge under the mouse, if there is one, and grab it."""
        for i, loop in enumerate(self.sketch.loops):
            p = self.view.to_screen(np.array(loop.corners))
            q = np.roll(p, -1, axis=0)
            mouse, along = np.array([place.x(), place.y()]), q - p
            share = np.clip(
                ((mouse - p) * along).sum(axis=1) / np.maximum((along**2).sum(axis=1), 1e-300), 0, 1
            )
            apart = np.hypot(*(p + share[:, None] * along - mouse).T)
            j = int(np.argmin(apart))
            if apart[j] <= 0.6 * REACH:
                a, b = np.array(loop.corners[j]), np.array(loop.corners[(j + 1) % len(p)])
                x, y = (a + share[j] * (b - a)).tolist()
                self.sketch.insert(i, j + 1, self._rounded((x, y)))
                self._recorded = True  # insertion and drag are one edit
                return i, j + 1
        return None

    def _drag(self, place: QPointF) -> None:
        assert self._moving is not None
        if not self._recorded:
            self.sketch.begin()
            self._recorded = True
        loop, corner = self._moving
        corners = self.sketch.loops[loop].corners
        closed, count = self.sketch.loops[loop].closed, len(corners)
        before = corners[corner - 1] if closed or corner > 0 else None
        after = corners[(corner + 1) % count] if closed or corner + 1 < count else None
        others = [p for i, j, p in self.sketch.corners() if (i, j) != self._moving]
        away = [p for p in others if p not in (before, after)]
        self._snap = self.snapper.snap(
            self._plane(place), REACH / self.view.pixels, away, before, after
        )
        self.sketch.move(loop, corner, self._rounded(self._snap.place))

    def _snapped(self, place: QPointF) -> Snap:
        where = self._plane(place)
        reach = REACH / self.view.pixels
        corners = [p for _, _, p in self.sketch.corners()]
        if not self.sketch.open:
            return self.snapper.snap(where, reach, corners)
        row = self.sketch.loops[-1].corners
        before = row[-1] if row else None
        snap = self.snapper.snap(
            where,
            reach,
            corners,
            before,
            row[0] if len(row) > 1 else None,
            row[-2] if len(row) > 1 else None,
        )
        return Snap(self._rounded(snap.place), snap.met, snap.guides)

    def _rounded(self, place: Place) -> Place:
        """The place rounded to about a pixel, so that the table stays readable."""
        digits = max(2, math.ceil(math.log10(self.view.pixels)) + 1)
        x, y = (round(n, digits) + 0.0 for n in place)
        return x, y

    def _plane(self, place: QPointF) -> Place:
        return self.view.to_plane(place.x(), place.y())

    def _corner_at(self, place: QPointF) -> tuple[int, int] | None:
        best, found = REACH, None
        for i, j, p in self.sketch.corners():
            x, y = self.view.to_screen(np.array(p)).tolist()
            apart = math.hypot(x - place.x(), y - place.y())
            if apart <= best:
                best, found = apart, (i, j)
        return found

    def _tell(self) -> None:
        words = ""
        if self._snap is not None and self._moving is None and self.sketch.open:
            trial = self.sketch.trial(self._snap.place)
            words = trial.words if trial is not None else ""
        self.message.emit(words)

    # Keys

    def take_back(self) -> None:
        """Remove the last corner, or reopen the last loop."""
        self.sketch.take_back()

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802
        """Backspace undoes, Return closes the loop, Delete removes the selected corner."""
        if event.key() == Qt.Key.Key_Backspace:
            self.take_back()
        elif event.key() in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self.sketch.close():
            event.accept()
        elif event.key() == Qt.Key.Key_Delete and self.selected is not None:
            self.sketch.remove(*self.selected)
        else:
            super().keyPressEvent(event)

    # Drawing

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802
        """Refit the view until the user has changed it."""
        if self._touched:
            self.view = self.view.resized(self.width(), self.height())
        else:
            self.fit()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802
        """Paint grid, polygon, errors, guide lines and the next corner."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        frame = QPainterPath()
        frame.addRoundedRect(QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5), 8, 8)
        painter.fillPath(frame, QColor(self._theme.background))
        painter.setClipPath(frame)
        self._paint_grid(painter)
        self._paint_loops(painter)
        self._paint_next(painter)
        self._paint_corners(painter)
        self._paint_problem(painter)
        painter.setClipping(False)
        painter.setPen(QPen(QColor(self._theme.accent if self.hasFocus() else self._theme.line), 1))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawPath(frame)
        painter.end()

    def _paint_grid(self, painter: QPainter) -> None:
        step = self.grid or 10.0 ** math.floor(math.log10(60.0 / self.view.pixels))
        for factor in (1, 5, 10, 50, 100, 500, 1000, 10_000, 100_000):
            if step * factor * self.view.pixels >= _CLOSEST_GRID:
                step *= factor
                break
        painter.setRenderHint(QPainter.RenderHint.Antialiasing, False)
        low = self.view.to_plane(0, self.height())
        high = self.view.to_plane(self.width(), 0)
        for axis in (0, 1):
            for k in range(math.floor(low[axis] / step), math.ceil(high[axis] / step) + 1):
                self._paint_grid_line(painter, axis, k, step)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)

    def _paint_grid_line(self, painter: QPainter, axis: int, k: int, step: float) -> None:
        strong = k % 5 == 0 or step * self.view.pixels > 60
        colour = QColor(self._theme.edge if k == 0 else self._theme.line)
        colour.setAlphaF(0.55 if k == 0 else 0.9 if strong else 0.4)
        painter.setPen(QPen(colour, 1))
        place = (k * step, 0.0) if axis == 0 else (0.0, k * step)
        x, y = self.view.to_screen(np.array(place)).tolist()
        if axis == 0:
            painter.drawLine(round(x), 0, round(x), self.height())
        else:
            painter.drawLine(0, round(y), self.width(), round(y))
        if strong and k % 5 == 0 and step * self.view.pixels * 5 > 40:
            painter.setPen(QColor(self._theme.faint))
            painter.setFont(self._small())
            text = f"{k * step:.6g}".replace("-", "\u2212")
            if axis == 0:
                painter.drawText(QPointF(x + 3, self.height() - 5), text)
            elif k != 0:
                painter.drawText(QPointF(6, y - 3), text)

    def _paint_loops(self, painter: QPainter) -> None:
        area = QPainterPath()
        for loop in self.sketch.loops:
            if loop.closed:
                area.addPolygon(polygon(self.view.to_screen(np.array(loop.corners))))
                area.closeSubpath()
        fill = QColor(self._theme.accent_soft)
        fill.setAlphaF(0.55)
        painter.fillPath(area, fill)
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.setPen(QPen(QColor(self._theme.boundary), 1.75))
        for loop in self.sketch.loops:
            if len(loop.corners) > 1:
                places = polygon(self.view.to_screen(np.array(loop.corners)))
                if loop.closed:
                    painter.drawPolygon(places)
                else:
                    painter.drawPolyline(places)

    def _paint_corners(self, painter: QPainter) -> None:
        last = len(self.sketch.loops) - 1
        for i, j, p in self.sketch.corners():
            x, y = self.view.to_screen(np.array(p)).tolist()
            first = self.sketch.open and (i, j) == (last, 0)
            side = CORNER + (4 if first else 0)
            box = QRectF(x - side / 2, y - side / 2, side, side)
            painter.setPen(QPen(QColor(self._theme.background), 1.5))
            painter.setBrush(QColor(self._theme.accent if first else self._theme.corner))
            painter.drawRect(box)
            if (i, j) == self.selected:
                painter.setPen(QPen(QColor(self._theme.accent), 2))
                painter.setBrush(Qt.BrushStyle.NoBrush)
                painter.drawRect(box.adjusted(-3.5, -3.5, 3.5, 3.5))

    def _paint_next(self, painter: QPainter) -> None:
        snap = self._snap
        if snap is None or self._mouse is None:
            return
        painter.setPen(QPen(QColor(self._theme.accent), 1, Qt.PenStyle.DotLine))
        for start, end in snap.guides:
            self._paint_guide(painter, start, end)
        place = QPointF(*self.view.to_screen(np.array(snap.place)).tolist())
        row = self.sketch.loops[-1].corners
        if self.sketch.open and self._moving is None:
            if row:
                wrong = self.sketch.trial(snap.place) is not None
                colour = self._theme.warning if wrong else self._theme.accent
                painter.setPen(QPen(QColor(colour), 1.75, Qt.PenStyle.DashLine))
                before = self.view.to_screen(np.array(row[-1])).tolist()
                painter.drawLine(QPointF(*before), place)
            painter.setPen(QPen(QColor(self._theme.accent), 1.75))
            painter.setBrush(QColor(self._theme.background))
            painter.drawEllipse(place, 5, 5)
        if self.sketch.open or self._moving is not None:
            self._paint_label(painter, place, snap.place)

    def _paint_guide(self, painter: QPainter, start: Place, end: Place) -> None:
        """Paint a line through both places, across the whole area."""
        p, q = self.view.to_screen(np.array([start, end]))
        along = q - p
        length = float(np.hypot(*along))
        if length > 0:
            reach = (self.width() + self.height()) * along / length
            painter.drawLine(QPointF(*(p - reach).tolist()), QPointF(*(p + reach).tolist()))

    def _paint_label(self, painter: QPainter, place: QPointF, where: Place) -> None:
        text = f"{where[0]:.4g}, {where[1]:.4g}".replace("-", "\u2212")
        font = self._small()
        metrics = QFontMetricsF(font)
        box = QRectF(0, 0, metrics.horizontalAdvance(text) + 12, metrics.height() + 4)
        box.moveTopLeft(place + QPointF(12, 12))
        if box.right() > self.width() - 4:
            box.moveRight(place.x() - 12)
        if box.bottom() > self.height() - 4:
            box.moveBottom(place.y() - 12)
        painter.setPen(QPen(QColor(self._theme.line), 1))
        painter.setBrush(QColor(self._theme.raised))
        painter.drawRoundedRect(box, 4, 4)
        painter.setFont(font)
        painter.setPen(QColor(self._theme.text))
        painter.drawText(box, Qt.AlignmentFlag.AlignCenter, text)

    def _paint_problem(self, painter: QPainter) -> None:
        problem = self.sketch.problem
        if problem is None:
            return
        colour = QColor(self._theme.warning)
        painter.setPen(QPen(colour, 3, Qt.PenStyle.DashLine))
        for i, j in problem.edges:
            loop = self.sketch.loops[i]
            if j + 1 < len(loop.corners) or loop.closed:
                ends = np.array([loop.corners[j], loop.corners[(j + 1) % len(loop.corners)]])
                p, q = self.view.to_screen(ends).tolist()
                painter.drawLine(QPointF(*p), QPointF(*q))
        painter.setPen(QPen(colour, 2.5))
        for spot in problem.places:
            x, y = self.view.to_screen(np.array(spot)).tolist()
            painter.drawLine(QPointF(x - 7, y - 7), QPointF(x + 7, y + 7))
            painter.drawLine(QPointF(x - 7, y + 7), QPointF(x + 7, y - 7))

    def _small(self) -> QFont:
        font = tabular(QFont(self.font()))
        font.setPixelSize(11)
        return font
