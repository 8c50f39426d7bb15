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
from meshwright_core.core.composite_curves import place_all, tangents
from meshwright_core.geometry.turning import CurveTurning, turnings

if TYPE_CHECKING:
    from meshwright_core.core.composite_curves import Curves
    from meshwright_core.mesh import HalfEdgeMesh

STRAIGHT = 1e-6
"""Radians by which a side may turn where it counts as straight."""
PIECE = np.radians(135.0)
"""Radians that one edge along a curve may turn; half a turn would make a corner flat."""
_BESIDE = 1e-9
"""Distance from a corner, relative to the length of its loop, at which tangents are taken."""
_SAMPLES = np.arange(16) / 16.0


class Obstacles:
    """Counts obstacles of meshes with the same geometric vertices and outline as a given mesh.

    Args:
        mesh: a mesh of a plane domain, z = 0.
    """

    def __init__(self, mesh: HalfEdgeMesh) -> None:
        self._least = np.zeros(mesh.slots, np.int64)
        self._straight = np.zeros(mesh.slots, bool)
        self._edges = np.zeros(mesh.slots, np.int64)  # of the side that a corner begins
        self._ring_edges = np.iinfo(np.int64).max  # of a loop without corners
        info, turning = mesh.boundary_info, CurveTurning.of(mesh)
        self._smooth = np.zeros(mesh.slots, bool)  # sides without kinks
        self._smooth_rings = True
        if np.ptp(mesh.points[mesh.vertices(), 2]) > 0.0 or not info.loops:
            return
        curve, parameter = mesh.curve_ids(), mesh.parameters()
        corners = mesh.boundary() & mesh.geometric()
        for loop in info.loops:
            spans = slice(info.curves.first_span[loop], info.curves.first_span[loop + 1])
            length = float(info.lengths()[loop])
            ids = np.flatnonzero(corners & (curve == loop))
            ids = ids[np.argsort(parameter[ids])]
            kinks = info.curves.start[spans][turning.joint[spans] > STRAIGHT]
            if not len(ids):
                turned = float(turning.inside[spans].sum() + turning.joint[spans].sum())
                self._ring_edges = min(self._ring_edges, _edges(turned))
                self._smooth_rings &= not len(kinks)
                continue
            t = parameter[ids]
            inside = np.pi - _turns(info.curves, loop, t, length)
            self._least[ids] = 2 + np.floor(inside / np.pi + STRAIGHT).astype(np.int64)
            stop = np.append(t[1:], t[0] + length)
            span = np.column_stack([t, stop])
            turned = turnings(info.curves, turning, np.full(len(ids), loop), span)
            self._straight[ids] = turned < STRAIGHT
            self._edges[ids] = [_edges(one) for one in turned.tolist()]
            near = 1e-9 * length
            beyond = np.concatenate([kinks, kinks + length])
            self._smooth[ids] = [
                not ((beyond > low + near) & (beyond < high - near)).any() for low, high in span
            ]
        rings = sorted(_rings(mesh), key=lambda ring: -shapely.Polygon(ring).area)
        # slightly wider, so that segments along the boundary count as inside; chords of curves
        # lie off them
        margin = 1e-9 if (np.diff(info.curves.first_control) == 2).all() else 1e-2
        outer = shapely.Polygon(rings[0], rings[1:])
        self._domain = outer.buffer(margin * np.ptp(rings[0]))
        shapely.prepare(self._domain)

    def count(self, mesh: HalfEdgeMesh) -> int:
        """The number of obstacles; linear in the mesh, a fraction of a millisecond for some
        hundred elements.

        Counted are the elements missing at boundary vertices (two at least where the boundary is
        smooth or reflex) and on sides that bend, vertices inside of degree 2, and edges inside
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
        known, straight, edges, smooth = (
            _resized(row, mesh.slots)
            for row in (self._least, self._straight, self._edges, self._smooth)
        )
        flat = np.where(in_ring, self._smooth_rings, smooth[owner])
        least = np.where(geometric, known, np.where(slides & flat, 3, 0))
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


def _edges(turned: float) -> int:
    """The fewest edges along a side that turns by an angle in all."""
    return max(1, int(np.ceil(turned / PIECE - STRAIGHT)))


def _resized(row: np.ndarray, length: int) -> np.ndarray:
    """The first `length` entries of a row (n,), filled up with zeros."""
    longer = np.zeros(length, row.dtype)
    longer[: min(length, len(row))] = row[:length]
    return longer


def _turns(curves: Curves, loop: int, t: np.ndarray, length: float) -> np.ndarray:
    """(n,) radians by which a loop turns at parameters t (n,), to the left positive."""
    which = np.full(len(t), loop)
    step = _BESIDE * length
    come, go = tangents(curves, which, t - step), tangents(curves, which, t + step)
    across = come[:, 0] * go[:, 1] - come[:, 1] * go[:, 0]
    turned: np.ndarray = np.arctan2(across, (come * go).sum(axis=1))
    return turned


def _rings(mesh: HalfEdgeMesh) -> list[np.ndarray]:
    """Polylines (p, 2) along the boundary loops of a plane mesh."""
    info, rings = mesh.boundary_info, []
    for loop in info.loops:
        spans = slice(info.curves.first_span[loop], info.curves.first_span[loop + 1])
        start, stop = info.curves.start[spans], info.curves.stop[spans]
        bent = np.diff(info.curves.first_control)[spans] > 2
        t = start[:, None] + (stop - start)[:, None] * _SAMPLES
        kept = bent[:, None] | (_SAMPLES == 0.0)
        places = t[kept]
        rings.append(place_all(info.curves, np.full(len(places), loop), places)[:, :2])
    return rings
