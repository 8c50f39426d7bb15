"""The drawing area: shapes drawn with the mouse and typed dimensions, with grid and snapping."""

from __future__ import annotations

import math

import numpy as np
from qtpy.QtCore import QPointF, QRectF, Qt, Signal
from qtpy.QtGui import (
    QColor,
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

from meshwright.desktop.files.new_mesh.sketch_painting import SketchPainting
from meshwright.graphics.theme import GRID, Theme
from meshwright.graphics.viewport import Viewport
from meshwright.sources.arc_edges import Place, circle_of, middle_of
from meshwright.sources.drawing_tools import ARC, LINE, MEASURE, RECTANGLE, Pencil
from meshwright.sources.polygon_checks import PolygonProblem
from meshwright.sources.polygon_sketch import Sketch
from meshwright.sources.snapping import Snap, Snapper
from meshwright_core.errors import MeshError

REACH = 9.0
"""Distance in pixels at which the mouse snaps to corners and lines."""
EXACT = ("point", "middle")
"""What places are taken from as they are, without rounding."""
_DRAG = 4.0
"""Pixels that the mouse must move before a press becomes a drag."""
_BEGIN, _CONTINUE = "0123456789.,-+\u2212", "<;x\u00d7 eE\u00b0"
"""Characters that typed dimensions begin with, and those that they hold besides."""
TOOL_KEYS = {"l": "line", "a": "arc", "r": "rectangle", "c": "circle", "m": "measure"}


class DrawingArea(QWidget):
    """Draws and edits a :class:`meshwright.sources.polygon_sketch.Sketch` with the tools of
    :class:`meshwright.sources.drawing_tools.Pencil`.

    ``hovered(x, y)``: the snapped position of the mouse; ``message(sentence)``: why a click would
    be refused; ``picked(loop, corner)`` when a corner is selected; ``tool_picked(name)`` when a
    key has chosen a tool; ``hinted(sentence)``: what can be typed, empty while nothing is.
    """

    hovered = Signal(float, float)
    message = Signal(str)
    picked = Signal(int, int)
    tool_picked = Signal(str)
    hinted = Signal(str)

    def __init__(self, sketch: Sketch, theme: Theme, parent: QWidget | None = None) -> None:
        super().__init__(parent)
        self.setAccessibleName("Drawing area")
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)
        self.setMouseTracking(True)
        self.setCursor(Qt.CursorShape.CrossCursor)
        self.setMinimumSize(232, 200)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Expanding)
        self.sketch = sketch
        self.pencil = Pencil(sketch)
        self._typed = ""
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

    @property
    def typed(self) -> str:
        """The dimensions that are being typed."""
        return self._typed

    def use(self, tool: str) -> None:
        """Draw with this tool."""
        self.pencil.tool = tool
        self._typed = ""
        self.select(None)
        self.hinted.emit("")

    def fit(self) -> None:
        """Fit the view to the drawing, or the square from -1 to 1."""
        places = [p for loop in self.sketch.loops for p in loop.flattened()[0].corners]
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
            self._moving = None
            if self.pencil.moves_corners and not self.pencil.begun:
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
        self._pressed = self._moving = None
        words = "" if moved else self._clicked(event.position(), held)
        self._snap = self._snapped(event.position())
        self._tell()
        if words:
            self.message.emit(words)
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

    def _clicked(self, place: QPointF, held: tuple[int, int] | None) -> str:
        """Give the tool the place of a click; returns why it could not be used."""
        if held is not None:
            last = len(self.sketch.loops) - 1
            if held == (last, 0) and self.sketch.open:
                self.sketch.close()
            return ""
        self._typed = ""
        return self.pencil.click(self._snapped(place).place)

    def _insert_at(self, place: QPointF) -> tuple[int, int] | None:
        """Insert a corner on the edge under the mouse, if there is one, and grab it."""
        mouse = np.array([place.x(), place.y()])
        for i, loop in enumerate(self.sketch.loops):
            flat, owners = loop.flattened()
            p = self.view.to_screen(np.array(flat.corners))
            along = np.roll(p, -1, axis=0) - p
            share = np.clip(
                ((mouse - p) * along).sum(axis=1) / np.maximum((along**2).sum(axis=1), 1e-300), 0, 1
            )
            apart = np.hypot(*(p + share[:, None] * along - mouse).T)
            row = int(np.argmin(apart))
            if apart[row] <= 0.6 * REACH:
                a, b = (np.array(flat.corners[k]) for k in (row, (row + 1) % len(p)))
                x, y = (a + share[row] * (b - a)).tolist()
                edge = owners[row]
                middle = middle_of(*loop.ends(edge), loop.bulge(edge))
                near = self.snapper.snap((x, y), REACH / self.view.pixels, middles=[middle])
                if near.met == "middle":
                    at = middle
                elif loop.bulge(edge):
                    at = self._on_edge(i, edge, (x, y))
                else:
                    at = self._rounded((x, y))
                self.sketch.insert(i, edge + 1, at)
                self._recorded = True  # insertion and drag are one edit
                return i, edge + 1
        return None

    def _on_edge(self, loop: int, edge: int, place: Place) -> Place:
        """The point of an arc nearest to a place close to it."""
        one = self.sketch.loops[loop]
        (x, y), radius = circle_of(*one.ends(edge), one.bulge(edge))
        away = math.dist(place, (x, y)) or 1.0
        return x + radius * (place[0] - x) / away, y + radius * (place[1] - y) / away

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
            self._plane(place), REACH / self.view.pixels, away, before, after,
            middles=self.sketch.middles(self._moving),
        )  # fmt: skip
        exact = self._snap.met in EXACT
        self.sketch.move(
            loop, corner, self._snap.place if exact else self._rounded(self._snap.place)
        )

    def _snapped(self, place: QPointF) -> Snap:
        where = self._plane(place)
        reach = REACH / self.view.pixels
        points = [p for _, _, p in self.sketch.corners()] + self.sketch.centres()
        pencil = self.pencil
        free = self.snapper.snap(where, reach, points, middles=self.sketch.middles())
        if free.met in EXACT:
            return free
        if pencil.tool == RECTANGLE or (pencil.tool == ARC and pencil.begun):
            return Snap(self._rounded(free.place), free.met)
        if pencil.tool not in (LINE, ARC):
            snap = self.snapper.snap(where, reach, points, pencil.start)
        elif not self.sketch.open:
            return free
        else:
            row = self.sketch.loops[-1].corners
            first = row[0] if len(row) > 1 else None
            behind = row[-2] if len(row) > 1 else None
            snap = self.snapper.snap(where, reach, points, row[-1] if row else None, first, behind)
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
        trial = self._trial()
        self.message.emit(trial.words if trial is not None else "")

    def _trial(self) -> PolygonProblem | None:
        """The problem that a click would cause, None if none."""
        draws = self.sketch.open and self.pencil.tool in (LINE, ARC)
        if self._snap is None or self._moving is not None or not draws:
            return None
        place = self._snap.place
        return self.sketch.trial(self.pencil.end_at(place), self.pencil.bulge_to(place))

    # Keys

    def take_back(self) -> None:
        """Forget what the tool was given, remove the last corner, or reopen the last loop."""
        if not self.pencil.cancel():
            self.sketch.take_back()
        self.update()

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802
        """Digits type dimensions; Return applies them, or closes the loop; Backspace undoes;
        Delete removes the selected corner; Escape cancels; letters choose tools.
        """
        key, text = event.key(), event.text()
        if self._typed:
            if self._edit_typed(key, text):
                return
        elif text and text in _BEGIN and self.pencil.hint:
            self._type(text)
            return
        if key == Qt.Key.Key_Backspace:
            self.take_back()
        elif key in (Qt.Key.Key_Return, Qt.Key.Key_Enter) and self.sketch.close():
            event.accept()
        elif key == Qt.Key.Key_Delete and self.selected is not None:
            self.sketch.remove(*self.selected)
        elif key == Qt.Key.Key_Escape and self.pencil.cancel():
            self.update()
        elif text.lower() in TOOL_KEYS and not event.modifiers() & Qt.KeyboardModifier.AltModifier:
            self.use(TOOL_KEYS[text.lower()])
            self.tool_picked.emit(self.pencil.tool)
        else:
            super().keyPressEvent(event)

    def _edit_typed(self, key: int, text: str) -> bool:
        """Handle a key while dimensions are typed; False if it is for something else."""
        if key in (Qt.Key.Key_Return, Qt.Key.Key_Enter):
            self._apply_typed()
        elif key == Qt.Key.Key_Escape:
            self._type("", self._typed)
        elif key == Qt.Key.Key_Backspace:
            self._typed = self._typed[:-1]
            self._type("")
        elif text and text in _BEGIN + _CONTINUE:
            self._type(text)
        else:
            return False
        return True

    def _type(self, text: str, drop: str = "") -> None:
        self._typed = "" if drop else self._typed + text
        self.hinted.emit(self.pencil.hint if self._typed else "")
        self.message.emit("")
        self.update()

    def _apply_typed(self) -> None:
        mouse = self._snap.place if self._snap is not None else None
        try:
            words = self.pencil.click(self.pencil.place_of(self._typed, mouse))
        except MeshError as error:
            self.message.emit(str(error))
            return
        self._typed = ""
        self.hinted.emit("")
        if self._mouse is not None:
            self._snap = self._snapped(self._mouse)
        self.message.emit(words)
        self.update()

    # Drawing

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802
        """Refit the view until the user has changed it."""
        if self._touched:
            self.view = self.view.resized(self.width(), self.height())
        else:
            self.fit()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802
        """Paint grid, sketch, errors, guide lines and what would be drawn next."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        frame = QPainterPath()
        frame.addRoundedRect(QRectF(self.rect()).adjusted(0.5, 0.5, -0.5, -0.5), 8, 8)
        painter.fillPath(frame, QColor(self._theme.background))
        painter.setClipPath(frame)
        self._paint(SketchPainting(painter, self.view, self._theme, self.font()))
        painter.setClipping(False)
        painter.setPen(QPen(QColor(self._theme.accent if self.hasFocus() else self._theme.line), 1))
        painter.setBrush(Qt.BrushStyle.NoBrush)
        painter.drawPath(frame)
        painter.end()

    def _paint(self, painting: SketchPainting) -> None:
        sketch, pencil, snap = self.sketch, self.pencil, self._snap
        painting.grid(self.grid)
        painting.loops(sketch.loops)
        measures = pencil.tool == MEASURE
        place = self._target()
        draft = pencil.draft(place)
        shown = snap is not None or bool(self._typed) or (measures and len(pencil.places) == 2)
        if snap is not None:
            painting.guides(snap)
        if shown and self._moving is None:
            painting.draft(draft, measures, self._trial() is not None)
        draws = sketch.open or pencil.tool not in (LINE, ARC)
        if snap is not None and self._moving is None and draws:
            painting.target(place, middle=snap.met == "middle")
        last = len(sketch.loops) - 1
        painting.corners(sketch.corners(), (last, 0) if sketch.open else None, self.selected)
        if sketch.problem is not None:
            painting.problem(sketch.problem, sketch.loops)
        if shown and (draws or self._moving is not None):
            where = f"{place[0]:.5g}, {place[1]:.5g}".replace("-", "\u2212")
            lines = (where,) if self._moving is not None else (draft.text, where)
            if measures and len(pencil.places) == 2:
                place, lines = pencil.places[1], (draft.text,)
            painting.label(place, lines, self._typed)

    def _target(self) -> Place:
        """Where the next click would be; while the mouse is elsewhere, where the drawing ends."""
        if self._snap is not None:
            return self._snap.place
        return self.pencil.start or self.view.centre
