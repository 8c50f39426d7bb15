"""Obstacles: features of the connectivity that rule out a valid embedding in the domain.

A mesh with an obstacle has an inverted element for all positions of its vertices, or an edge that
would have to turn too far. A mesh without any nearly always has a valid embedding. The count is a
cheap necessary test that a search makes before untangling.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import shapely

from meshwright_core.core.arrays import CURVE, ELEMENT_SLOTS, LEFT, ORIGIN, RIGHT, TWIN
from meshwright_core.geometry.edge_curves import EdgePlaces, loop_polyline
from meshwright_core.geometry.sharp_bends import kinks_between
from meshwright_core.geometry.turning import CurveTurning, turning_between

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh

STRAIGHT = 1e-6
"""Radians by which a side may turn where it counts as straight."""
MOST = np.radians(135.0)
"""The most that one edge may turn: a circle keeps three edges, half a circle two."""
FINE = np.radians(2.0)
"""Turning of the pieces of the domain's outline that segments are tested against."""


class Obstacles:
    """Counts obstacles of meshes with the same geometric vertices and curves as a given mesh.

    Args:
        mesh: a mesh of a plane domain, z = 0. On other surfaces only doublets count.
    """

    def __init__(self, mesh: HalfEdgeMesh) -> None:
        self._slots, boundary = mesh.slots, mesh.boundary_info
        # by the corner that a side begins with, and by the curve for loops without corners
        self._straight = np.zeros(mesh.slots, bool)
        self._flat = np.zeros(mesh.slots, bool)
        self._edges = np.zeros(mesh.slots, np.int64)
        self._flat_curve = np.zeros(boundary.count, bool)
        self._curve_edges = np.zeros(boundary.count, np.int64)
        self._sectors = np.zeros((0, 2), np.int64)
        self._least = np.zeros(0, np.int64)
        self._plane = not mesh.points[mesh.vertices(), 2].any()
        if not self._plane:
            return
        self._measure_curves(mesh)
        self._measure_corners(mesh)
        loops = [
            loop_polyline(boundary.curves, CurveTurning.of(mesh), loop, FINE)[:, :2]
            for loop in boundary.loops
        ]
        loops.sort(key=lambda ring: -shapely.Polygon(ring).area)
        # slightly wider, so that segments along the boundary count as inside
        slack = 1e-9 * np.ptp(loops[0])
        self._domain = shapely.Polygon(loops[0], loops[1:]).buffer(slack)
        shapely.prepare(self._domain)

    def _measure_curves(self, mesh: HalfEdgeMesh) -> None:
        """Turning and kinks of curves, and of the sides of loops between geometric vertices."""
        boundary, turning = mesh.boundary_info, CurveTurning.of(mesh)
        curves, lengths = boundary.curves, boundary.lengths()
        upwards = np.array([0.0, 0.0, 1.0])
        geometric, on, t = mesh.geometric(), mesh.curve_ids(), mesh.parameters()
        for curve in range(boundary.count):
            length, loop = float(lengths[curve]), curve in boundary.loops
            turn = turning_between(curves, turning, curve, 0.0, length)
            kinks = kinks_between(curves, turning, upwards, curve, -1.0, length, not loop)
            self._flat_curve[curve] = not len(kinks)
            least = 3 if curves.closed[curve] else 1
            self._curve_edges[curve] = max(_edges(turn), least)
            corners = np.flatnonzero(geometric & (on == curve)) if loop else np.zeros(0, np.int64)
            corners = corners[np.argsort(t[corners])]
            for corner, end in zip(corners.tolist(), np.roll(corners, -1).tolist(), strict=True):
                low, high = float(t[corner]), float(t[end])
                high += length if high <= low else 0.0
                turn = turning_between(curves, turning, curve, low, high)
                margin = 1e-9 * length
                kinks = kinks_between(curves, turning, upwards, curve, low + margin, high - margin)
                self._straight[corner] = turn < STRAIGHT
                self._flat[corner] = not len(kinks)
                self._edges[corner] = _edges(turn)

    def _measure_corners(self, mesh: HalfEdgeMesh) -> None:
        """The least number of elements in each sector at geometric vertices on curves: one for
        each begun half turn.
        """
        corners = np.flatnonzero(mesh.geometric() & (mesh.curve_ids() >= 0)).tolist()
        fans = [mesh.outgoing(v) for v in corners]
        last = [mesh.prev(fan[-1]) for fan in fans]  # of a boundary vertex: it ends there
        places = EdgePlaces(mesh, [h for fan in fans for h in fan] + last)
        places = places.kept(np.flatnonzero(places.curve >= 0))
        tangents = dict(zip(places.halfedges.tolist(), places.tangents(), strict=True))
        found: dict[tuple[int, int], int] = {}
        for v, fan, back in zip(corners, fans, last, strict=True):
            along = [h for h in fan if h in tangents]
            if not along:
                continue
            directions = [tangents[h][0] for h in along]
            directions.append(-tangents[back][1] if mesh.is_boundary(v) else directions[0])
            for h, a, b in zip(along, directions, directions[1:], strict=False):
                angle = float(np.arctan2(a[0] * b[1] - a[1] * b[0], a[:2] @ b[:2]))
                if angle <= STRAIGHT:
                    angle += 2.0 * np.pi
                key = v, int(mesh.arrays.region[h // mesh.k])
                found[key] = found.get(key, 0) + 1 + int(np.floor(angle / np.pi + STRAIGHT))
        self._sectors = np.array(list(found), np.int64).reshape(-1, 2)
        self._least = np.array(list(found.values()), np.int64)

    def count(self, mesh: HalfEdgeMesh) -> int:
        """The number of obstacles; linear in the mesh, a fraction of a millisecond for some
        hundred elements.

        Counted are the elements missing at vertices on curves (two at least on each side where the
        curve is smooth or reflex), the edges missing on sides that turn, vertices inside of degree
        2, and edges inside that join two vertices of one straight side, or two corners whose
        connecting segment leaves the domain.
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
        curve = mesh.arrays.vertex[: mesh.slots, CURVE]
        found = int(((degree == 2) & ~boundary & (mesh.k == 4)).sum())
        if not self._plane:
            return found

        # the side of a boundary vertex, named by the corner that it begins with: pointer jumping
        slides = boundary & ~geometric
        owner = np.where(slides, before, np.arange(mesh.slots))
        for _ in range(mesh.slots.bit_length()):
            owner = owner[owner]
        in_ring = slides & ~geometric[owner]
        straight, flat, edges = (
            _resized(row, mesh.slots) for row in (self._straight, self._flat, self._edges)
        )
        smooth = slides & np.where(in_ring, self._flat_curve[curve], flat[owner])
        found += int(np.maximum(3 - degree, 0)[smooth].sum())
        present = np.bincount(owner[slides & ~in_ring], minlength=mesh.slots)
        found += int(np.maximum(edges - 1 - present, 0)[geometric].sum())
        rings = np.bincount(curve[in_ring], minlength=len(self._curve_edges))
        found += int(np.maximum(self._curve_edges - rings, 0)[rings > 0].sum())
        region = np.repeat(mesh.arrays.region[: slots // mesh.k], mesh.k)
        found += self._at_corners(mesh, origin[live], region[live])
        found += self._on_interfaces(mesh, origin[live], region[live], boundary)

        other = region[np.maximum(twin[live], 0)]
        inner = live[(twin[live] > live) & boundary[origin[live]] & (other == region[live])]
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

    def _at_corners(self, mesh: HalfEdgeMesh, origin: np.ndarray, region: np.ndarray) -> int:
        """Elements missing in the sectors at geometric vertices; origin and region of all
        half-edges.
        """
        if not len(self._sectors):
            return 0
        count = int(max(region.max(initial=0), self._sectors[:, 1].max())) + 1
        there = np.bincount(origin * count + region, minlength=self._slots * count)
        elements = there[self._sectors[:, 0] * count + self._sectors[:, 1]]
        return int(np.maximum(self._least - elements, 0).sum())

    def _on_interfaces(
        self, mesh: HalfEdgeMesh, origin: np.ndarray, region: np.ndarray, boundary: np.ndarray
    ) -> int:
        """Elements and edges missing at interfaces."""
        interfaces = mesh.boundary_info.interfaces
        if not interfaces:
            return 0
        table, curve = mesh.arrays.interface, mesh.arrays.vertex[: mesh.slots, CURVE]
        inside = (curve >= 0) & ~boundary
        inside[[v for one in interfaces for v in (one.start, one.end) if v >= 0]] = False
        here = inside & ~mesh.geometric() & self._flat_curve[curve]
        found = 0
        for side in (LEFT, RIGHT):
            wanted = table[curve[origin], side] == region
            elements = np.bincount(origin[wanted], minlength=mesh.slots)[: mesh.slots]
            found += int(np.maximum(2 - elements, 0)[here].sum())
        present = np.bincount(curve[inside], minlength=len(self._curve_edges))
        for one in interfaces:
            edges = present[one.curve] + (one.start >= 0)
            found += max(int(self._curve_edges[one.curve]) - int(edges), 0)
        return found


def _edges(turn: float) -> int:
    """The fewest edges of a side that turns by `turn` radians."""
    return max(1, int(np.ceil(turn / MOST - STRAIGHT)))


def _resized(row: np.ndarray, length: int) -> np.ndarray:
    """The first `length` entries of a row (n,), filled up with zeros."""
    longer = np.zeros(length, row.dtype)
    longer[: min(length, len(row))] = row[:length]
    return longer
