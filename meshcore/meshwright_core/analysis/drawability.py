"""Obstacles: features of the connectivity that rule out a valid embedding in the domain.

A mesh with an obstacle has an inverted element for all positions of its vertices, or too few
vertices on a curved side to follow it. A mesh without any nearly always has a valid embedding. The
count is a cheap necessary test that a search makes before untangling.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely

from meshwright_core.core.arrays import ELEMENT_SLOTS, ORIGIN, TWIN
from meshwright_core.geometry.boundary_spacing import PIECE

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh

STRAIGHT = 1e-6
"""Radians by which a side may turn where it counts as straight."""


class Obstacles:
    """Counts obstacles of meshes with the same geometric vertices and outline as a given mesh.

    Args:
        mesh: a mesh of a plane domain, z = 0. At geometric vertices that are no points of its
            outline (marked by the user) nothing counts as an obstacle.
    """

    def __init__(self, mesh: HalfEdgeMesh) -> None:
        self._least = np.zeros(mesh.slots, np.int64)
        self._straight = np.zeros(mesh.slots, bool)
        self._edges = np.zeros(mesh.slots, np.int64)  # of the side that a corner begins
        self._ring_edges = np.iinfo(np.int64).max  # of a loop without corners
        geometric = mesh.geometric()
        rings = []
        for ids, points in mesh.outline:
            if np.ptp(points[:, 2]) > 0.0:
                return
            rings.append(points[:, :2])
            corner = ids >= 0
            corner[corner] = geometric[ids[corner]]
            turned = _turns(rings[-1])
            places = np.flatnonzero(corner)
            if not len(places):
                self._ring_edges = min(self._ring_edges, _edges(turned))
                continue
            inside = np.pi - turned[corner]
            self._least[ids[corner]] = 2 + np.floor(inside / np.pi + STRAIGHT).astype(np.int64)
            turned, ids = np.roll(turned, -places[0]), np.roll(ids, -places[0])
            for side in np.split(np.arange(len(ids)), places[1:] - places[0]):
                bends = turned[side[1:]]
                self._straight[ids[side[0]]] = (np.abs(bends) < STRAIGHT).all()
                self._edges[ids[side[0]]] = _edges(bends) if len(bends) else 1
        rings.sort(key=lambda ring: -shapely.Polygon(ring).area)
        # slightly wider, so that segments along the boundary count as inside
        self._domain = shapely.Polygon(rings[0], rings[1:]).buffer(1e-9 * np.ptp(rings[0]))
        shapely.prepare(self._domain)

    def count(self, mesh: HalfEdgeMesh) -> int:
        """The number of obstacles; linear in the mesh, a fraction of a millisecond for some
        hundred elements.

        Counted are the elements missing at boundary vertices (two at least where the boundary is
        straight or reflex) and on sides that bend, vertices inside of degree 2, and edges inside
        that join two vertices of one straight side, or two corners whose connecting segment leaves
        the domain.
        """
        slots = mesh.k * int(mesh.arrays.counters[ELEMENT_SLOTS])
        origin = mesh.arrays.edge[:slots, ORIGIN].astype(np.int64)
        twin = mesh.arrays.edge[:slots, TWIN]
        live = np.flatnonzero(origin >= 0)
        target = origin[live - live % mesh.k + (live + 1) % mesh.k]
        geometric, degree = mesh.geometric(), mesh.degree()
        edge = twin[live] < 0
        before = np.full(mesh.slots, -1)
        before[target[edge]] = origin[live[edge]]
        boundary = before >= 0

        # the side of a boundary vertex, named by the corner that it begins with: pointer jumping
        slides = boundary & ~geometric
        owner = np.where(slides, before, np.arange(mesh.slots))
        name = np.arange(mesh.slots)  # of a loop without corners: its least vertex
        for _ in range(mesh.slots.bit_length()):
            name = np.minimum(name, name[owner])
            owner = owner[owner]
        in_ring = slides & ~geometric[owner]
        owner = np.where(in_ring, name, owner)
        known, straight, edges = (
            _resized(row, mesh.slots) for row in (self._least, self._straight, self._edges)
        )
        least = np.where(geometric, known, np.where(slides & straight[owner], 3, 0))
        found = int(np.maximum(least - degree, 0)[boundary].sum())
        found += int(((degree == 2) & ~boundary & (mesh.k == 4)).sum())
        present = np.bincount(owner[slides], minlength=mesh.slots)
        rings = np.unique(owner[in_ring])
        found += int(np.maximum(self._ring_edges - present[rings], 0).sum())
        found += int(np.maximum(edges - 1 - present, 0)[geometric].sum())

        inner = live[(twin[live] > live) & boundary[origin[live]]]
        a, b = origin[inner], origin[inner - inner % mesh.k + (inner + 1) % mesh.k]
        a, b = a[boundary[b]], b[boundary[b]]
        ending = np.where(geometric, owner[before], owner)
        along = np.zeros(len(a), bool)
        for x in (owner, ending):
            for y in (owner, ending):
                along |= (x[a] == y[b]) & straight[x[a]]
        found += int(along.sum())
        seen = np.flatnonzero(geometric[a] & geometric[b] & ~along)
        if len(seen):
            ends = np.stack([mesh.points[a[seen], :2], mesh.points[b[seen], :2]], axis=1)
            found += int((~shapely.covers(self._domain, shapely.linestrings(ends))).sum())
        return found


def _edges(turned: np.ndarray) -> int:
    """The fewest edges of a side that turns by these angles (n,), at most n."""
    wanted = np.ceil(np.abs(turned).sum() / PIECE - STRAIGHT)
    return int(np.clip(wanted, 1, len(turned)))


def _resized(row: np.ndarray, length: int) -> np.ndarray:
    """The first `length` entries of a row (n,), filled up with zeros."""
    longer = np.zeros(length, row.dtype)
    longer[: min(length, len(row))] = row[:length]
    return longer


def _turns(ring: np.ndarray) -> np.ndarray:
    """(n,) radians by which a ring turns at its points, to the left positive."""
    come = ring - np.roll(ring, 1, axis=0)
    go = np.roll(come, -1, axis=0)
    across = come[:, 0] * go[:, 1] - come[:, 1] * go[:, 0]
    turned: np.ndarray = np.arctan2(across, (come * go).sum(axis=1))
    return turned
