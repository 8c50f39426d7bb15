"""Dragging a block edge slides its line."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from qtpy.QtCore import QPointF, Qt

from meshwright.desktop.canvas.canvas import Canvas
from meshwright.desktop.canvas.gestures import Gesture
from meshwright.desktop.canvas.layers.blocks import BlocksLayer
from meshwright.document.block_lines import FARTHEST, line_through, slid
from meshwright_core import HalfEdgeMesh, MeshError


class SlideLine(Gesture):
    """Shows where the line through a half-edge would go; ``done(halfedge, share)`` at the end."""

    cursor = Qt.CursorShape.SizeAllCursor

    def __init__(
        self,
        canvas: Canvas,
        layer: BlocksLayer,
        mesh: HalfEdgeMesh,
        halfedge: int,
        start: QPointF,
        done: Callable[[int, float], None],
    ) -> None:
        self._canvas, self._layer, self._mesh, self._halfedge = canvas, layer, mesh, halfedge
        self._start = np.array(canvas.viewport.to_plane(start.x(), start.y()))
        self._done = done
        self.share = 0.0
        line = line_through(mesh, halfedge)
        self._line = [mesh.origin(h) for h in line.halfedges]
        self._line.append(mesh.target(line.halfedges[-1]))

    def move(self, at: QPointF) -> None:
        """Follow the mouse: as far as it has gone towards the next line on either side."""
        mesh, h = self._mesh, self._halfedge
        twin = mesh.twin(h)
        if twin < 0:
            return
        away = np.array(self._canvas.viewport.to_plane(at.x(), at.y())) - self._start
        left = self._part(away, mesh.origin(h), mesh.origin(mesh.prev(h)))
        right = self._part(away, mesh.origin(h), mesh.target(mesh.next(twin)))
        share = left if left > 0.0 else -right if right > 0.0 else 0.0
        self.share = float(np.clip(share, -FARTHEST, FARTHEST))
        points = mesh.points.copy()
        try:
            move = slid(mesh, h, self.share)
            points[move.vertices] = move.positions
        except MeshError:
            pass  # said at the end
        self._layer.show_drag(points[self._line, :2])

    def _part(self, away: np.ndarray, vertex: int, other: int) -> float:
        along = self._mesh.points[other, :2] - self._mesh.points[vertex, :2]
        return float(away @ along / max(float(along @ along), 1e-300))

    def end(self, at: QPointF) -> None:
        """Slide the line."""
        self.move(at)
        self._layer.show_drag(None)
        self._done(self._halfedge, self.share)

    def cancel(self) -> None:
        """Leave the line where it is."""
        self._layer.show_drag(None)
