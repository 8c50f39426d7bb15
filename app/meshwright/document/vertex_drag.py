"""Dragging vertices with the mouse: their positions, and the shapes of the elements around them.

Inner vertices follow the mouse, boundary vertices slide along their side between their neighbours
on it, corners and locked vertices stay. The mesh is not changed: the caller submits
:attr:`Drag.vertices` and :attr:`Drag.places` to the document at the end.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from meshwright_core import HalfEdgeMesh
from meshwright_core.core.arrays import FLAGS, GEOMETRIC, LOCKED
from meshwright_core.core.composite_curves import curve_length, nearest_between
from meshwright_core.geometry import movable_part
from meshwright_core.geometry.edge_curves import points_of_edge

KEPT = 0.02
"""Distance that a sliding vertex keeps from its neighbours, as a fraction of their distance."""
CORNER = "A corner keeps its position: free it in its menu first."
PIECES = np.linspace(0.0, 1.0, 17)
"""Places of the ends of the segments that stand for a curved edge."""
LOCK = "This vertex is locked: unlock it in its menu first."


def refusal(mesh: HalfEdgeMesh, vertex: int) -> str:
    """Why a vertex cannot be dragged, in a sentence; empty if it can."""
    flags = int(mesh.arrays.vertex[vertex, FLAGS])
    if flags & GEOMETRIC:
        return CORNER
    return LOCK if flags & LOCKED else ""


class Drag:
    """One drag of ``vertices``, of which ``grabbed`` is under the mouse.

    Corners and locked vertices among them stay. Attributes: ``vertices`` (n,) ids of those that
    move.
    """

    def __init__(self, mesh: HalfEdgeMesh, vertices: Sequence[int], grabbed: int) -> None:
        ids = np.unique(np.asarray(vertices, np.int64))
        flags = mesh.arrays.vertex[ids, FLAGS]
        self.vertices = ids[(flags & (GEOMETRIC | LOCKED)) == 0]
        self._mesh = mesh
        self._part = movable_part.around(mesh, self.vertices)
        self._rows = np.searchsorted(self._part.vertices, self.vertices)
        self._start = self._part.points[self._rows].copy()
        self._origin = mesh.points[grabbed].copy()
        elements = self._part.elements
        a, b = elements.ravel(), np.roll(elements, -1, axis=1).ravel()
        pairs = np.column_stack([np.minimum(a, b), np.maximum(a, b)])
        moving = self._part.movable[pairs].any(axis=1)
        # each edge once, with the number of its curve where it bends
        self._edges, first = np.unique(pairs[moving], axis=0, return_index=True)
        curved = self._part.curved
        sides = np.full(elements.shape, -1, np.int64)
        sides[curved.element] = curved.sides
        side = sides.ravel()[moving][first]
        self._bent = np.column_stack([a[moving][first], b[moving][first], side])[side >= 0]
        self._edges = self._edges[side < 0]

    def to(self, x: float, y: float) -> None:
        """Move the grabbed vertex to (x, y), and the others with it."""
        step = np.array([x - self._origin[0], y - self._origin[1], 0.0])
        self._part.points[self._rows] = self._start + step
        for i in self._rows.tolist():
            if self._part.seats.curve[i] >= 0:
                self._part.seats.parameter[i] = self._nearest(i, self._part.points[i])
        self._part.settle()

    def _nearest(self, i: int, goal: np.ndarray) -> float:
        """The parameter of a sliding vertex nearest to ``goal``, between its neighbours."""
        part, seats = self._part, self._part.seats
        curve = int(seats.curve[i])
        goal = goal - seats.offset[i] - seats.parameter[i] * seats.slope[i]
        low, high = self._room(i)
        length = float(curve_length(part.curves, curve))
        best, found = np.inf, low
        # on closed curves the room may lie before the start or beyond the end
        for shift in (-length, 0.0, length) if part.curves.closed[curve] else (0.0,):
            start, stop = max(low - shift, 0.0), min(high - shift, length)
            if start > stop:
                continue
            t, away = nearest_between(part.curves, curve, goal, start, stop)
            if away < best:
                best, found = away, float(np.clip(t + shift, low, high))
        return found

    def _room(self, i: int) -> tuple[float, float]:
        """The range of the parameter of a vertex; half-way to a neighbour that moves too."""
        seats, home = self._part.seats, self._part.home
        bounds = []
        for neighbours, bound in ((seats.before, seats.low), (seats.after, seats.high)):
            other = int(neighbours[i])
            there = float(bound[i]) + (float(home[other]) if other >= 0 else 0.0)
            bounds.append(there if other < 0 else 0.5 * (there + float(home[i])))
        margin = KEPT * (bounds[1] - bounds[0])
        return bounds[0] + margin, bounds[1] - margin

    @property
    def places(self) -> np.ndarray:
        """(n, 3) where the vertices are now."""
        return self._part.points[self._rows]

    @property
    def parameters(self) -> np.ndarray:
        """(n,) the parameters there of those on curves, as :meth:`HalfEdgeMesh.move` takes them."""
        found: np.ndarray = self._part.parameters(self._mesh)[self._rows]
        return found

    @property
    def moved(self) -> bool:
        """Whether any vertex has moved."""
        return bool((self.places != self._start).any())

    @property
    def segments(self) -> np.ndarray:
        """(m, 2, 2) the moving edges at their present positions; curved ones in many pieces."""
        points, curved = self._part.points, self._part.curved
        found = [points[self._edges]]
        for a, b, side in self._bent.tolist():
            span = curved.base[side] + curved.parameter[[a, b]]
            ends = points[[a, b]]
            line = points_of_edge(curved.curves, int(curved.curve[side]), span, ends, PIECES)
            found.append(np.stack([line[:-1], line[1:]], axis=1))
        segments: np.ndarray = np.concatenate(found)[:, :, :2]
        return segments

    @property
    def folded(self) -> np.ndarray:
        """(f, k, 2) the corners of the elements that would be inverted."""
        bad = self._part.inverted_rows()
        corners: np.ndarray = self._part.points[self._part.elements[bad]][:, :, :2]
        return corners
