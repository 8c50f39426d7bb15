"""Corners and desired degrees of a plane mesh from the directions of its curves.

The edges along curves divide the surroundings of a vertex into sectors, one for each region there.
By the sum rule (:func:`meshwright_core.core.irregularity.desired_between`) their angles give the
desired degree: that of equation 2 where there is one sector on the boundary, 6 or 4 where a smooth
interface passes.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from meshwright_core.core.arrays import CURVE, ELEMENT_SLOTS, ORIGIN, SIDES, TWIN, MeshArrays
from meshwright_core.core.composite_curves import tangents
from meshwright_core.core.curve_edges import edge_places
from meshwright_core.core.irregularity import desired_on_boundary
from meshwright_core.core.mesh_boundary import MeshBoundary

_NEAR_END = 1e-11
"""Share of an edge from its end at which its direction is taken."""
_JOINT = 1e-9
"""Distance from the joint of two pieces, relative to the length of the curve, that counts as 0."""


class Sectors(NamedTuple):
    """The sectors at vertices on curves, those of one vertex one after the other."""

    vertex: np.ndarray
    """(n,) ascending."""
    angle: np.ndarray
    """(n,) degrees in (0, 360]; outside of the domain there are none."""
    boundary: np.ndarray
    """(n,) whether the vertex lies on the boundary."""
    halfedge: np.ndarray
    """(n,) the half-edge that leaves the vertex where the sector begins, counter-clockwise."""


def sectors(m: MeshArrays) -> Sectors:
    """The sectors at all vertices on curves of a mesh in a plane z = const."""
    k = int(m.counters[SIDES])
    halfedges = np.flatnonzero(m.edge[: int(m.counters[ELEMENT_SLOTS]) * k, ORIGIN] >= 0)
    curve, span = edge_places(m, halfedges, k)
    if not (curve >= 0).any():
        none = np.zeros(0, np.int64)
        return Sectors(none, np.zeros(0), np.zeros(0, bool), none)
    halfedges, span, curve = halfedges[curve >= 0], span[curve >= 0], curve[curve >= 0]
    start = m.edge[halfedges, ORIGIN].astype(np.int64)
    end = m.edge[halfedges - halfedges % k + (halfedges + 1) % k, ORIGIN].astype(np.int64)
    outer = m.edge[halfedges, TWIN] < 0
    # seen from their origins; those that end at the boundary have no half-edge that leaves
    away = _directions(m, curve, span)
    back = _directions(m, curve[outer], span[outer][:, ::-1])
    vertex = np.concatenate([start, end[outer]])
    angle = np.concatenate([away, back])
    first = np.zeros(len(m.vertex))
    first[start[outer]] = away[outer]
    on_boundary = np.zeros(len(m.vertex), bool)
    on_boundary[start[outer]] = True
    turn = np.mod(angle - first[vertex], 360.0)
    turn[: len(away)][outer] = 0.0
    # the boundary edge that ends there is the last one: a slit is 360 degrees wide
    last = np.arange(len(vertex)) >= len(away)
    turn[last & (turn == 0.0)] = 360.0
    order = np.lexsort((last, turn, vertex))
    vertex, turn = vertex[order], turn[order]
    ahead = np.append(vertex[1:] == vertex[:-1], False)
    begins = np.append(True, ~ahead[:-1])
    width = np.append(turn[1:], 0.0) - turn
    around = np.flatnonzero(begins)[np.cumsum(begins) - 1]
    width = np.where(ahead, width, turn[around] + 360.0 - turn)
    kept = ahead | ~on_boundary[vertex]
    # the last edge at a boundary vertex begins no sector, so what is kept has a half-edge
    begun_by = np.concatenate([halfedges, np.full(len(back), -1)])[order]
    return Sectors(vertex[kept], width[kept], on_boundary[vertex[kept]], begun_by[kept])


def _directions(m: MeshArrays, curve: np.ndarray, span: np.ndarray) -> np.ndarray:
    """(n,) angle in degrees of the way along curves from span[:, 0] towards span[:, 1]."""
    step = span[:, 1] - span[:, 0]
    way = tangents(m.curves, curve, span[:, 0] + _NEAR_END * step)
    way *= np.sign(step)[:, None]
    angle: np.ndarray = np.degrees(np.arctan2(way[:, 1], way[:, 0]))
    return angle


def desired_by_sectors(found: Sectors, k: int, slots: int) -> np.ndarray:
    """(slots,) desired degree of the vertices on curves by the sum rule, 0 for others."""
    shares = desired_on_boundary(found.angle, k) - 1
    desired: np.ndarray = np.bincount(found.vertex, weights=shares, minlength=slots)
    desired = desired.astype(np.int64)
    desired[np.unique(found.vertex[found.boundary])] += 1
    return desired


def corners(found: Sectors, m: MeshArrays, boundary: MeshBoundary, angle: float) -> np.ndarray:
    """(slots of capacity,) the vertices that belong to the geometry.

    Those where a curve turns by more than `angle` degrees, where curves meet, and the anchors:
    joints of a drawn line with another kind of piece, and of two pieces with different names.
    """
    count = np.bincount(found.vertex, minlength=len(m.vertex))
    corner = count > np.where(_on_boundary(found, len(m.vertex)), 1, 2)
    bent = np.abs(found.angle - 180.0) > angle
    corner[found.vertex[bent]] = True
    for number, pieces in enumerate(boundary.pieces):
        near = _JOINT * boundary.lengths()[number]
        closed = bool(boundary.curves.closed[number])
        before = (pieces[-1:] if closed else pieces[:1]) + pieces[:-1]
        joints = [
            one.start
            for one, other in zip(pieces, before, strict=True)
            if (one.kind == "line") != (other.kind == "line") or one.name != other.name
        ]
        on_it = np.flatnonzero(m.vertex[:, CURVE] == number)
        for t in joints:
            corner[on_it[np.abs(m.parameter[on_it] - t) <= near]] = True
    return corner


def _on_boundary(found: Sectors, slots: int) -> np.ndarray:
    there = np.zeros(slots, bool)
    there[found.vertex[found.boundary]] = True
    return there
