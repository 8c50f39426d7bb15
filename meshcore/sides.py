"""The sides of a mesh: the pieces of its first outline on which boundary vertices slide.

A side is the polyline of the outline between two consecutive geometric vertices of a boundary loop;
a loop without any is one closed side. Boundary vertices come and go by editing, geometric ones
stay: so a vertex finds its side by walking along the boundary to the geometric vertices before and
after it. A geometric vertex that is no point of the outline (the user marked it) divides the side
at its projection. The *chain* of a side is its boundary vertices in order; their arc lengths
increase.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from typing import TYPE_CHECKING, ClassVar, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from meshcore.compiled import kernel
from meshcore.errors import MeshError
from meshcore.halfedge import (
    FLAGS,
    GEOMETRIC,
    HALF,
    ORIGIN,
    TWIN,
    VERTICES,
    following,
    preceding,
)

if TYPE_CHECKING:
    from meshcore.mesh import HalfEdgeMesh

STRAIGHT = 1e-12
"""Sine of a turn below which a point of the outline counts as lying on a straight line."""
FLAT = 1e-7
"""Distance from a plane, relative to the extent, below which points lie in it."""
NEAR = 1e-9
"""Distance, relative to the outline's extent, below which a point lies on the outline."""


class Polylines(NamedTuple):
    """Sides as flat arrays. Closed ones repeat their first point at the end."""

    points: np.ndarray
    """(p, 2 or 3) points of all sides, one side after the other."""
    arc: np.ndarray
    """(p,) arc length of each point from the start of its side."""
    first: np.ndarray
    """(s + 1,) index of the first point of each side."""
    closed: np.ndarray
    """(s,) whether the side is a whole loop without a geometric vertex."""


@kernel
def place_on(sides, side, t, point, tangent):
    """Write the point and the unit tangent at arc length `t`; beyond an open end: straight on."""
    low, high = sides.first[side], sides.first[side + 1] - 1
    arc, points = sides.arc, sides.points
    if sides.closed[side]:
        t -= np.floor(t / arc[high]) * arc[high]
    while high - low > 1:
        middle = (low + high) // 2
        if arc[middle] <= t:
            low = middle
        else:
            high = middle
    length = arc[high] - arc[low]
    share = (t - arc[low]) / length
    for c in range(points.shape[1]):
        tangent[c] = (points[high, c] - points[low, c]) / length
        # from the nearer end, so that both ends are met to the bit
        if share <= 0.5:
            point[c] = points[low, c] + share * (points[high, c] - points[low, c])
        else:
            point[c] = points[high, c] - (1.0 - share) * (points[high, c] - points[low, c])


@kernel
def nearest_on(sides, side, point):
    """Arc length of the point of the side that is nearest to `point`, and the squared distance."""
    best, where = np.inf, 0.0
    points, arc = sides.points, sides.arc
    for i in range(sides.first[side], sides.first[side + 1] - 1):
        along, square = 0.0, 0.0
        for c in range(points.shape[1]):
            d = points[i + 1, c] - points[i, c]
            along += d * (point[c] - points[i, c])
            square += d * d
        share = min(max(along / square, 0.0), 1.0) if square > 0.0 else 0.0
        distance = 0.0
        for c in range(points.shape[1]):
            d = point[c] - points[i, c] - share * (points[i + 1, c] - points[i, c])
            distance += d * d
        if distance < best:
            best = distance
            where = arc[i] + share * (arc[i + 1] - arc[i])
    return where, best


@kernel
def nearest_parameters(sides, side, points):
    """(n,) arc lengths on `side` of the projections of `points`."""
    t = np.zeros(len(points))
    for i in range(len(points)):
        t[i], _ = nearest_on(sides, side, points[i])
    return t


@kernel
def place_all(sides, side, parameters):
    """(n, 2 or 3) points at the arc lengths `parameters` (n,) of the sides `side` (n,)."""
    points = np.zeros((len(parameters), sides.points.shape[1]))
    tangent = np.zeros(sides.points.shape[1])
    for i in range(len(parameters)):
        place_on(sides, side[i], parameters[i], points[i], tangent)
    return points


@kernel
def boundary_before(m, v, k):
    """The boundary vertex before the boundary vertex v, O(degree); -1 when there is none."""
    h = m.vertex[v, HALF]
    for _ in range(m.counters[VERTICES]):
        back = preceding(h, k)
        h = m.edge[back, TWIN]
        if h < 0:
            return m.edge[back, ORIGIN]
    return -1


@kernel
def walk_side(m, v, k):
    """The chain through the boundary vertex v, and whether it is a whole loop."""
    start = v
    for _ in range(m.counters[VERTICES]):
        start = boundary_before(m, start, k)
        if start == v or start < 0 or m.vertex[start, FLAGS] & GEOMETRIC:
            break
    whole = start == v and not m.vertex[v, FLAGS] & GEOMETRIC
    count, end = 1, start
    for _ in range(m.counters[VERTICES]):
        end = m.edge[following(m.vertex[end, HALF], k), ORIGIN]
        if end == start:
            break
        count += 1
        if m.vertex[end, FLAGS] & GEOMETRIC:
            break
    if end == start and not whole:
        count += 1
    chain = np.empty(count, np.int64)
    for i in range(count):
        chain[i] = start
        start = m.edge[following(m.vertex[start, HALF], k), ORIGIN]
    return chain, whole


class _Loop:
    """One loop of the outline: its points, closed by the first, without those on straight lines."""

    def __init__(self, ids: np.ndarray, points: np.ndarray) -> None:
        self.ids = {int(v): i for i, v in enumerate(ids)}
        self.points = np.asarray(points, np.float64)
        closed = np.vstack([self.points, self.points[:1]])
        lengths = np.linalg.norm(np.diff(closed, axis=0), axis=1)
        self.arc = np.concatenate([[0.0], np.cumsum(lengths)])
        self.length = float(self.arc[-1])
        first = np.array([0, len(closed)])
        self.polyline = Polylines(closed, self.arc, first, np.array([True]))
        unit = np.diff(closed, axis=0) / np.maximum(lengths, 1e-300)[:, None]
        turn = np.linalg.norm(unit - np.roll(unit, 1, axis=0), axis=1)
        self.turning = np.flatnonzero(turn > STRAIGHT)

    def between(self, start: float, stop: float) -> np.ndarray:
        """(p, 3) points where the loop turns, after arc length `start` and before `stop`."""
        arc = self.arc[self.turning]
        margin = NEAR * self.length
        if stop <= start + margin:
            stop += self.length
        rounds = np.concatenate([arc, arc + self.length])
        inside = (rounds > start + margin) & (rounds < stop - margin)
        return self.points[np.concatenate([self.turning, self.turning])[inside]]


class Outline:
    """The shape of a mesh: `mesh.outline` prepared for look-ups, once for each mesh.

    `area` is the vector area (3,) of the outline: along the normal of a plane mesh, to the side
    from which its elements turn counter-clockwise. `extent` is the diagonal of its bounding box.
    """

    _known: ClassVar[WeakKeyDictionary[HalfEdgeMesh, Outline]] = WeakKeyDictionary()

    def __init__(self, loops: list[tuple[np.ndarray, np.ndarray]]) -> None:
        self.source = loops
        self.loops = [_Loop(ids, points) for ids, points in loops]
        self.area = np.zeros(3)
        self.extent = 0.0
        if self.loops:
            everything = np.vstack([loop.points for loop in self.loops])
            self.extent = float(np.linalg.norm(np.ptp(everything, axis=0)))
            centre = everything.mean(axis=0)
            for loop in self.loops:
                p = loop.points - centre
                self.area += 0.5 * np.cross(p, np.roll(p, -1, axis=0)).sum(axis=0)

    @classmethod
    def of(cls, mesh: HalfEdgeMesh) -> Outline:
        """The outline of `mesh`; kept as long as the mesh lives and its ids are the same."""
        outline = cls._known.get(mesh)
        if outline is None or outline.source is not mesh.outline:
            outline = cls._known[mesh] = cls(mesh.outline)
        return outline

    def normal(self, points: np.ndarray, own: np.ndarray | None = None) -> np.ndarray | None:
        """(3,) unit normal of the plane that all `points` (n, 3) lie in, or None.

        It points to the side from which the outline turns counter-clockwise; without an outline in
        this plane along `own` (3,), the sum of the elements' vector areas.
        """
        if not len(points):
            return None
        if not points[:, 2].any() and self.area[2] > 0.0:
            return np.array([0.0, 0.0, 1.0])
        size = float(np.linalg.norm(np.ptp(points, axis=0)))
        for area in (self.area, own):
            length = 0.0 if area is None else float(np.linalg.norm(area))
            if area is None or length <= 1e-12 * size * size:
                continue
            normal: np.ndarray = area / length
            if np.ptp(points @ normal) <= FLAT * size:
                return normal
        return None

    def find(self, vertex: int, point: np.ndarray) -> tuple[int, float]:
        """The loop and the arc length at which a geometric vertex cuts the outline.

        A vertex that lies on the outline cuts it where it lies. One that was dragged off it still
        stands for its own point of the outline; any other one cuts it at its projection.
        """
        for number, loop in enumerate(self.loops):
            i = loop.ids.get(vertex)
            if i is not None and np.array_equal(loop.points[i], point):
                return number, float(loop.arc[i])
        number, t, distance = self.nearest(point)
        if distance > NEAR * self.extent:
            for other, loop in enumerate(self.loops):
                if vertex in loop.ids:
                    return other, float(loop.arc[loop.ids[vertex]])
        return number, t

    def nearest(self, point: np.ndarray) -> tuple[int, float, float]:
        """The loop, arc length and distance of the nearest point of the outline."""
        found = [nearest_on(loop.polyline, 0, point) for loop in self.loops]
        number = int(np.argmin([square for _, square in found]))
        return number, float(found[number][0]), float(np.sqrt(found[number][1]))

    def side(self, chain: np.ndarray, points: np.ndarray, closed: bool) -> np.ndarray:
        """(p, 3) polyline of the side whose boundary vertices are `chain`, at `points` (n, 3)."""
        if not self.loops:
            raise MeshError("The mesh has a boundary but no outline to slide on.")
        if closed:
            sample = points[:: max(1, len(points) // 8)]
            far = [sum(nearest_on(loop.polyline, 0, p)[1] for p in sample) for loop in self.loops]
            loop = self.loops[int(np.argmin(far))]
            corners = loop.points[loop.turning]
            return np.vstack([corners, corners[:1]])
        number, start = self.find(int(chain[0]), points[0])
        _, stop = self.find(int(chain[-1]), points[-1])
        return np.vstack([points[:1], self.loops[number].between(start, stop), points[-1:]])


class Sides:
    """The sides of a mesh with the vertices on them, or those on which given vertices lie.

    Args:
        mesh: the mesh; later edits of it are not seen.
        vertices: boundary vertices whose sides are wanted; None: all sides.

    Attributes:
        polylines: the sides, (p, 3) points.
        chains: for each side the ids of its boundary vertices in the direction of the half-edges;
            open sides begin and end with a geometric vertex.
    """

    def __init__(self, mesh: HalfEdgeMesh, vertices: Iterable[int] | None = None) -> None:
        self._positions = mesh.points
        self.chains, closed = _chains(mesh, vertices)
        self._seat: dict[int, tuple[int, int]] = {}
        outline = Outline.of(mesh)
        pieces, arcs = [], []
        for number, (chain, whole) in enumerate(zip(self.chains, closed, strict=True)):
            piece = outline.side(chain, self._positions[chain], whole)
            pieces.append(piece)
            lengths = np.linalg.norm(np.diff(piece, axis=0), axis=1)
            arcs.append(np.concatenate([[0.0], np.cumsum(lengths)]))
            stop = len(chain) if whole else len(chain) - 1
            for place in range(0 if whole else 1, stop):
                self._seat[int(chain[place])] = (number, place)
        counts = [len(piece) for piece in pieces]
        self.polylines = Polylines(
            points=np.vstack(pieces) if pieces else np.zeros((0, 3)),
            arc=np.concatenate(arcs) if arcs else np.zeros(0),
            first=np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
            closed=np.array(closed, np.bool_),
        )

    def __contains__(self, vertex: int) -> bool:
        """Whether `vertex` lies on one of these sides, between its ends."""
        return vertex in self._seat

    def seat(self, vertex: int) -> tuple[int, int]:
        """The side of a non-geometric boundary vertex, and its place in the side's chain."""
        try:
            return self._seat[vertex]
        except KeyError:
            raise MeshError(f"Vertex {vertex} slides on none of these sides.") from None

    def length(self, side: int) -> float:
        """Length of a side."""
        return float(self.polylines.arc[self.polylines.first[side + 1] - 1])

    def parameters(self, side: int, points: np.ndarray | None = None) -> np.ndarray:
        """(n,) arc lengths of the vertices of a side's chain, strictly increasing.

        A vertex off the side (a new one in the middle of a chord, say) gets that of its projection;
        where projections are out of order or meet, the order of the chain wins. On closed sides
        values may pass the length once. `points` (n, 3) stand in for the present positions.
        """
        chain, length = self.chains[side], self.length(side)
        here = self._positions[chain] if points is None else points
        t = nearest_parameters(self.polylines, side, np.ascontiguousarray(here))
        if not self.polylines.closed[side]:
            t[0], t[-1] = 0.0, length
            return in_order(t, length)
        turned = np.mod(np.diff(t, append=t[0]), length)
        if abs(turned.sum() - length) > 0.5 * length:
            turned = np.linalg.norm(np.roll(here, -1, axis=0) - here, axis=1)
            turned = turned + max(turned.sum(), length) / len(chain)
            turned *= length / turned.sum()
        unrolled = np.concatenate([[t[0]], t[0] + np.cumsum(turned)])
        return in_order(unrolled, length)[:-1]

    def project(self, vertex: int, xyz: np.ndarray) -> tuple[np.ndarray, float]:
        """The nearest point (3,) of the vertex's side and its arc length there."""
        side, _ = self.seat(vertex)
        t, _ = nearest_on(self.polylines, side, np.asarray(xyz, np.float64))
        return place_all(self.polylines, np.array([side]), np.array([t]))[0], float(t)


def in_order(t: np.ndarray, length: float) -> np.ndarray:
    """`t` (n,) if it increases strictly; else values near it that do, with the same ends."""
    least = 1e-6 * length / len(t)
    if np.all(np.diff(t) > least):
        return t
    blocks: list[list[float]] = []  # mean and size: isotonic regression by pooling
    for value in np.clip(t[1:-1], t[0], t[-1]):
        blocks.append([float(value), 1.0])
        while len(blocks) > 1 and blocks[-2][0] >= blocks[-1][0]:
            mean, size = blocks.pop()
            blocks[-1][0] = (blocks[-1][0] * blocks[-1][1] + mean * size) / (blocks[-1][1] + size)
            blocks[-1][1] += size
    pooled = np.repeat([mean for mean, _ in blocks], [int(size) for _, size in blocks])
    pooled = np.concatenate([t[:1], pooled, t[-1:]])
    # a touch of even spacing parts those that were pooled into one
    even = np.linspace(t[0], t[-1], len(t))
    return 0.9 * pooled + 0.1 * even


def _chains(
    mesh: HalfEdgeMesh, vertices: Iterable[int] | None
) -> tuple[list[np.ndarray], list[bool]]:
    """The chains of all sides, or of those through `vertices`, and which of them are closed."""
    chains: list[np.ndarray] = []
    closed: list[bool] = []
    if vertices is not None:
        seen: set[int] = set()
        for vertex in vertices:
            if int(vertex) in seen:
                continue
            chain, whole = walk_side(mesh.arrays, int(vertex), mesh.k)
            seen.update(chain.tolist() if whole else chain[1:-1].tolist())
            chains.append(chain)
            closed.append(whole)
        return chains, closed
    geometric = mesh.geometric()
    for loop in mesh.boundary_loops():
        ends = np.flatnonzero(geometric[loop])
        if not len(ends):
            chains.append(np.asarray(loop, np.int64))
            closed.append(True)
            continue
        turned = np.roll(loop, -ends[0])
        stops = np.append(ends - ends[0], len(loop))
        turned = np.append(turned, turned[0])
        for a, b in pairwise(stops.tolist()):
            if b - a > 1:
                chains.append(turned[a : b + 1].astype(np.int64))
                closed.append(False)
    return chains, closed
