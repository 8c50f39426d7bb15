"""Checks of polygons while they are drawn: crossings, misplaced holes, loops without area.

Each problem has a sentence, and the edges and points to mark. `meshwright_core.domains.domain`
checks the finished polygon again; these checks are fast enough to run at every mouse move.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshwright.sources.arc_edges import Place, points_of
from meshwright_core.errors import capitalised
from meshwright_core.geometry.polygons import contains

_NEAR = 1e-9
"""Tolerance, relative to the size of the sketch, below which two points coincide."""


@dataclass(frozen=True)
class PolygonLoop:
    """Corners in order; the first loop is the outline, the others are holes.

    ``bulges`` are those of the edges that begin at the corners; missing ones are 0, for segments.
    """

    corners: tuple[Place, ...] = ()
    closed: bool = False
    bulges: tuple[float, ...] = ()

    @property
    def curved(self) -> bool:
        """Whether an edge is an arc."""
        return any(self.bulges)

    @property
    def edges(self) -> range:
        """The corners at which an edge begins."""
        return range(len(self.corners) if self.closed else max(len(self.corners) - 1, 0))

    def bulge(self, edge: int) -> float:
        """The bulge of an edge."""
        return self.bulges[edge] if edge < len(self.bulges) else 0.0

    def ends(self, edge: int) -> tuple[Place, Place]:
        """Where an edge begins and ends."""
        return self.corners[edge], self.corners[(edge + 1) % len(self.corners)]

    def edge_points(self, edge: int) -> list[Place]:
        """Points of an edge in order, both ends included."""
        return points_of(*self.ends(edge), self.bulge(edge))

    def flattened(self) -> tuple[PolygonLoop, list[int]]:
        """The loop with its arcs as polylines, and for each of its points the edge there."""
        if not self.curved:
            return self, list(range(len(self.corners)))
        places: list[Place] = []
        owners: list[int] = []
        for edge in self.edges:
            points = self.edge_points(edge)[:-1]
            places += points
            owners += [edge] * len(points)
        if not self.closed:
            places.append(self.corners[-1])
            owners.append(len(self.corners) - 1)
        return PolygonLoop(tuple(places), self.closed), owners


@dataclass(frozen=True)
class PolygonProblem:
    """A sentence, the edges to mark as (loop, corner where the edge begins), and points."""

    words: str
    edges: tuple[tuple[int, int], ...] = ()
    places: tuple[Place, ...] = ()


def name_of(loop: int) -> str:
    """``the outline``, ``hole 1`` and so on."""
    return "the outline" if loop == 0 else f"hole {loop}"


def problem_of(loops: tuple[PolygonLoop, ...]) -> PolygonProblem:
    """The first problem of the loops; its sentence is empty if there is none.

    Arcs count as polylines here; the finished domain is checked with its true curves.
    """
    flat = [loop.flattened() for loop in loops]
    found = _problem_of(tuple(one for one, _ in flat))
    edges = dict.fromkeys((i, flat[i][1][j]) for i, j in found.edges)
    return PolygonProblem(found.words, tuple(edges), found.places)


def _problem_of(loops: tuple[PolygonLoop, ...]) -> PolygonProblem:
    crossing = _crossing(loops)
    if crossing is not None:
        return crossing
    outline = loops[0]
    for i, loop in enumerate(loops[1:], start=1):
        if not loop.corners:
            continue
        edges = tuple((i, j) for j in range(len(loop.corners)))
        if not contains(np.array(outline.corners), *loop.corners[0]):
            return PolygonProblem(f"Hole {i} lies outside the outline.", edges, loop.corners)
        for j, other in enumerate(loops[1:], start=1):
            if i != j and other.closed and contains(np.array(other.corners), *loop.corners[0]):
                return PolygonProblem(f"Hole {i} lies inside hole {j}.", edges, loop.corners)
    for i, loop in enumerate(loops):
        if loop.closed and _flat(loop.corners):
            edges = tuple((i, j) for j in range(len(loop.corners)))
            return PolygonProblem(f"{capitalised(name_of(i))} encloses no area.", edges)
    return PolygonProblem("")


def _crossing(loops: tuple[PolygonLoop, ...]) -> PolygonProblem | None:
    """The first two edges that cross or touch, and where."""
    owner = [(i, j) for i, loop in enumerate(loops) for j in range(len(loop.corners) - 1)]
    owner += [(i, len(loop.corners) - 1) for i, loop in enumerate(loops) if loop.closed]
    if len(owner) < 2:
        return None
    corners = [loop.corners for loop in loops]
    a = np.array([corners[i][j] for i, j in owner])
    b = np.array([corners[i][(j + 1) % len(corners[i])] for i, j in owner])
    ring = np.array([i for i, _ in owner])
    index = np.array([j for _, j in owner])
    count = np.array([len(corners[i]) for i, _ in owner])
    closed = np.array([loops[i].closed for i, _ in owner])
    low, high = np.minimum(a, b), np.maximum(a, b)
    room = _NEAR * (np.abs(low) + np.abs(high))
    apart = ((low - room)[:, None] > (high + room)[None]).any(axis=-1)
    one, other = np.nonzero(np.triu(~apart & ~apart.T, 1))
    gap = (index[other] - index[one]) % count[one]
    beside = (ring[one] == ring[other]) & ((gap == 1) | (gap == count[one] - 1))
    beside &= closed[one] | (np.abs(index[other] - index[one]) == 1)
    ends = a[one], b[one], a[other], b[other]
    # neighbours share a corner: they only must not fold back on each other
    wrong = np.flatnonzero(np.where(beside, _folds(*ends), _meet(*ends)))
    if len(wrong) == 0:
        return None
    e, f = int(one[wrong[0]]), int(other[wrong[0]])
    place = _place(a[e], b[e], a[f], b[f])
    spot = f"({place[0]:.4g}, {place[1]:.4g})"
    i, j = owner[e][0], owner[f][0]
    if i == j:
        words = f"{capitalised(name_of(i))} crosses or touches itself near {spot}."
    else:
        one_loop, other_loop = capitalised(name_of(max(i, j))), name_of(min(i, j))
        words = f"{one_loop} crosses or touches {other_loop} near {spot}."
    return PolygonProblem(words, (owner[e], owner[f]), (place,))


def _side(a: np.ndarray, b: np.ndarray, p: np.ndarray) -> np.ndarray:
    """Side of the line from a to b on which p lies: 1 left, -1 right, 0 within rounding."""
    u, v = b - a, p - a
    across = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
    size = np.abs(u).sum(axis=-1) * np.abs(v).sum(axis=-1)
    sign: np.ndarray = np.where(np.abs(across) <= _NEAR * size, 0.0, np.sign(across))
    return sign


def _meet(p: np.ndarray, q: np.ndarray, r: np.ndarray, s: np.ndarray) -> np.ndarray:
    """(k,) whether the edges p-q and r-s have a point in common."""
    one, other = _side(p, q, r), _side(p, q, s)
    third, fourth = _side(r, s, p), _side(r, s, q)
    proper = (one * other < 0) & (third * fourth < 0)
    touching = (
        ((one == 0) & _between(p, q, r))
        | ((other == 0) & _between(p, q, s))
        | ((third == 0) & _between(r, s, p))
        | ((fourth == 0) & _between(r, s, q))
    )
    result: np.ndarray = proper | touching
    return result


def _between(a: np.ndarray, b: np.ndarray, p: np.ndarray) -> np.ndarray:
    low, high = np.minimum(a, b), np.maximum(a, b)
    room = _NEAR * (np.abs(low) + np.abs(high) + (high - low))
    inside: np.ndarray = ((p >= low - room) & (p <= high + room)).all(axis=-1)
    return inside


def _folds(p: np.ndarray, q: np.ndarray, r: np.ndarray, s: np.ndarray) -> np.ndarray:
    """(k,) whether the edge r-s folds back along the edge p-q."""
    ahead = ((q - p) * (s - r)).sum(axis=-1)
    result: np.ndarray = (_side(p, q, q + (s - r)) == 0) & (ahead < 0)
    return result


def _place(a: np.ndarray, b: np.ndarray, c: np.ndarray, d: np.ndarray) -> Place:
    u, v, w = b - a, d - c, c - a
    across = u[0] * v[1] - u[1] * v[0]
    if abs(across) > _NEAR * np.abs(u).sum() * np.abs(v).sum():
        share = (w[0] * v[1] - w[1] * v[0]) / across
        return float(a[0] + share * u[0]), float(a[1] + share * u[1])
    middle = np.sort(np.array([a, b, c, d]), axis=0)[1:3].mean(axis=0)
    return float(middle[0]), float(middle[1])


def _flat(corners: tuple[Place, ...]) -> bool:
    p = np.array(corners)
    x, y = (p - p[0]).T
    area = abs(float(np.dot(x, np.roll(y, -1)) - np.dot(np.roll(x, -1), y)))
    return area <= _NEAR * float(np.ptp(p, axis=0).max()) ** 2
