"""The curves of a mesh: what its boundary loops and the interfaces of its regions run along.

A :class:`MeshBoundary` never changes; a mesh shares it with its copies. Which vertex lies where on
the curves is data of the mesh (`vertex[:, CURVE]` and `parameter` of its arrays). Where a mesh is
made of points and elements alone, its boundary and interfaces themselves are the curves, as
polylines.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np

from meshwright_core.core.composite_curves import SHORTEST, Curves, no_curves, polyline_curves
from meshwright_core.core.grid_plan import GridPlan
from meshwright_core.core.planes import Plane

_STRAIGHT = 1e-12
"""Sine of a turn below which a point of a polyline lies on a straight line."""
_ON_LINE = 1e-13
"""Distance from a straight line, relative to the extent, below which points count as on it."""


@dataclass(frozen=True)
class CurvePiece:
    """A drawn primitive in a composite curve."""

    start: float
    """Parameter at which it begins."""
    stop: float
    """Parameter at which it ends."""
    kind: str
    """Of a curve: "line", "arc", "ellipse", "spline" or "polyline"."""
    name: str = ""
    """"" where it has none; see :mod:`meshwright_core.core.names`."""
    data: dict[str, object] = field(default_factory=dict)
    """The numbers that define it, as JSON can hold them."""


class Interface(NamedTuple):
    """A curve between two regions."""

    curve: int
    """Its index."""
    left: int
    """The region on its left, where its parameter increases."""
    right: int
    """The region on its right."""
    start: int = -1
    """The vertex where it begins, a junction; -1 for a closed one without junction."""
    end: int = -1
    """The vertex where it ends, likewise."""


@dataclass(frozen=True, eq=False)
class MeshBoundary:
    """The curves of a mesh, its regions, and what is known of both."""

    curves: Curves = field(default_factory=no_curves)
    """The composite curves; boundary loops are closed and have the domain on their left."""
    loops: tuple[int, ...] = ()
    """The curves that are boundary loops."""
    interfaces: tuple[Interface, ...] = ()
    """The curves between regions; their vertices are ids of the mesh."""
    region_names: tuple[str, ...] = ("",)
    """The name of each region, "" where it has none."""
    pieces: tuple[tuple[CurvePiece, ...], ...] = ()
    """The drawn primitives of each curve, in order; () where they are not known."""
    tags: Mapping[tuple[int, str], int] = field(default_factory=dict)
    """The numbers that files give to groups, by dimension (1 sides, 2 regions) and name."""
    plane: Plane | None = None
    """The plane in space whose coordinates those of the mesh are; None for space itself."""
    plan: GridPlan = field(default_factory=GridPlan)
    """What is wanted of a block grid of the mesh."""
    bound_excess: int = 0
    """By how much s* exceeds the absolute value of the sum of Delta, which irregularities of
    different regions lower; see :mod:`meshwright_core.core.score_bound`."""

    @property
    def count(self) -> int:
        """The number of curves."""
        return len(self.curves.closed)

    def lengths(self) -> np.ndarray:
        """(n,) the length of each curve."""
        return self.curves.stop[self.curves.first_span[1:] - 1]

    def table(self) -> np.ndarray:
        """(n, 4) int32 as :attr:`meshwright_core.core.arrays.MeshArrays.interface`."""
        table = np.full((self.count, 4), -1, np.int32)
        for interface in self.interfaces:
            table[interface.curve] = interface[1:]
        return table

    def renumbered(self, vertices: np.ndarray) -> MeshBoundary:
        """The same with new ids of vertices: `vertices` (slots,) maps old ones to them."""
        if self.plan.empty and all(one.start < 0 and one.end < 0 for one in self.interfaces):
            return self

        def new(vertex: int) -> int:
            return int(vertices[vertex]) if vertex >= 0 else -1

        moved = (one._replace(start=new(one.start), end=new(one.end)) for one in self.interfaces)
        return replace(self, interfaces=tuple(moved), plan=self.plan.renumbered(vertices))


class Seats(NamedTuple):
    """Where the vertices of a mesh lie on its curves."""

    curve: np.ndarray
    """(n,) the curve of each vertex, -1 for none."""
    parameter: np.ndarray
    """(n,) the parameter there, 0 for none."""


class Chain(NamedTuple):
    """Vertices along a boundary loop or an interface."""

    vertices: np.ndarray
    """(m,) ids in order; closed chains do not repeat the first."""
    closed: bool
    left: int = -1
    """The region on its left; -1 for boundary loops."""
    right: int = -1


def polyline_boundary(
    points: np.ndarray,
    chains: Iterable[Chain],
    kept: np.ndarray,
    region_names: tuple[str, ...] = ("",),
) -> tuple[MeshBoundary, Seats]:
    """Polylines through the vertices of chains as curves, and the seats of the vertices on them.

    Vertices on a straight line through their neighbours become no ends of spans, so that the edges
    of straight sides are pieces of one span each.

    Args:
        points: (n, 3).
        chains: boundary loops, then interfaces; open ones begin and end at junctions.
        kept: (n,) vertices that end a span even if the chain is straight there.
        region_names: of the mesh.
    """
    curve, parameter = np.full(len(points), -1, np.int64), np.zeros(len(points))
    polylines, closed, loops, interfaces, spots = [], [], [], [], []
    for number, (vertices, ring, left, right) in enumerate(chains):
        knots, arc = _knots(points[vertices], ring, kept[vertices])
        polylines.append(points[vertices[knots]])
        closed.append(ring)
        spots.append((vertices, ring, knots, arc))
        if left < 0:
            loops.append(number)
        else:
            start, end = (-1, -1) if ring else (int(vertices[0]), int(vertices[-1]))
            interfaces.append(Interface(number, left, right, start, end))
    curves = polyline_curves(polylines, closed)
    pieces = []
    for number, (vertices, ring, knots, arc) in enumerate(spots):
        first, last = curves.first_span[number], curves.first_span[number + 1]
        ends = np.append(curves.start[first:last], curves.stop[last - 1])
        places = ends[: len(vertices)]
        if len(knots) < len(vertices):
            stops = np.append(knots, len(vertices)) if ring else knots
            places = np.interp(arc[: len(vertices)], arc[stops], ends)
        # junctions keep the seat on a boundary loop, or the first interface at them
        free = curve[vertices] < 0
        curve[vertices[free]] = number
        parameter[vertices[free]] = places[free]
        pieces.append((CurvePiece(0.0, float(ends[-1]), "polyline"),))
    boundary = MeshBoundary(curves, tuple(loops), tuple(interfaces), region_names, tuple(pieces))
    return boundary, Seats(curve, parameter)


def _knots(points: np.ndarray, ring: bool, kept: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The places (s,) in a polyline (m, 3) where spans begin or end, and the arc lengths.

    Its ends always; the last arc length of a closed one (m + 1,) is its whole length.
    """
    count = len(points)
    around = np.vstack([points, points[:1]]) if ring else points
    steps = np.diff(around, axis=0)
    lengths = np.linalg.norm(steps, axis=1)
    arc = np.concatenate([[0.0], np.cumsum(lengths)])
    everything = np.arange(count)
    if not (lengths > SHORTEST * arc[-1]).all():
        return everything, arc
    unit = steps / lengths[:, None]
    before = np.roll(unit, 1, axis=0) if ring else np.vstack([unit[:1], unit])
    after = unit if ring else np.vstack([unit, unit[-1:]])
    turning = (np.linalg.norm(after - before, axis=1) > _STRAIGHT) | kept
    turning[0] = True
    turning[-1] |= not ring
    knots = np.flatnonzero(turning)
    stops = np.append(knots, count) if ring else knots
    there = np.column_stack([np.interp(arc, arc[stops], around[stops, c]) for c in range(3)])
    if np.abs(there - around).max() > _ON_LINE * np.ptp(points, axis=0).max():
        return everything, arc
    return knots, arc
