"""What a drag of the mouse does: moves the picture, draws a box or a lasso, moves vertices."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from qtpy.QtCore import QPointF, Qt

from meshwright.desktop.canvas.layers.selection_band import BandLayer
from meshwright.desktop.canvas.layers.vertex_drag import RubberLayer
from meshwright.document.vertex_drag import Drag

if TYPE_CHECKING:
    from meshwright.desktop.canvas.canvas import Canvas

NEAR = 3.0
"""Pixels between the points of a lasso."""


class Gesture:
    """One drag, from the moment when it is no click any more. The base does nothing."""

    cursor = Qt.CursorShape.ArrowCursor
    of_mesh = True
    """Whether it is about the mesh as it is, and ends when that changes."""

    def move(self, at: QPointF) -> None:
        """The mouse is at ``at``, in pixels of the canvas."""

    def end(self, at: QPointF) -> None:
        """The button has been released at ``at``."""

    def cancel(self) -> None:
        """It shall be as if the drag had not been."""


class Pan(Gesture):
    """Moves the picture."""

    cursor = Qt.CursorShape.ClosedHandCursor
    of_mesh = False

    def __init__(self, canvas: Canvas, start: QPointF) -> None:
        self._canvas = canvas
        self._at = start

    def move(self, at: QPointF) -> None:
        """Move the picture along."""
        step = at - self._at
        self._at = at
        self._canvas.see(self._canvas.viewport.panned(step.x(), step.y()))


class Band(Gesture):
    """Draws a box, or a lasso, and hands its outline in pixels (n, 2) to ``choose``."""

    cursor = Qt.CursorShape.CrossCursor

    def __init__(
        self,
        layer: BandLayer,
        start: QPointF,
        lasso: bool,
        choose: Callable[[np.ndarray], None],
    ) -> None:
        self._layer = layer
        self._path = [start]
        self._lasso = lasso
        self._choose = choose

    def move(self, at: QPointF) -> None:
        """Stretch it to here."""
        if not self._lasso:
            a = self._path[0]
            self._layer.show([a, QPointF(at.x(), a.y()), at, QPointF(a.x(), at.y())])
            return
        if (at - self._path[-1]).manhattanLength() >= NEAR:
            self._path.append(at)
        self._layer.show(list(self._path))

    def end(self, at: QPointF) -> None:
        """Choose what lies inside."""
        self.move(at)
        outline = np.array([(point.x(), point.y()) for point in self._layer.outline])
        self._layer.show([])
        if len(outline) > 2:
            self._choose(outline)

    def cancel(self) -> None:
        """Take it away."""
        self._layer.show([])


class MoveVertices(Gesture):
    """Drags vertices; ``done(drag)`` at the end writes them to the document."""

    cursor = Qt.CursorShape.SizeAllCursor

    def __init__(
        self,
        canvas: Canvas,
        layer: RubberLayer,
        start: QPointF,
        grabbed: QPointF,
        drag: Drag,
        done: Callable[[Drag], None],
    ) -> None:
        self._canvas = canvas
        self._layer = layer
        self._offset = grabbed - start  # the vertex stays under the mouse as it was taken
        self._drag = drag
        self._done = done
        layer.begin(drag.segments, drag.places[:, :2].copy())

    def move(self, at: QPointF) -> None:
        """The vertices follow."""
        drag, place = self._drag, at + self._offset
        drag.to(*self._canvas.viewport.to_plane(place.x(), place.y()))
        self._layer.show(drag.segments, drag.folded, drag.places[:, :2])

    def end(self, at: QPointF) -> None:
        """Leave them here."""
        self.move(at)
        self._layer.clear()
        self._done(self._drag)

    def cancel(self) -> None:
        """They have not moved."""
        self._layer.clear()


class RefusedDrag(Gesture):
    """A drag of a vertex that must not move: calls ``explain`` once."""

    cursor = Qt.CursorShape.ForbiddenCursor

    def __init__(self, explain: Callable[[], None]) -> None:
        self._explain = explain
        self._explained = False

    def move(self, at: QPointF) -> None:
        """Explain the refusal at the first move."""
        if not self._explained:
            self._explained = True
            self._explain()
