"""Triangulations between curved sides with bounds on edges, areas and angles."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from meshwright_core.core.composite_curves import place_all
from meshwright_core.core.time_limit import check_time
from meshwright_core.domains.elements import chord_conflicts
from meshwright_core.domains.elements.labelled_triangles import regions_of, seeds
from meshwright_core.domains.elements.side_edges import SideEdges
from meshwright_core.domains.elements.sided_elements import SidedElements
from meshwright_core.domains.elements.triangulation import Bounds, triangle_areas, triangulated
from meshwright_core.errors import MeshError

Points = NDArray[np.float64]
Ids = NDArray[np.int64]

_TURN = 24.0
"""Degrees by which a side turns along an edge before Triangle inserts points, at most."""
_ATTEMPTS = 6


def refined(edges: SideEdges, size: float, bounds: Bounds, seed: int) -> SidedElements:
    """Triangles that keep the bounds, with all points of sides on their curves.

    Triangle works between chords that are so short that moving its points from the chords to the
    curve turns no triangle over; where one does all the same, the chords are halved.

    Args:
        edges: of the sides; they are cut as needed.
        size: diameter of the domain.
        bounds: of the triangles.
        seed: as for :func:`.triangulation.triangulated`.
    """
    turn, longest = _TURN, bounds.max_edge
    if longest is None and bounds.max_area is not None:
        longest = 2.0 * math.sqrt(bounds.max_area)
    inner = bounds
    for _ in range(_ATTEMPTS):
        check_time()
        _cut(edges, turn, longest)
        chord_conflicts.settle(edges)
        found = _triangles(edges, size, inner, seed)
        length = _longest(found)
        upside_down = triangle_areas(found.points, found.elements).min() <= 0.0
        too_long = bounds.max_edge is not None and length > bounds.max_edge
        if not upside_down and not too_long:
            return found
        if upside_down:
            turn *= 0.5
        if too_long and bounds.max_edge is not None and inner.max_edge is not None:
            inner = inner._replace(max_edge=0.98 * inner.max_edge * bounds.max_edge / length)
    raise MeshError("The sides of the domain come too near to each other to be meshed.")


def _cut(edges: SideEdges, turn: float, longest: float | None) -> None:
    """Cut edges that turn by more than so many degrees or are longer than `longest`."""
    count = np.ceil(np.degrees(edges.turnings) / turn - 1e-9)
    bent = count > 0
    if longest is not None:
        count = np.maximum(count, np.where(bent, np.ceil(np.diff(edges.span)[:, 0] / longest), 1))
    long = np.flatnonzero(count > 1)
    edges.cut(long, count[long].astype(int))


def _triangles(edges: SideEdges, size: float, bounds: Bounds, seed: int) -> SidedElements:
    given = edges.points
    left, right = edges.left_right()
    plain = triangulated(given, edges.ends, np.empty((0, 2)), size, Bounds(), seed)
    regions = regions_of(plain.triangles, len(given), edges.ends, left, right)
    holes = seeds(given, plain.triangles, regions, edges.ends)
    found = triangulated(given, edges.ends, holes, size, bounds, seed)
    points, segments, owner = found.points, found.segments, found.owners
    # parts of segments: their ends as fractions of the chord, from its first vertex
    first, last = points[edges.ends[owner, 0]], points[edges.ends[owner, 1]]
    way = last - first
    shares = np.stack(
        [((points[segments[:, i]] - first) * way).sum(axis=1) for i in range(2)], axis=1
    ) / (way * way).sum(axis=1, keepdims=True)
    backward = shares[:, 0] > shares[:, 1]
    segments = np.where(backward[:, None], segments[:, ::-1], segments)
    shares = np.clip(np.where(backward[:, None], shares[:, ::-1], shares), 0.0, 1.0)
    shares[segments == edges.ends[owner]] = np.round(shares[segments == edges.ends[owner]])
    low, high = edges.span[owner].T
    span = low[:, None] + shares * (high - low)[:, None]
    span = np.where(shares == 1.0, high[:, None], span)
    side = edges.side[owner]
    more = len(points) - len(given)
    curve = np.append(edges.curve, np.full(more, -1))
    parameter = np.append(edges.parameter, np.zeros(more))
    new = segments >= len(given)
    curve[segments[new]] = np.broadcast_to(side[:, None], segments.shape)[new]
    length = edges.curves.stop[edges.curves.first_span[1:] - 1]
    t = span[new]
    owners = np.broadcast_to(side[:, None], segments.shape)[new]
    parameter[segments[new]] = np.where(t >= length[owners], t - length[owners], t)
    moved = points.copy()
    seated = curve >= 0
    moved[seated] = place_all(edges.curves, curve[seated], parameter[seated])[:, :2]
    regions = regions_of(found.triangles, len(points), segments, left[owner], right[owner])
    inside = regions >= 0
    return SidedElements(
        moved, found.triangles[inside], regions[inside], curve, parameter,
        np.append(edges.node, np.full(more, -1)), edges.curves, side, span, segments,
    )  # fmt: skip


def _longest(found: SidedElements) -> float:
    """The longest edge of the triangles."""
    corners = found.points[found.elements]
    return float(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max())
