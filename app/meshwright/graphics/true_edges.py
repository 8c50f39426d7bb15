"""The true edges of a mesh as polylines for a view: what the window draws, tints and picks.

Most edges are straight, and a mesh of straight ones costs nothing here. Those that follow a curve
are replaced by polylines that deviate from it by less than a visible distance; these are made again
when the view has been zoomed or moved too far.
"""

from __future__ import annotations

import numpy as np

from meshwright.graphics.viewport import Viewport
from meshwright_core import HalfEdgeMesh
from meshwright_core.core.arrays import HALF, TWIN
from meshwright_core.geometry.edge_curves import bent_edges, curve_halfedges, ends_of
from meshwright_core.geometry.edge_lines import DrawnEdges
from meshwright_core.geometry.edge_parts import EdgeParts, without_last

TOLERANCE = 0.1
"""Pixels that a polyline may deviate from its edge when it is made."""
CLOSER, FARTHER = 2.0, 0.2
"""Polylines are made again when the zoom has grown beyond, or shrunk below, these factors."""
AROUND = 1.0
"""Edges are drawn finely this far around the view, in widths and heights of it."""
OUTSIDE = 0.002
"""Tolerance elsewhere, relative to the size of the mesh."""


class TrueEdges(DrawnEdges):
    """The edges of one state of ``mesh`` as they are; make a new one after edits.

    ``elements`` (e,), ascending, are those with a side that is not straight.
    """

    def __init__(self, mesh: HalfEdgeMesh) -> None:
        self.k, self._mesh = mesh.k, mesh
        on_curves = curve_halfedges(mesh)
        twins = mesh.arrays.edge[on_curves, TWIN]
        self._between = on_curves[on_curves < twins]  # one half-edge of each edge of an interface
        self.halfedges, self._parts = bent_edges(mesh, on_curves)
        self.elements: np.ndarray = np.unique(self.halfedges // mesh.k)
        corners = self._parts.ends.reshape(-1, 3)[:, :2]
        self._size = float(np.ptp(corners, axis=0).max()) if len(corners) else 0.0
        self._pixels = 0.0
        self._box = np.zeros((2, 2))
        self._curve = np.zeros((0, 2))
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
        self._curve = points[:, :2]
        self._loops = self._interfaces = None
        return True

    @property
    def points(self) -> np.ndarray:
        """(n, 2) points that span the box around the mesh: its vertices, and those of curves."""
        mesh = self._mesh
        return np.concatenate([mesh.points[mesh.vertices(), :2], self._curve])

    def sides(self, element: int) -> list[np.ndarray]:
        """The sides of an element, each (n, 2), counter-clockwise."""
        return [self.line(self.k * element + side) for side in range(self.k)]

    def outline(self, element: int) -> np.ndarray:
        """(n, 2) an element as a polygon, counter-clockwise."""
        return np.concatenate([side[:-1] for side in self.sides(element)])

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
        if not loops:  # a closed surface
            return []
        halfedges = mesh.arrays.vertex[np.concatenate(loops), HALF].astype(np.int64)
        points, first = without_last(*self.lines(halfedges))
        ends = first[np.cumsum([len(loop) for loop in loops])[:-1]]
        return [np.concatenate([loop, loop[:1]]) for loop in np.split(points, ends)]

    def _places(self, halfedges: np.ndarray) -> np.ndarray:
        return np.asarray(self._mesh.points[ends_of(self._mesh, halfedges), :2])


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


def _box(viewport: Viewport, around: float) -> np.ndarray:
    """(2, 2) the corners of what is in view, enlarged by ``around`` of its size on each side."""
    half = np.array(viewport.size) / (2.0 * viewport.pixels) * (1.0 + 2.0 * around)
    centre = np.array(viewport.centre)
    return np.stack([centre - half, centre + half])
