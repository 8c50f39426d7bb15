"""Drag gestures: pan, select by box or lasso, move vertices."""

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
"""Minimum distance in pixels between the points of a lasso."""


class Gesture:
    """One drag, from the moment when the mouse has moved too far for a click. The base does
    nothing.
    """

    cursor = Qt.CursorShape.ArrowCursor
    of_mesh = True
    """Whether a change of the mesh cancels the gesture."""

    def move(self, at: QPointF) -> None:
        """Handle a move to ``at``, in pixels of the canvas."""

    def end(self, at: QPointF) -> None:
        """Handle the release of the button at ``at``."""

    def cancel(self) -> None:
        """Undo the effects of the drag."""


class Pan(Gesture):
    """Pans the view."""

    cursor = Qt.CursorShape.ClosedHandCursor
    of_mesh = False

    def __init__(self, canvas: Canvas, start: QPointF) -> None:
        self._canvas = canvas
        self._at = start

    def move(self, at: QPointF) -> None:
        """Pan by the distance since the last event."""
        step = at - self._at
        self._at = at
        self._canvas.see(self._canvas.viewport.panned(step.x(), step.y()))


class Band(Gesture):
    """Draws a box or a lasso, and calls ``choose`` with its outline (n, 2) in pixels."""

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
        """Extend the outline to ``at``."""
        if not self._lasso:
            a = self._path[0]
            self._layer.show([a, QPointF(at.x(), a.y()), at, QPointF(a.x(), at.y())])
            return
        if (at - self._path[-1]).manhattanLength() >= NEAR:
            self._path.append(at)
        self._layer.show(list(self._path))

    def end(self, at: QPointF) -> None:
        """Call ``choose`` with the outline."""
        self.move(at)
        outline = np.array([(point.x(), point.y()) for point in self._layer.outline])
        self._layer.show([])
        if len(outline) > 2:
            self._choose(outline)

    def cancel(self) -> None:
        """Remove the outline."""
        self._layer.show([])


class MoveVertices(Gesture):
    """Drags vertices, and calls ``done(drag)`` at the end."""

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
        self._offset = grabbed - start  # from the mouse to the vertex, kept during the drag
        self._drag = drag
        self._done = done
        layer.begin(drag)

    def move(self, at: QPointF) -> None:
        """Move the vertices."""
        drag, place = self._drag, at + self._offset
        drag.to(*self._canvas.viewport.to_plane(place.x(), place.y()))
        self._layer.show(drag)

    def end(self, at: QPointF) -> None:
        """Finish the drag."""
        self.move(at)
        self._layer.clear()
        self._done(self._drag)

    def cancel(self) -> None:
        """Discard the drag."""
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
