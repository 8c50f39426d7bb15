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
from meshwright_core.geometry.outline import place_all
from meshwright_core.geometry.quality import TOLERANCE, corner_sines, reference_normals
from meshwright_core.geometry.movable_part import elements_at
from meshwright_core.geometry.sides import Sides

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

    Corners and locked vertices among them stay. Attributes: ``vertices`` (n,) ids of those that
    move, ``places`` (n, 3) where they are now.
    """

    def __init__(self, mesh: HalfEdgeMesh, vertices: Sequence[int], grabbed: int) -> None:
        ids = np.unique(np.asarray(vertices, np.int64))
        flags = mesh.arrays.vertex[ids, FLAGS]
        self.vertices = ids[(flags & (GEOMETRIC | LOCKED)) == 0]
        self._start = mesh.points[self.vertices].copy()
        self.places = self._start.copy()
        self._origin = mesh.points[grabbed].copy()
        self._slides = np.flatnonzero(mesh.boundary()[self.vertices])
        self._sides = Sides(mesh, self.vertices[self._slides]) if len(self._slides) else None
        self._parameters: dict[int, np.ndarray] = {}
        self._measure(mesh)

    def _measure(self, mesh: HalfEdgeMesh) -> None:
        """Collect the surrounding elements in small arrays with local indices."""
        self._elements = elements_at(mesh, self.vertices)
        near, local = np.unique(mesh.corners(self._elements), return_inverse=True)
        self._corners = local.reshape(-1, mesh.k)
        self._points = mesh.points[near].copy()
        self._rows = np.searchsorted(near, self.vertices)
        moves = np.zeros(len(near), bool)
        moves[self._rows] = True
        a, b = self._corners.ravel(), np.roll(self._corners, -1, axis=1).ravel()
        pairs = np.column_stack([np.minimum(a, b), np.maximum(a, b)])
        self._edges = np.unique(pairs[moves[pairs].any(axis=1)], axis=0)
        flat = np.ptp(self._points[:, 2]) == 0.0 if len(near) else True
        normal = np.array([0.0, 0.0, 1.0]) if flat else None
        self._reference = reference_normals(self._points, self._corners, normal)
        if flat and len(near):
            areas = corner_sines(self._points, self._corners, self._reference).sum()
            self._reference *= 1.0 if areas >= 0 else -1.0

    def to(self, x: float, y: float) -> None:
        """Move the grabbed vertex to (x, y), and the others with it."""
        step = np.array([x - self._origin[0], y - self._origin[1], 0.0])
        self.places = self._start + step
        for row in self._slides.tolist():
            self.places[row] = self._on_side(row)
        self._points[self._rows] = self.places

    def _on_side(self, row: int) -> np.ndarray:
        """The position of a sliding vertex: on its side, between its neighbours."""
        assert self._sides is not None
        vertex = int(self.vertices[row])
        side, seat = self._sides.seat(vertex)
        _, wanted = self._sides.project(vertex, self.places[row])
        low, high = self._room(side, seat)
        length = self._sides.length(side)
        if self._sides.polylines.closed[side]:
            middle = 0.5 * (low + high)
            wanted += length * np.round((middle - wanted) / length)
        at = float(np.clip(wanted, low, high))
        return np.asarray(place_all(self._sides.polylines, np.array([side]), np.array([at]))[0])

    def _room(self, side: int, seat: int) -> tuple[float, float]:
        """The range of arc length for a vertex; half-way to a neighbour that moves too."""
        assert self._sides is not None
        if side not in self._parameters:
            self._parameters[side] = self._sides.parameters(side)
        t = self._parameters[side]
        closed = bool(self._sides.polylines.closed[side])
        length, count = self._sides.length(side), len(t)
        here, chain = float(t[seat]), self._sides.chains[side]
        bounds = []
        for step in (-1, 1):
            turns, other = divmod(seat + step, count) if closed else (0, seat + step)
            there = float(t[other]) + turns * length
            share = 0.5 if int(chain[other]) in self.vertices else 1.0
            bounds.append(here + share * (there - here))
        margin = KEPT * (bounds[1] - bounds[0])
        return bounds[0] + margin, bounds[1] - margin

    @property
    def moved(self) -> bool:
        """Whether any vertex has moved."""
        return bool((self.places != self._start).any())

    @property
    def segments(self) -> np.ndarray:
        """(m, 2, 2) the moving edges at their present positions."""
        segments: np.ndarray = self._points[self._edges][:, :, :2]
        return segments

    @property
    def folded(self) -> np.ndarray:
        """(f, k, 2) the corners of the elements that would be inverted."""
        sines = corner_sines(self._points, self._corners, self._reference)
        bad = sines.min(axis=1) <= TOLERANCE if len(sines) else np.zeros(0, bool)
        corners: np.ndarray = self._points[self._corners[bad]][:, :, :2]
        return corners
