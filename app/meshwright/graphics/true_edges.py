"""The true edges of a mesh as polylines for a view: what the window draws, tints and picks.

Most edges are straight, and a mesh of straight ones costs nothing here. Those that follow a curve
are replaced by polylines that deviate from it by less than a visible distance; these are made again
when the view has been zoomed or moved too far.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from meshwright.graphics.viewport import Viewport
from meshwright_core import HalfEdgeMesh
from meshwright_core.core.arrays import HALF, TWIN
from meshwright_core.geometry.edge_curves import bent_edges, curve_halfedges, ends_of
from meshwright_core.geometry.edge_parts import EdgeParts

TOLERANCE = 0.1
"""Pixels that a polyline may deviate from its edge when it is made."""
CLOSER, FARTHER = 2.0, 0.2
"""Polylines are made again when the zoom has grown beyond, or shrunk below, these factors."""
AROUND = 1.0
"""Edges are drawn finely this far around the view, in widths and heights of it."""
OUTSIDE = 0.002
"""Tolerance elsewhere, relative to the size of the mesh."""


class TrueEdges:
    """The edges of one state of ``mesh`` as they are; make a new one after edits.

    Attributes: ``halfedges`` (c,) half-edges that are not straight, ascending; ``elements`` (e,)
    the elements with such a side, ascending.
    """

    def __init__(self, mesh: HalfEdgeMesh) -> None:
        self._mesh = mesh
        on_curves = curve_halfedges(mesh)
        twins = mesh.arrays.edge[on_curves, TWIN]
        self._between = on_curves[on_curves < twins]  # one half-edge of each edge of an interface
        bent = bent_edges(mesh, on_curves)
        self._parts = EdgeParts(mesh.arrays.curves, bent.curve, bent.span, bent.ends)
        self.halfedges: np.ndarray = bent.halfedges
        self.elements: np.ndarray = np.unique(self.halfedges // mesh.k)
        self._corners = mesh.points[mesh.corners(self.elements), :2]
        corners = self._parts.ends.reshape(-1, 3)[:, :2]
        self._size = float(np.ptp(corners, axis=0).max()) if len(corners) else 0.0
        self._pixels = 0.0
        self._box = np.zeros((2, 2))
        self._points = np.zeros((0, 2))
        self._first = np.zeros(1, np.int64)
        self._loops: list[np.ndarray] | None = None
        self._interfaces: list[np.ndarray] | None = None

    def __bool__(self) -> bool:
        """Whether any edge is not straight."""
        return bool(len(self.halfedges))

    def look(self, viewport: Viewport) -> bool:
        """Make the polylines fine enough for a view; True if they have changed."""
        if not len(self.halfedges):
            return False
        box = _box(viewport, 0.0)
        zoom = viewport.pixels / self._pixels if self._pixels else np.inf
        inside = (box[0] >= self._box[0]).all() and (box[1] <= self._box[1]).all()
        if inside and FARTHER <= zoom <= CLOSER:
            return False
        self._pixels, self._box = viewport.pixels, _box(viewport, AROUND)
        tolerance = TOLERANCE / viewport.pixels
        points, self._first = self._parts.polylines(
            tolerance, self._box, max(OUTSIDE * self._size, tolerance)
        )
        self._points = points[:, :2]
        self._loops = self._interfaces = None
        return True

    @property
    def points(self) -> np.ndarray:
        """(n, 2) points that span the box around the mesh: its vertices, and those of curves."""
        mesh = self._mesh
        return np.concatenate([mesh.points[mesh.vertices(), :2], self._points])

    def line(self, halfedge: int) -> np.ndarray:
        """(n, 2) the edge of a half-edge, from its origin to its target."""
        row = _row(self.halfedges, halfedge)
        if row >= 0 and len(self._points):
            return np.asarray(self._points[self._first[row] : self._first[row + 1]])
        element, side = divmod(halfedge, self._mesh.k)
        corners = self.corners(element)
        return np.asarray(corners[[side, (side + 1) % len(corners)]])

    def corners(self, element: int) -> np.ndarray:
        """(k, 2) the corners of an element."""
        row = _row(self.elements, element)
        if row >= 0:
            return np.asarray(self._corners[row])
        mesh = self._mesh
        return np.asarray(mesh.points[mesh.corners(np.array([element]))[0], :2])

    def sides(self, element: int) -> list[np.ndarray]:
        """The sides of an element, each (n, 2), counter-clockwise."""
        k = self._mesh.k
        return [self.line(k * element + side) for side in range(k)]

    def outline(self, element: int) -> np.ndarray:
        """(n, 2) an element as a polygon, counter-clockwise."""
        return np.concatenate([side[:-1] for side in self.sides(element)])

    def outlines(self, elements: Iterable[int]) -> list[np.ndarray]:
        """Elements as polygons, each (n, 2)."""
        return [self.outline(int(element)) for element in elements]

    def loops(self) -> list[np.ndarray]:
        """The boundary loops, each (n, 2) and ending with its first point."""
        if self._loops is None:
            self._loops = self._closed_lines()
        return self._loops

    def interfaces(self) -> list[np.ndarray]:
        """The edges between two regions, each (n, 2)."""
        if self._interfaces is None:
            self._interfaces = [self.line(halfedge) for halfedge in self._between.tolist()]
        return self._interfaces

    def _closed_lines(self) -> list[np.ndarray]:
        mesh = self._mesh
        loops = mesh.boundary_loops()
        halfedges = mesh.arrays.vertex[np.concatenate(loops), HALF].astype(np.int64)
        points, first = _without_last(*self.lines(halfedges))
        ends = first[np.cumsum([len(loop) for loop in loops])[:-1]]
        return [np.concatenate([loop, loop[:1]]) for loop in np.split(points, ends)]

    def lines(self, halfedges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The edges of half-edges (n,), one after the other: points (p, 2), and the first of each
        edge (n + 1,).
        """
        mesh = self._mesh
        ends = mesh.points[ends_of(mesh, halfedges), :2]
        rows = np.searchsorted(self.halfedges, halfedges)
        inside = np.minimum(rows, len(self.halfedges) - 1)
        bent = np.zeros(len(halfedges), bool)
        if len(self._points):
            bent = self.halfedges[inside] == halfedges
        begin = np.zeros(len(halfedges), np.int64)
        begin[bent] = self._first[rows[bent]]
        counts = np.full(len(halfedges), 2)
        counts[bent] = self._first[rows[bent] + 1] - begin[bent]
        first = np.concatenate([[0], np.cumsum(counts)])
        owner = np.repeat(np.arange(len(halfedges)), counts)
        step = np.arange(len(owner)) - first[owner]
        pool = np.concatenate([ends.reshape(-1, 2), self._points])
        place = np.where(bent[owner], 2 * len(halfedges) + begin[owner], 2 * owner) + step
        return pool[place], first

    def curved_outlines(self) -> tuple[np.ndarray, np.ndarray]:
        """All of ``elements`` as polygons, one after the other: points (p, 2), and the first of
        each (e + 1,).
        """
        k = self._mesh.k
        halfedges = (k * self.elements[:, None] + np.arange(k)).ravel()
        points, first = _without_last(*self.lines(halfedges))
        return points, first[::k]


def _without_last(points: np.ndarray, first: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Polylines, as :meth:`TrueEdges.lines` gives them, without the last point of each."""
    kept = np.ones(len(points), bool)
    kept[first[1:] - 1] = False
    return points[kept], first - np.arange(len(first))


def polygons(
    corners: np.ndarray, elements: np.ndarray, edges: TrueEdges | None
) -> list[np.ndarray]:
    """Elements (m,) with ``corners`` (m, k, 2) as polygons, each (n, 2) in the plane: those with
    curved sides as ``edges`` has them.
    """
    found = list(corners)
    if edges:
        for row in np.flatnonzero(np.isin(elements, edges.elements)).tolist():
            found[row] = edges.outline(int(elements[row]))
    return found


def polylines(parts: EdgeParts, viewport: Viewport) -> list[np.ndarray]:
    """Edges that need not be in a mesh, each (n, 2) in the plane, as fine as the view demands."""
    points, first = parts.polylines(TOLERANCE / viewport.pixels, _box(viewport, 0.0))
    return np.split(points[:, :2], first[1:-1]) if len(parts) else []


def _row(ids: np.ndarray, wanted: int) -> int:
    """The row of ascending ids where one stands, -1 if it does not."""
    row = int(np.searchsorted(ids, wanted))
    return row if row < len(ids) and ids[row] == wanted else -1


def _box(viewport: Viewport, around: float) -> np.ndarray:
    """(2, 2) the corners of what is in view, enlarged by ``around`` of its size on each side."""
    half = np.array(viewport.size) / (2.0 * viewport.pixels) * (1.0 + 2.0 * around)
    centre = np.array(viewport.centre)
    return np.stack([centre - half, centre + half])
