"""Places a mesh on a domain: which of its boundary vertices lie where on the domain's curves.

For meshes from files, which hold straight edges only, of a domain whose curves are known. Every
boundary loop is matched with a loop of the domain, corners with vertices, and the vertices between
two corners are projected to the curve between them, in their order.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from meshwright_core.core.composite_curves import nearest_between, place_all
from meshwright_core.core.irregularity import desired_between, usual_desired_degree
from meshwright_core.core.mesh_boundary import MeshBoundary
from meshwright_core.core.projected_seats import once_around
from meshwright_core.core.region_interfaces import interface_chains
from meshwright_core.curves.curve import Curve
from meshwright_core.domains.domain import CORNER_ANGLE, Domain, turning_angles
from meshwright_core.domains.elements.element_regions import element_regions
from meshwright_core.domains.loops.planar_graph import ANCHOR, PlanarGraph, Side
from meshwright_core.domains.loops.side_curves import mesh_boundary, side_curves
from meshwright_core.errors import MeshError
from meshwright_core.mesh import HalfEdgeMesh

Points = NDArray[np.float64]
Ids = NDArray[np.int64]

REACH = 1e-3
"""Distance from the curve, relative to the size of the domain, that is bridged."""
EDGE_REACH = 0.25
"""The same, relative to the edges at the vertex: one in the middle of a chord lies off its arc."""
_NEAREST_LOOPS = 4
"""Loops of the domain, by their boxes, that a loop of the mesh is compared with."""
_SAMPLE = 24


class _Stop(NamedTuple):
    """A geometric point of the domain on a side."""

    t: float
    node: int
    place: Points
    needed: bool
    """Whether the mesh must have a vertex there: at all but the smooth ends of straight pieces."""


def placed(mesh: HalfEdgeMesh, domain: Domain) -> HalfEdgeMesh:
    """The mesh with its boundary, and interfaces, on the curves of the domain.

    Elements and interior vertices keep their ids and places. Boundary vertices move to the nearest
    points of the curves, those nearest to corners to the corners; corners and the desired degrees
    at the boundary become those of the domain. Names of regions and sides that only the mesh has
    stay.

    Args:
        mesh: in the plane; it is not changed.
        domain: with the same loops.

    Raises:
        MeshError: one sentence: the loops are not as many, a corner has no vertex, or a vertex
            lies farther from the curves than a thousandth of the size and a quarter of its edges.
    """
    made = _Placement(mesh, with_curved_sides(domain)).mesh()
    made.take_names(mesh)
    return made


def with_curved_sides(domain: Domain) -> Domain:
    """The domain with sides of curves: itself, or a polygon as polylines between its corners."""
    if domain.sides is not None:
        return domain
    loops, angle = [], CORNER_ANGLE
    for points, corners in zip(domain.loops, domain.loop_corners, strict=True):
        if not corners.all():
            angle = max(angle, float(turning_angles(points)[~corners].max()))
        cuts = np.flatnonzero(corners) if corners.any() else np.array([0])
        around = np.append(cuts, cuts[0] + len(points))
        loops.append(
            [
                Curve.polyline(np.take(points, np.arange(a, b + 1), axis=0, mode="wrap"))
                for a, b in pairwise(around.tolist())
            ]
        )
    return Domain.from_curves(loops, domain.name, angle)


class _Placement:
    """The seats of the vertices of a mesh on the sides of a domain, found side by side."""

    def __init__(self, mesh: HalfEdgeMesh, domain: Domain) -> None:
        assert domain.sides is not None
        self._source, self._domain = mesh, domain
        self._points = mesh.points.copy()
        self._graph: PlanarGraph = domain.sides.graph
        self._sides: tuple[Side, ...] = domain.sides.all_sides
        self._boundary: MeshBoundary = mesh_boundary(domain.sides, side_curves(domain.sides))
        self._curve = np.full(len(self._points), -1, np.int64)
        self._parameter = np.zeros(len(self._points))
        self._vertex_of: dict[int, int] = {}
        """The vertex at each geometric point that has one."""
        self._reach = np.maximum(REACH * domain.diameter, EDGE_REACH * _edge_lengths(mesh))

    def mesh(self) -> HalfEdgeMesh:
        """The placed mesh."""
        source = self._source
        if source.points[source.vertices(), 2].any():
            raise MeshError("The mesh does not lie in the plane of the drawing.")
        regions = element_regions(source, self._domain)
        self._place_loops()
        self._place_interfaces(regions)
        number = np.full(len(self._points), -1, np.int64)
        live = source.vertices()
        number[live] = live
        slots = source.slots
        geometric = np.zeros(slots, bool)
        desired = source.desired().copy()
        k = source.k
        rim = source.boundary()
        desired[rim] = usual_desired_degree(k, True)
        for node, vertex in self._vertex_of.items():
            point = self._graph.points[node]
            geometric[vertex] = True
            angles = [angle for _, angle in point.sectors]
            desired[vertex] = desired_between(angles, k, point.boundary)
        return HalfEdgeMesh.from_elements(
            self._points[:slots],
            source.elements(),
            geometric,
            desired,
            boundary=replace(self._boundary, plane=source.plane),
            seats=(self._curve[:slots], self._parameter[:slots]),
            regions=regions,
        )

    # Boundary loops

    def _place_loops(self) -> None:
        loops = self._source.boundary_loops()
        curves = [i for i, side in enumerate(self._sides) if side.boundary]
        if len(loops) != len(curves):
            raise MeshError(
                f"The boundary of the mesh has {_count(len(loops), 'loop')},"
                f" that of the drawing {len(curves)}."
            )
        for loop, curve in zip(loops, self._matched(loops, curves), strict=True):
            self._place_loop(loop, curve)

    def _matched(self, loops: list[Ids], curves: list[int]) -> list[int]:
        """The curve of each loop, so that all of them are near; by boxes first."""
        from scipy.optimize import linear_sum_assignment  # here: it takes a quarter of a second

        boxes = np.array([_box(self._points[loop]) for loop in loops])
        there = np.array([_box(self._sampled(curve)) for curve in curves])
        apart = np.abs(boxes[:, None] - there[None]).sum(axis=2)
        cost = 1e3 * (apart + self._domain.diameter)
        for i, loop in enumerate(loops):
            some = self._points[loop[:: max(1, len(loop) // _SAMPLE)]]
            for j in np.argsort(apart[i])[:_NEAREST_LOOPS].tolist():
                _, distance = self._projected(some, curves[j], 0.0, self._length(curves[j]))
                cost[i, j] = distance.mean()
        _, columns = linear_sum_assignment(cost)
        return [curves[j] for j in columns.tolist()]

    def _place_loop(self, loop: Ids, curve: int) -> None:
        stops = self._stops(curve)
        met = self._met(loop, stops)
        length = self._length(curve)
        if not met:
            t, distance = self._projected(self._points[loop], curve, 0.0, length)
            surest = int(np.argmin(distance))
            loop, t = np.roll(loop, -surest), np.roll(t, -surest)
            self._seat(loop, curve, once_around(t, length))
            return
        begun = [place for _, place in met]
        if int((np.diff([*begun, begun[0]]) < 0).sum()) > 1:
            stop = met[0][0]
            raise MeshError(
                "The corners of the drawing do not follow each other as the vertices of the mesh"
                f" do, around {_place(stop.place)}."
            )
        for (stop, place), (ahead, until) in zip(met, [*met[1:], met[0]], strict=True):
            count = (until - place) % len(loop) or len(loop)
            chain = np.take(loop, np.arange(place, place + count), mode="wrap")
            self._take(stop, int(chain[0]))
            end = ahead.t if ahead.t > stop.t else ahead.t + length
            self._seat_between(chain, curve, stop.t, end)

    def _met(self, loop: Ids, stops: list[_Stop]) -> list[tuple[_Stop, int]]:
        """The stops that have a vertex, with its place in the loop, in the order of the stops."""
        found: dict[int, _Stop] = {}
        taken: list[tuple[_Stop, int]] = []
        for stop in sorted(stops, key=lambda one: not one.needed):
            distance = np.hypot(*(self._points[loop, :2] - stop.place).T)
            place = int(np.argmin(distance))
            near = REACH * self._domain.diameter if not stop.needed else self._reach[loop[place]]
            if distance[place] > near or place in found:
                if not stop.needed:
                    continue
                raise MeshError(self._missing(stop, float(distance[place]), place in found))
            found[place] = stop
            taken.append((stop, place))
        return sorted(taken, key=lambda pair: pair[0].t)

    def _missing(self, stop: _Stop, distance: float, taken: bool) -> str:
        words = f"No vertex of the mesh lies at the corner {_place(stop.place)} of the drawing"
        if taken:
            return f"{words} alone: another corner is as near."
        return f"{words}: the nearest one is {distance:.3g} away."

    # Interfaces

    def _place_interfaces(self, regions: Ids | None) -> None:
        if regions is None:
            return
        source = self._source
        ids = source.element_ids()
        row = np.full(int(ids.max()) + 1, -1, np.int64)
        row[ids] = np.arange(len(ids))
        h = source.halfedges_of(ids).reshape(-1)
        twin = source.arrays.edge[h, 1].astype(np.int64)
        k = source.k
        local = np.where(twin >= 0, k * row[np.maximum(twin, 0) // k] + twin % k, -1)
        chains, _ = interface_chains(source.elements(), local, regions)
        left = {i for i, side in enumerate(self._sides) if not side.boundary}
        if len(chains) != len(left):
            raise MeshError(
                f"Edges of the mesh follow {_count(len(chains), 'interface')} of the"
                f" {len(left)} in the drawing."
            )
        records = {record.curve: record for record in self._boundary.interfaces}
        for chain in chains:
            curve = self._interface(chain.vertices, chain.left, chain.right, chain.closed, left)
            left.discard(curve)
            if chain.closed:
                self._place_loop(chain.vertices, curve)
                continue
            start, end = int(chain.vertices[0]), int(chain.vertices[-1])
            records[curve] = records[curve]._replace(start=start, end=end)
            self._place_chain(chain.vertices, curve)
        self._boundary = replace(self._boundary, interfaces=tuple(records.values()))

    def _interface(self, chain: Ids, left: int, right: int, closed: bool, free: set[int]) -> int:
        best, where = np.inf, -1
        some = self._points[chain[:: max(1, len(chain) // _SAMPLE)]]
        for curve in free:
            side = self._sides[curve]
            if (side.pieces[0].left, side.pieces[0].right, side.closed) == (left, right, closed):
                distance = self._projected(some, curve, 0.0, self._length(curve))[1].max()
                if distance < best:
                    best, where = float(distance), curve
        if where < 0:
            raise MeshError(
                f"Edges of the mesh between two regions near {_place(some[0])} follow no interface"
                " of the drawing."
            )
        return where

    def _place_chain(self, chain: Ids, curve: int) -> None:
        """Place an open chain of vertices along an interface, from junction to junction."""
        side, length = self._sides[curve], self._length(curve)
        first = _Stop(0.0, side.nodes[0], self._graph.places[side.nodes[0]], True)
        last = _Stop(length, side.nodes[-1], self._graph.places[side.nodes[-1]], True)
        met = [(stop, i + 1) for stop, i in self._met(chain[1:-1], self._stops(curve)[1:])]
        for stop, vertex in ((first, chain[0]), (last, chain[-1])):
            distance = float(np.hypot(*(self._points[vertex, :2] - stop.place)))
            if distance > self._reach[vertex]:
                raise MeshError(self._missing(stop, distance, False))
            self._take(stop, int(vertex))
        for vertex, t in ((chain[0], 0.0), (chain[-1], length)):
            if self._curve[vertex] < 0:
                self._curve[vertex], self._parameter[vertex] = curve, t
        marks = [(first, 0), *met, (last, len(chain) - 1)]
        for (stop, place), (ahead, until) in pairwise(marks):
            if until <= place:
                raise MeshError(
                    "The corners of an interface do not follow each other as the vertices of the"
                    f" mesh do, around {_place(stop.place)}."
                )
            if place:
                self._take(stop, int(chain[place]))
            inner = chain[place:until]
            seats = self._parameters_between(inner, curve, stop.t, ahead.t)
            skip = 0 if place else 1
            self._seat(inner[skip:], curve, seats[skip:])

    # One stretch

    def _take(self, stop: _Stop, vertex: int) -> None:
        self._vertex_of[stop.node] = vertex
        self._points[vertex, :2] = stop.place

    def _seat_between(self, chain: Ids, curve: int, start: float, end: float) -> None:
        """Seat a chain whose first vertex lies at `start`, and whose next one at `end`."""
        self._seat(chain, curve, self._parameters_between(chain, curve, start, end))

    def _parameters_between(self, chain: Ids, curve: int, start: float, end: float) -> Points:
        length = self._length(curve)
        t = np.full(len(chain), start)
        inner = self._points[chain[1:]]
        if len(inner):
            ahead, distance = self._projected(inner, curve, start, min(end, length))
            if end > length:
                later, beyond = self._projected(inner, curve, 0.0, end - length)
                ahead = np.where(beyond < distance, later + length, ahead)
            t[1:] = ahead
        around = start + np.mod(once_around(t - start, end - start), end - start)
        if self._sides[curve].closed:
            around = np.where(around >= length, around - length, around)
        return around

    def _seat(self, chain: Ids, curve: int, t: Points) -> None:
        there = place_all(self._boundary.curves, np.full(len(t), curve), t)
        distance = np.linalg.norm(there - self._points[chain], axis=1)
        excess = distance / self._reach[chain]
        if len(t) and excess.max() > 1.0:
            row = int(np.argmax(excess))
            raise MeshError(
                f"Vertex {int(chain[row])} of the mesh at {_place(self._points[chain[row]])} lies"
                f" {distance[row]:.3g} off the drawing; up to {self._reach[chain[row]]:.3g} is"
                " bridged."
            )
        self._curve[chain], self._parameter[chain] = curve, t

    # The curves

    def _length(self, curve: int) -> float:
        return float(self._boundary.lengths()[curve])

    def _stops(self, curve: int) -> list[_Stop]:
        """The geometric points of a side, without its last end."""
        side, curves = self._sides[curve], self._boundary.curves
        span = int(curves.first_span[curve])
        stops = []
        for piece, node in zip(side.pieces, side.nodes[:-1], strict=True):
            point = self._graph.points.get(node)
            if point is not None:
                t = float(curves.start[span])
                stops.append(_Stop(t, node, point.place, point.kind != ANCHOR))
            span += len(piece.curve.spans)
        return stops

    def _projected(
        self, points: Points, curve: int, low: float, high: float
    ) -> tuple[Points, Points]:
        """Parameters between `low` and `high` of the points nearest to points, and distances."""
        curves = self._boundary.curves
        found = [nearest_between(curves, curve, point, low, high) for point in points]
        t, square = np.array(found).reshape(-1, 2).T
        return t, np.sqrt(square)

    def _sampled(self, curve: int) -> Points:
        samples = [piece.curve.sampled(turn_degrees=15.0) for piece in self._sides[curve].pieces]
        return np.concatenate(samples)


def _edge_lengths(mesh: HalfEdgeMesh) -> Points:
    """(slots,) mean length of the edges at each vertex."""
    elements = mesh.elements()
    ends = np.roll(elements, -1, axis=1)
    lengths = np.linalg.norm(mesh.points[elements] - mesh.points[ends], axis=2).ravel()
    total, count = np.zeros(len(mesh.points)), np.zeros(len(mesh.points))
    for vertices in (elements.ravel(), ends.ravel()):
        np.add.at(total, vertices, lengths)
        np.add.at(count, vertices, 1.0)
    mean: Points = total / np.maximum(count, 1.0)
    return mean


def _box(points: Points) -> Points:
    return np.concatenate([points[:, :2].min(axis=0), points[:, :2].max(axis=0)])


def _place(point: Points) -> str:
    return f"({point[0]:.6g}, {point[1]:.6g})"


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
