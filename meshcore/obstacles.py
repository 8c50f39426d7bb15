"""Obstacles: what in the connectivity of a mesh plainly rules out a drawing with straight edges.

A mesh with an obstacle has an inverted element wherever its vertices go. One without any can nearly
always be drawn, which untangling then has to show: this is the quick look that a search takes
before it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely

from meshcore.halfedge import ELEMENT_SLOTS, ORIGIN, TWIN

if TYPE_CHECKING:
    from meshcore.mesh import HalfEdgeMesh

STRAIGHT = 1e-6
"""Radians by which a side may turn where it counts as straight."""


class Obstacles:
    """Looks at meshes that have the geometric vertices and the outline of the one it is made for.

    Args:
        mesh: a mesh of a plane domain, z = 0. Where its outline knows nothing, at a vertex that
            the user has marked as geometric, say, and on sides that bend, nothing is an obstacle.
    """

    def __init__(self, mesh: HalfEdgeMesh) -> None:
        self._least = np.zeros(mesh.slots, np.int64)
        self._straight = np.zeros(mesh.slots, bool)
        geometric = mesh.geometric()
        rings = []
        for ids, points in mesh.outline:
            if np.ptp(points[:, 2]) > 0.0:
                return
            rings.append(points[:, :2])
            corner = ids >= 0
            corner[corner] = geometric[ids[corner]]
            turned = _turns(rings[-1])
            inside = np.pi - turned[corner]
            self._least[ids[corner]] = 2 + np.floor(inside / np.pi + STRAIGHT).astype(np.int64)
            bent = np.append(0, np.cumsum((np.abs(turned) > STRAIGHT) & ~corner))
            places = np.flatnonzero(corner)
            upto = bent[np.roll(places, -1)] - bent[places]
            upto[-1:] += bent[-1]  # the last side passes the seam
            self._straight[ids[places]] = upto == 0
        rings.sort(key=lambda ring: -shapely.Polygon(ring).area)
        # a hair wider, so that segments along the boundary count as inside
        self._domain = shapely.Polygon(rings[0], rings[1:]).buffer(1e-9 * np.ptp(rings[0]))
        shapely.prepare(self._domain)

    def count(self, mesh: HalfEdgeMesh) -> int:
        """The number of obstacles; linear in the mesh, a fraction of a millisecond for some
        hundred elements.

        Counted are the elements missing at a boundary vertex (two at least where the boundary is
        straight or reflex), vertices inside of degree 2, and edges inside that join two vertices of
        one straight side, or two corners that do not see each other.
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
        owner = np.where(boundary & ~geometric, before, np.arange(mesh.slots))
        for _ in range(mesh.slots.bit_length()):
            owner = owner[owner]
        known = np.zeros(mesh.slots, np.int64)
        straight = np.zeros(mesh.slots, bool)
        size = min(len(self._least), mesh.slots)
        known[:size], straight[:size] = self._least[:size], self._straight[:size]
        slides = boundary & ~geometric
        least = np.where(geometric, known, np.where(slides & straight[owner], 3, 0))
        found = int(np.maximum(least - degree, 0)[boundary].sum())
        found += int(((degree == 2) & ~boundary & (mesh.k == 4)).sum())

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


def _turns(ring: np.ndarray) -> np.ndarray:
    """(n,) radians by which a ring turns at its points, to the left positive."""
    come = ring - np.roll(ring, 1, axis=0)
    go = np.roll(come, -1, axis=0)
    across = come[:, 0] * go[:, 1] - come[:, 1] * go[:, 0]
    turned: np.ndarray = np.arctan2(across, (come * go).sum(axis=1))
    return turned
