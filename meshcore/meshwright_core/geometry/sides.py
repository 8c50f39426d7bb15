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
from typing import TYPE_CHECKING

import numpy as np

from meshwright_core.core.arrays import (
    DEGREE,
    FLAGS,
    GEOMETRIC,
    HALF,
    ORIGIN,
    VERTICES,
    following,
    neighbour,
    turned,
)
from meshwright_core.core.compilation import kernel
from meshwright_core.errors import MeshError
from meshwright_core.geometry.outline import (
    Outline,
    Polylines,
    nearest_on,
    nearest_parameters,
    place_all,
)

if TYPE_CHECKING:
    from meshwright_core.mesh import HalfEdgeMesh


@kernel
def boundary_before(m, v, k):
    """The boundary vertex before the boundary vertex v, O(degree); -1 when there is none."""
    h = m.vertex[v, HALF]
    for _ in range(m.vertex[v, DEGREE]):
        h = turned(m, h, k)
        if h < 0:
            return neighbour(m, h, k)
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
