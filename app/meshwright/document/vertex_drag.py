"""Dragging vertices with the mouse: their positions, and the shapes of the elements around them.

Inner vertices follow the mouse, those on the boundary or an interface slide along its true curve
between their neighbours there, corners and locked vertices stay. The mesh is not changed: the
caller submits :attr:`Drag.vertices`, :attr:`Drag.places` and :attr:`Drag.parameters` to the
document at the end.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from meshwright_core import HalfEdgeMesh
from meshwright_core.core.arrays import FLAGS, GEOMETRIC, LOCKED
from meshwright_core.core.composite_curves import nearest_between
from meshwright_core.geometry.edge_parts import EdgeParts
from meshwright_core.geometry.movable_part import around
from meshwright_core.geometry.seats import place_seats

KEPT = 0.02
"""Distance that a sliding vertex keeps from its neighbours, as a fraction of their distance."""
CORNER = "A corner keeps its position: free it in its menu first."
LOCK = "This vertex is locked: unlock it in its menu first."


def refusal(mesh: HalfEdgeMesh, vertex: int) -> str:
    """Why a vertex cannot be dragged, in a sentence; empty if it can."""
    flags = int(mesh.arrays.vertex[vertex, FLAGS])
    if flags & GEOMETRIC:
        return CORNER
    return LOCK if flags & LOCKED else ""


class Drag:
    """One drag of ``vertices``, of which ``grabbed`` is under the mouse.

    Corners and locked vertices among them stay. ``vertices`` (n,) are the ids of those that move.
    """

    def __init__(self, mesh: HalfEdgeMesh, vertices: Sequence[int], grabbed: int) -> None:
        self._mesh = mesh
        self._part = part = around(mesh, np.asarray(vertices, np.int64))
        self._rows = np.flatnonzero(part.movable)
        self.vertices: np.ndarray = part.vertices[self._rows]
        self._start = part.points[self._rows].copy()
        self._origin = mesh.points[grabbed].copy()
        self._slides = np.flatnonzero(part.seats.curve[self._rows] >= 0)
        self._lengths = mesh.boundary_info.lengths()
        self._ranges = np.array([self._range(row) for row in self._rows[self._slides]])
        halfedges = mesh.halfedges_of(part.element_ids).ravel()
        self._sides = EdgeParts.of(mesh.arrays, halfedges, mesh.k)
        corners = part.elements
        self._ends = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2)
        moves = part.movable[self._ends].any(axis=1)
        _, once = np.unique(np.sort(self._ends, axis=1), axis=0, return_index=True)
        self._edges = once[moves[once]]

    def _range(self, row: int) -> tuple[float, float]:
        """The parameters between which a sliding vertex may go, apart from its neighbours; half-way
        to a neighbour that moves too.
        """
        seats = self._part.seats
        here = float(seats.parameter[row])
        bounds = []
        for other, shift in (
            (seats.before[row], seats.low[row]),
            (seats.after[row], seats.high[row]),
        ):
            there = float(shift + (seats.parameter[other] if other >= 0 else 0.0))
            bounds.append(here + (0.5 if other >= 0 else 1.0) * (there - here))
        margin = KEPT * (bounds[1] - bounds[0])
        return bounds[0] + margin, bounds[1] - margin

    def to(self, x: float, y: float) -> None:
        """Move the grabbed vertex to (x, y), and the others with it."""
        part = self._part
        places = self._start + np.array([x - self._origin[0], y - self._origin[1], 0.0])
        part.points[self._rows] = places
        rows = self._rows[self._slides]
        for row, place, bounds in zip(
            rows.tolist(), places[self._slides], self._ranges.tolist(), strict=True
        ):
            seats = part.seats  # the side may lie off its curve
            goal = place - seats.offset[row] - seats.parameter[row] * seats.slope[row]
            seats.parameter[row] = self._nearest(int(seats.curve[row]), goal, *bounds)
        if len(rows):
            part.points[rows] = place_seats(part.curves, part.seats, rows)

    def _nearest(self, curve: int, place: np.ndarray, low: float, high: float) -> float:
        """The parameter in [low, high] of the point of a curve nearest to ``place``; a range on a
        closed curve may lie beyond its ends.
        """
        curves, length = self._part.curves, float(self._lengths[curve])
        if not curves.closed[curve]:
            return float(nearest_between(curves, curve, place, max(low, 0.0), min(high, length))[0])
        found = []
        for turn in range(int(np.floor(low / length)), int(np.floor(high / length)) + 1):
            first, last = max(low - turn * length, 0.0), min(high - turn * length, length)
            t, squared = nearest_between(curves, curve, place, first, last)
            found.append((squared, t + turn * length))
        return float(min(found)[1])

    @property
    def places(self) -> np.ndarray:
        """(n, 3) where the vertices are now; those on curves exactly there."""
        return self._part.points[self._rows].copy()

    @property
    def parameters(self) -> np.ndarray:
        """(n,) the parameters of those on curves, as :meth:`HalfEdgeMesh.move` takes them."""
        found: np.ndarray = self._part.parameters(self._mesh)[self._rows]
        return found

    @property
    def moved(self) -> bool:
        """Whether any vertex has moved."""
        return bool((self._part.points[self._rows] != self._start).any())

    @property
    def edges(self) -> EdgeParts:
        """The m edges that move, as they are now."""
        return self._moved(self._edges)

    @property
    def segments(self) -> np.ndarray:
        """(m, 2, 2) their ends."""
        return self.edges.ends[:, :, :2]

    @property
    def folded(self) -> np.ndarray:
        """(f, k, 2) the corners of the elements that would be inverted."""
        bad = self._part.inverted_rows()
        corners: np.ndarray = self._part.points[self._part.elements[bad]][:, :, :2]
        return corners

    @property
    def folded_sides(self) -> EdgeParts:
        """Their sides, k for each of the f elements in turn."""
        sides = np.arange(len(self._ends)).reshape(self._part.elements.shape)
        return self._moved(sides[self._part.inverted_rows()].ravel())

    def _moved(self, rows: np.ndarray) -> EdgeParts:
        """Sides of elements at the present positions and parameters."""
        part, ends = self._part, self._ends[rows]
        before = self._sides.take(rows)
        shift = part.seats.parameter[ends] - part.home[ends]
        return EdgeParts(part.curves, before.curve, before.span + shift, part.points[ends])
