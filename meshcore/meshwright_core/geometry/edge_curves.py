"""The true shape of edges: on the boundary and on interfaces that of the curve between their ends
(:mod:`meshwright_core.geometry.edge_kernels`). All other edges are straight.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from meshwright_core.core.arrays import ELEMENT_SLOTS, ORIGIN, TWIN
from meshwright_core.core.compilation import kernel
from meshwright_core.core.composite_curves import Curves, place_all
from meshwright_core.core.curve_edges import edge_places
from meshwright_core.geometry.edge_kernels import (
    NODES,
    WEIGHTS,
    bulges,
    edge_offsets,
    end_tangents,
    place_on_edge,
)
from meshwright_core.geometry.planes import plane_normal, vector_areas
from meshwright_core.geometry.turning import (
    BENDS,
    CurveTurning,
    Turning,
    span_towards,
    turnings,
)

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh

_SAFETY = 1.5
"""Factor of the pieces that an arc of the same length and turning needs, for other curves."""
_STEEPEST = np.radians(30.0)
"""The most that a curve turns in one piece of a polyline, whatever the tolerance."""


@kernel
def points_of_edge(curves, curve, span, ends, w):
    """(n, 3) points of one edge at w (n,)."""
    offsets, slope = np.zeros((2, 3)), np.zeros(3)
    edge_offsets(curves, curve, span, ends, offsets)
    points = np.zeros((len(w), 3))
    for i in range(len(w)):
        place_on_edge(curves, curve, span, offsets, w[i], points[i], slope)
        if w[i] == 0.0 or w[i] == 1.0:
            points[i] = ends[int(w[i])]
    return points


@kernel
def _polyline_stops(curves, turning, curve, span, tolerance, stops):
    """Write the parameters of the points of an edge's polyline; returns how many there are.

    Only counts them where `stops` is empty.
    """
    here, stop = span[0], span[1]
    sign = 1.0 if stop > here else -1.0
    count = 1
    if len(stops):
        stops[0] = here
    for _ in range(len(curves.start) + 2):
        if sign * (stop - here) <= 0.0:
            break
        piece, u = span_towards(curves, curve, here, stop)
        extent = curves.stop[piece] - curves.start[piece]
        until = here + sign * ((1.0 - u) * extent if sign > 0.0 else u * extent)
        if sign * (stop - until) <= 1e-12 * extent:
            until = stop
        angle = turning.inside[piece] * abs(until - here) / extent
        sag = angle * abs(until - here) / (8.0 * tolerance)
        pieces = max(np.ceil(_SAFETY * np.sqrt(sag)), np.ceil(angle / _STEEPEST), 1.0)
        if turning.inside[piece] <= BENDS:
            pieces = 1.0
        for i in range(1, int(pieces) + 1):
            if len(stops):
                stops[count] = here + (until - here) * i / pieces
            count += 1
        here = until
    return count


@kernel
def _polylines(curves, turning, curve, span, ends, tolerance):
    """Points (p, 3) of the polylines of edges, and where each begins (n + 1,)."""
    first = np.zeros(len(curve) + 1, np.int64)
    nothing = np.zeros(0)
    for i in range(len(curve)):
        count = _polyline_stops(curves, turning, curve[i], span[i], tolerance, nothing)
        first[i + 1] = first[i] + count
    points, slope, offsets = np.zeros((first[-1], 3)), np.zeros(3), np.zeros((2, 3))
    for i in range(len(curve)):
        stops = np.zeros(first[i + 1] - first[i])
        _polyline_stops(curves, turning, curve[i], span[i], tolerance, stops)
        edge_offsets(curves, curve[i], span[i], ends[i], offsets)
        for j in range(len(stops)):
            w = (stops[j] - span[i, 0]) / (span[i, 1] - span[i, 0])
            place_on_edge(curves, curve[i], span[i], offsets, w, points[first[i] + j], slope)
        points[first[i]] = ends[i, 0]
        points[first[i + 1] - 1] = ends[i, 1]
    return points, first


class EdgePlaces:
    """Where half-edges lie on curves, and which of them bend.

    Attributes:
        halfedges: (n,) ids.
        curve: (n,) the curve of each, -1 for none.
        span: (n, 2) the parameters of its ends.
        turning: (n,) radians by which it turns in all.
    """

    def __init__(self, mesh: HalfEdgeMesh, halfedges: ArrayLike) -> None:
        self.halfedges = np.asarray(halfedges, np.int64).reshape(-1)
        self.curve, self.span = edge_places(mesh.arrays, self.halfedges, mesh.k)
        curves = mesh.boundary_info.curves
        self.turning = turnings(curves, CurveTurning.of(mesh), self.curve, self.span)
        self._mesh = mesh

    @property
    def bent(self) -> np.ndarray:
        """(n,) bool: the edges that are not straight."""
        found: np.ndarray = self.turning > BENDS
        return found

    def kept(self, rows: np.ndarray) -> EdgePlaces:
        """The edges in `rows` alone."""
        part = EdgePlaces.__new__(EdgePlaces)
        part.halfedges, part.curve = self.halfedges[rows], self.curve[rows]
        part.span, part.turning, part._mesh = self.span[rows], self.turning[rows], self._mesh
        return part

    @property
    def ends(self) -> np.ndarray:
        """(n, 2, 3) positions of the ends."""
        return self._mesh.points[ends_of(self._mesh, self.halfedges)]

    def tangents(self) -> np.ndarray:
        """(n, 2, 3) derivatives of the edges at both ends; all must lie on curves."""
        curves = self._mesh.boundary_info.curves
        return end_tangents(curves, self.curve, self.span, self.ends)

    def bulges(self) -> np.ndarray:
        """(n, 3) vector areas between the edges and their chords."""
        curves = self._mesh.boundary_info.curves
        return bulges(curves, self.curve, self.span, self.ends, NODES, WEIGHTS)


def ends_of(mesh: HalfEdgeMesh, halfedges: np.ndarray) -> np.ndarray:
    """(n, 2) vertices where half-edges (n,) start and end."""
    ahead = halfedges - halfedges % mesh.k + (halfedges + 1) % mesh.k
    origin = mesh.arrays.edge[:, ORIGIN]
    return np.stack([origin[halfedges], origin[ahead]], axis=1).astype(np.int64)


def curve_halfedges(mesh: HalfEdgeMesh) -> np.ndarray:
    """Ids, ascending, of all half-edges along curves: on the boundary, and both of an edge between
    two regions.
    """
    slots = mesh.k * int(mesh.arrays.counters[ELEMENT_SLOTS])
    origin, twin = mesh.arrays.edge[:slots, ORIGIN], mesh.arrays.edge[:slots, TWIN]
    found = (origin >= 0) & (twin < 0)
    region = mesh.arrays.region[: slots // mesh.k]
    if len(region) and (region != region[0]).any():
        own = np.repeat(region, mesh.k)
        found |= (twin >= 0) & (own != own[np.maximum(twin, 0)]) & (origin >= 0)
    return np.flatnonzero(found)


def bent_edges(mesh: HalfEdgeMesh, halfedges: np.ndarray | None = None) -> EdgePlaces:
    """The places of the half-edges that bend, of those given or of all."""
    places = EdgePlaces(mesh, curve_halfedges(mesh) if halfedges is None else halfedges)
    return places.kept(np.flatnonzero(places.bent))


def curved_halfedges(mesh: HalfEdgeMesh) -> np.ndarray:
    """Ids, ascending, of the half-edges whose true edge is not straight; both of an interface."""
    return bent_edges(mesh).halfedges


def is_straight(mesh: HalfEdgeMesh, h: int) -> bool:
    """Whether the true edge of half-edge h is a segment, to 1e-7 radians of turning."""
    return not EdgePlaces(mesh, [h]).bent[0]


def edge_points(mesh: HalfEdgeMesh, h: int, w: ArrayLike) -> np.ndarray:
    """(n, 3) points of the true edge of half-edge h at the fractions w (n,) of its parameters.

    0 is the origin of h, 1 its target; both are met to the bit.
    """
    shares = np.asarray(w, np.float64).reshape(-1)
    places = EdgePlaces(mesh, [h])
    ends = places.ends[0]
    if places.curve[0] < 0:
        points: np.ndarray = ends[0] + shares[:, None] * (ends[1] - ends[0])
        points[shares == 1.0] = ends[1]
        return points
    curves = mesh.boundary_info.curves
    return points_of_edge(curves, int(places.curve[0]), places.span[0], ends, shares)


def edge_polyline(mesh: HalfEdgeMesh, h: int, tolerance: float) -> np.ndarray:
    """(n, 3) polyline of the true edge of half-edge h, from its origin to its target.

    It leaves the edge by no more than `tolerance` > 0 or so, and has a point at every kink.
    """
    places = bent_edges(mesh, np.array([h]))
    if not len(places.halfedges):
        return mesh.points[ends_of(mesh, np.array([h]))[0]]
    points, _ = _polylines_of(mesh, places, tolerance)
    return points


def curved_edge_polylines(
    mesh: HalfEdgeMesh, tolerance: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Polylines of all edges that are not straight, each edge once, for drawing.

    Returns:
        halfedges (n,), ascending, of two the lower one; where the points of each begin (n + 1,);
        points (p, 3), each polyline from the origin of its half-edge to the target. Accuracy as in
        :func:`edge_polyline`.
    """
    places = bent_edges(mesh)
    twin = mesh.arrays.edge[places.halfedges, TWIN]
    places = places.kept(np.flatnonzero((twin < 0) | (twin > places.halfedges)))
    points, first = _polylines_of(mesh, places, tolerance)
    return places.halfedges, first, points


def _polylines_of(
    mesh: HalfEdgeMesh, places: EdgePlaces, tolerance: float
) -> tuple[np.ndarray, np.ndarray]:
    curves: Curves = mesh.boundary_info.curves
    points, first = _polylines(
        curves, CurveTurning.of(mesh), places.curve, places.span, places.ends, float(tolerance)
    )
    return points, first


def loop_polyline(curves: Curves, turning: Turning, loop: int, turn: float) -> np.ndarray:
    """(n, 3) points around a closed curve, so close that it turns by no more than `turn` radians
    between them; the first is not repeated.
    """
    spans = np.arange(curves.first_span[loop], curves.first_span[loop + 1])
    pieces = np.maximum(np.ceil(turning.inside[spans] / turn), 1).astype(np.int64)
    share = np.arange(pieces.sum()) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    start, stop = curves.start[spans], curves.stop[spans]
    t = np.repeat(start, pieces) + share * np.repeat((stop - start) / pieces, pieces)
    return place_all(curves, np.full(len(t), loop, np.int64), t)


def element_areas(mesh: HalfEdgeMesh) -> np.ndarray:
    """(m,) areas of the elements with their true edges, in the order of `mesh.elements()`.

    Signed in a plane: negative where an element turns clockwise. On other surfaces the lengths of
    the vector areas.
    """
    areas = vector_areas(mesh.points, mesh.elements())
    places = bent_edges(mesh)
    rows = np.searchsorted(mesh.element_ids(), places.halfedges // mesh.k)
    np.add.at(areas, rows, places.bulges())
    normal = plane_normal(mesh)
    if normal is None:
        lengths: np.ndarray = np.linalg.norm(areas, axis=1)
        return lengths
    signed: np.ndarray = areas @ normal
    return signed
