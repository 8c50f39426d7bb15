"""The edges of a mesh as they run: along their curves where they lie on one, else straight.

Curves are drawn as polylines that stay within a tolerance, so that a picture of any size shows
them round.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from itertools import pairwise

import numpy as np

from meshwright_core.core.arrays import ORIGIN, TWIN
from meshwright_core.errors import MeshError
from meshwright_core.geometry.edge_curves import bent_edges
from meshwright_core.geometry.edge_parts import segments, without_last
from meshwright_core.mesh import HalfEdgeMesh


class DrawnEdges(ABC):
    """The edges of a mesh of ``k``-sided elements in the plane, curved ones as polylines.

    ``halfedges`` (c,), ascending, are those that are not straight.
    """

    k: int
    halfedges: np.ndarray
    _curve: np.ndarray
    """(p, 2) points of the polylines of ``halfedges``, and where each begins in ``_first``."""
    _first: np.ndarray

    @abstractmethod
    def _places(self, halfedges: np.ndarray) -> np.ndarray:
        """(n, 2, 2) positions of the ends of half-edges (n,)."""

    def curved(self, halfedges: np.ndarray) -> np.ndarray:
        """(n,) whether the edges of half-edges (n,) are curved."""
        return self._rows(halfedges) >= 0

    def line(self, halfedge: int) -> np.ndarray:
        """(m, 2) points from the origin of a half-edge to its target."""
        row = int(self._rows(np.array([halfedge]))[0])
        if row < 0:
            return np.asarray(self._places(np.array([halfedge]))[0])
        return np.asarray(self._curve[self._first[row] : self._first[row + 1]])

    def lines(self, halfedges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The edges of half-edges (n,), one after the other: points (p, 2), and the first of each
        edge (n + 1,).
        """
        halfedges = np.asarray(halfedges, np.int64)
        rows = self._rows(halfedges)
        bent = rows >= 0
        begin = np.zeros(len(halfedges), np.int64)
        begin[bent] = self._first[rows[bent]]
        counts = np.full(len(halfedges), 2)
        counts[bent] = self._first[rows[bent] + 1] - begin[bent]
        first = np.concatenate([[0], np.cumsum(counts)])
        owner = np.repeat(np.arange(len(halfedges)), counts)
        step = np.arange(len(owner)) - first[owner]
        pool = np.concatenate([self._places(halfedges).reshape(-1, 2), self._curve])
        place = np.where(bent[owner], 2 * len(halfedges) + begin[owner], 2 * owner) + step
        return pool[place], first

    def pieces(self, halfedges: np.ndarray) -> np.ndarray:
        """(n, 2, 2) straight pieces that make up the edges of half-edges (m,), in order."""
        return segments(*self.lines(halfedges))

    def chained(self, halfedges: np.ndarray) -> np.ndarray:
        """(m, 2) points along half-edges (n,), each of which begins where the last one ends.

        The last point of all is left out: of a loop it is the first.
        """
        return without_last(*self.lines(halfedges))[0]

    def outlines(self, elements: np.ndarray) -> list[np.ndarray]:
        """The outline (m, 2) of each of ``elements`` (n,), without its first point again."""
        points, first = self.joined_outlines(elements)
        bounds = first.tolist()
        return [points[a:b] for a, b in pairwise(bounds)]

    def joined_outlines(self, elements: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The outlines of elements (n,), one after the other: points (p, 2), and the first of
        each (n + 1,).
        """
        halfedges = self.k * np.asarray(elements, np.int64)[:, None] + np.arange(self.k)
        points, first = without_last(*self.lines(halfedges.ravel()))
        return points, first[:: self.k]

    def _rows(self, halfedges: np.ndarray) -> np.ndarray:
        """(n,) the rows of ``halfedges`` where those given stand, -1 for straight ones."""
        if len(self._first) < 2:
            return np.full(len(halfedges), -1)
        rows = np.minimum(np.searchsorted(self.halfedges, halfedges), len(self.halfedges) - 1)
        return np.where(self.halfedges[rows] == halfedges, rows, -1)


class EdgeLines(DrawnEdges):
    """The edges of ``mesh`` in its present state; they stay so when it changes.

    ``tolerance`` is the distance, in units of the mesh, between a curve and the polyline that is
    drawn for it.
    """

    def __init__(self, mesh: HalfEdgeMesh, tolerance: float) -> None:
        self.k = mesh.k
        edge = mesh.arrays.edge[: mesh.k * len(mesh.arrays.element_mark)]
        self._origin = edge[:, ORIGIN].astype(np.int64)
        self._twin = edge[:, TWIN].astype(np.int64)
        self._next = np.arange(len(edge)) + 1
        self._next[self.k - 1 :: self.k] -= self.k
        self._points = mesh.points[:, :2].copy()
        regions = mesh.arrays.region[: len(edge) // self.k]
        self._region = np.repeat(regions, self.k)
        self.region_count = max(int(regions[mesh.element_ids()].max(initial=0)) + 1, 1)
        self.halfedges, parts = bent_edges(mesh)
        points, self._first = parts.polylines(tolerance)
        self._curve = points[:, :2]

    def once(self) -> np.ndarray:
        """(n,) half-edges, one of each edge."""
        return np.flatnonzero(
            (self._origin >= 0) & ((self._twin < 0) | (self._twin > np.arange(len(self._twin))))
        )

    def ends(self, halfedges: np.ndarray) -> np.ndarray:
        """(n, 2) vertices of half-edges (n,)."""
        return np.column_stack([self._origin[halfedges], self._origin[self._next[halfedges]]])

    def _places(self, halfedges: np.ndarray) -> np.ndarray:
        return self._points[self.ends(halfedges)]

    def rims(self, region: int | None = None) -> list[np.ndarray]:
        """The half-edges (n,) around a region, or around the whole mesh, loop by loop in order.

        The region lies on their left.
        """
        live = self._origin >= 0
        rim = live & (self._twin < 0)
        if region is not None:
            across = np.where(self._twin >= 0, self._region[self._twin], -1)
            rim = live & (self._region == region) & (across != region)
        halfedges = np.flatnonzero(rim)
        following = self._next[halfedges]
        for _ in range(len(self._origin) + 1):
            inside = ~rim[following]
            if not inside.any():
                break
            following[inside] = self._next[self._twin[following[inside]]]
        else:
            raise MeshError("The boundary of this mesh has no end.")
        after = dict(zip(halfedges.tolist(), following.tolist(), strict=True))
        loops = []
        while after:
            start = next(iter(after))
            loop = [start]
            while (h := after.pop(loop[-1])) != start:
                loop.append(h)
            loops.append(np.array(loop, np.int64))
        return loops

    def interfaces(self) -> list[np.ndarray]:
        """Points (m, 2) along the interfaces of regions, each part of them once."""
        lines = []
        for region in range(self.region_count if self.region_count > 1 else 0):
            for loop in self.rims(region):
                shared = self._twin[loop] >= 0
                shared[shared] = self._region[self._twin[loop[shared]]] > region
                lines += [self._open(run) for run in _runs(loop, shared)]
        return lines

    def _open(self, halfedges: np.ndarray) -> np.ndarray:
        """(m, 2) points along half-edges (n,), to the end of the last one."""
        return np.vstack([self.chained(halfedges), self.line(int(halfedges[-1]))[-1:]])


def _runs(loop: np.ndarray, chosen: np.ndarray) -> list[np.ndarray]:
    """The parts of a loop that are chosen, each in order; round the loop where all are."""
    if chosen.all():
        return [loop]
    if not chosen.any():
        return []
    shift = int(np.flatnonzero(~chosen)[0])
    loop, chosen = np.roll(loop, -shift), np.roll(chosen, -shift)
    cuts = np.flatnonzero(np.diff(chosen.astype(np.int8))) + 1
    parts = zip(np.split(loop, cuts), np.split(chosen, cuts), strict=True)
    return [part for part, flags in parts if flags[0]]
