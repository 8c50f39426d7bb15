"""The edges of a mesh as they run: along their curves where they lie on one, else straight.

Curves are drawn as polylines that stay within a tolerance, so that a picture of any size shows
them round.
"""

from __future__ import annotations

import numpy as np

from meshwright_core.core.arrays import ORIGIN, TWIN
from meshwright_core.errors import MeshError
from meshwright_core.geometry.edge_curves import curved_edge_polylines
from meshwright_core.mesh import HalfEdgeMesh


class TrueEdges:
    """The edges of ``mesh`` in its present state, in the plane; they stay so when it changes.

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
        curved, first, points = curved_edge_polylines(mesh, tolerance)
        self._chain = np.full(len(edge), -1, np.int64)
        """The polyline of each half-edge, -1 for straight ones; -2 - i: polyline i backwards."""
        other = self._twin[curved]
        numbers = np.arange(len(curved))
        self._chain[other[other >= 0]] = -2 - numbers[other >= 0]
        self._chain[curved] = numbers
        self._first, self._curve = np.asarray(first), np.asarray(points)[:, :2]

    def once(self) -> np.ndarray:
        """(n,) half-edges, one of each edge."""
        return np.flatnonzero(
            (self._origin >= 0) & ((self._twin < 0) | (self._twin > np.arange(len(self._twin))))
        )

    def ends(self, halfedges: np.ndarray) -> np.ndarray:
        """(n, 2) vertices of half-edges (n,)."""
        return np.column_stack([self._origin[halfedges], self._origin[self._next[halfedges]]])

    def curved(self, halfedges: np.ndarray) -> np.ndarray:
        """(n,) whether the edges of half-edges (n,) are curved."""
        return self._chain[halfedges] != -1

    def line(self, halfedge: int) -> np.ndarray:
        """(m, 2) points from the origin of a half-edge to its target."""
        chain = int(self._chain[halfedge])
        if chain == -1:
            return self._points[self.ends(np.array([halfedge]))[0]]
        number = chain if chain >= 0 else -2 - chain
        points = self._curve[self._first[number] : self._first[number + 1]]
        return points if chain >= 0 else points[::-1]

    def pieces(self, halfedges: np.ndarray) -> np.ndarray:
        """(n, 2, 2) straight pieces that make up the edges of half-edges (m,), in no order."""
        chain = self._chain[halfedges]
        straight = self._points[self.ends(halfedges[chain == -1])]
        numbers = np.where(chain >= 0, chain, -2 - chain)[chain != -1]
        if not len(numbers):
            return straight
        counts = self._first[numbers + 1] - self._first[numbers] - 1
        begin = np.repeat(self._first[numbers] - np.cumsum(counts) + counts, counts)
        rows = begin + np.arange(len(begin))
        bent = np.stack([self._curve[rows], self._curve[rows + 1]], axis=1)
        return np.concatenate([straight, bent])

    def chained(self, halfedges: np.ndarray) -> np.ndarray:
        """(m, 2) points along half-edges (n,), each of which begins where the last one ends.

        The last point of all is left out: of a loop it is the first.
        """
        return np.concatenate([self.line(h)[:-1] for h in halfedges.tolist()])

    def outlines(self, elements: np.ndarray) -> list[np.ndarray]:
        """The outline (m, 2) of each of ``elements`` (n,), without its first point again."""
        h = np.asarray(elements, np.int64)[:, None] * self.k + np.arange(self.k)
        bent = self.curved(h).any(axis=1)
        straight = self._points[self._origin[h]]
        return [
            self.chained(row) if curved else corners
            for row, curved, corners in zip(h, bent.tolist(), straight, strict=True)
        ]

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
